// SPDX-License-Identifier: Apache-2.0
// Sorts the lights of a set on the device: by type, size and place (shared/light_order.h).
#pragma once

#include <limits>

#include "candelabra/candelabra.h"
#include "gpu/kernel.h"
#include "shared/light_order.h"

namespace candelabra::lighting
{

// Where lights lie, for the grid they are sorted along; lights outside count to its border.
struct LightExtent {
    float low[3] = {0, 0, 0}; // metres
    float size = 1;           // metres, of the longest side, > 0
    float influenceRadius =
        std::numeric_limits<float>::infinity(); // metres, median; may be infinite
};

class LightOrder
{
public:
    explicit LightOrder(const gpu::Device& device); // must outlive it
    // What sorting so many lights takes; keys[0] is the result.
    struct State {
        gpu::Buffer keys[2], counts, sums;
        gpu::Bindings makeKeys, count, scatter; // by the buffer they read or make
        gpu::Bindings addUp, offset;
    };
    State createState(uint32_t capacity, const gpu::Buffer& records) const;
    // Ends with a barrier.
    void record(const gpu::Frame& frame, const State& state, uint32_t lightCount,
                const LightExtent& extent) const noexcept;

private:
    const gpu::Device* device_;
    gpu::Kernel<gpu::LightKeysParams> lightKeys_;
    gpu::Kernel<gpu::SortParams> count_, sums_, offsets_, scatter_;
};

} // namespace candelabra::lighting
