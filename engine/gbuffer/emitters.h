// SPDX-License-Identifier: Apache-2.0
// The visible sphere lights, copied into one upload buffer per frame slot when they changed.
#pragma once

#include <array>
#include <cstdint>
#include <span>
#include <vector>

#include "candelabra/candelabra.h"
#include "gpu/memory.h"
#include "shared/raster.h"

namespace candelabra::gbuffer
{

class Emitters
{
public:
    Emitters(const gpu::Device& device, uint32_t slots) : device_(&device), slots_(slots) {}

    // Keeps the sphere lights. Throws gpu::Failure; then the previous set stays.
    void set(std::span<const CndLight> lights, const double origin[3]);

    // The buffer of `slot` with the latest set; the GPU must have finished the slot's last frame.
    const gpu::Buffer& update(uint32_t slot) noexcept;

    uint32_t count() const { return uint32_t(records_.size()); }
    const std::array<double, 3>& origin() const { return origin_; } // world

private:
    struct Slot {
        gpu::Buffer buffer;
        gpu::Buffer larger; // replaces buffer at the next update: the GPU may still read that one
        uint64_t version = 0;
    };
    const gpu::Device* device_;
    std::vector<Slot> slots_;
    std::vector<gpu::EmitterRecord> records_;
    std::array<double, 3> origin_{};
    uint64_t version_ = 0;
};

} // namespace candelabra::gbuffer
