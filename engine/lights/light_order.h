// SPDX-License-Identifier: Apache-2.0
// Sorts the lights of a set on the device by type, size and position (shared/light_order_data.h).
#pragma once

#include <limits>

#include "candelabra/candelabra.h"
#include "gpu/kernel.h"
#include "lights/light_types.h"
#include "shared/light_order_data.h"

namespace candelabra::lighting
{

// The cube in which most lights of a set lie. The Morton codes of the sort number the cells of a
// grid in this cube; a light outside belongs to the nearest cell.
struct LightExtent {
    float low[3] = {0, 0, 0}; // lowest corner, metres
    float size = 1;           // side of the cube, metres, > 0
    // Median influence radius of the lights, metres; may be infinite.
    float influenceRadius = std::numeric_limits<float>::infinity();
};

class LightOrder
{
public:
    explicit LightOrder(const gpu::Device& device); // must outlive it
    // Buffers and descriptor sets for sorting up to a number of lights. keys[0] holds the result.
    struct State {
        gpu::Buffer keys[2], counts, sums;
        // Set i of makeKeys writes keys[i]. Set i of sort, for all kernels of a pass, reads
        // keys[i].
        gpu::Bindings makeKeys, sort;
    };
    // `capacity`: the largest number of lights to sort.
    State createState(uint32_t capacity, const gpu::Buffer& records) const;
    // Records the sort of all records, and a barrier after it. `counts`: how many records there are
    // of each type.
    void record(const gpu::Frame& frame, const State& state, const LightTypeCounts& counts,
                const LightExtent& extent) const noexcept;

private:
    const gpu::Device* device_;
    bool lanesTogether_; // a group, not a lane, counts and scatters a run of lights
    gpu::Kernel<gpu::LightKeysParams> lightKeys_;
    gpu::Kernel<gpu::SortParams> count_, sums_, offsets_, scatter_;
};

} // namespace candelabra::lighting
