// SPDX-License-Identifier: Apache-2.0
// The visible area lights. Changed lights are copied into one upload buffer per frame slot.
#pragma once

#include <array>
#include <bit>
#include <cstdint>
#include <span>
#include <vector>

#include "candelabra/candelabra.h"
#include "gpu/memory.h"
#include "shared/light_types.h"
#include "shared/raster.h"

namespace candelabra::gbuffer
{

class Emitters
{
public:
    Emitters(const gpu::Device& device, uint32_t slots) : device_(&device), slots_(slots) {}

    // Stores the area lights among `lights`. Throws gpu::Failure; then the previous set stays.
    void set(std::span<const CndLight> lights, const double origin[3]);

    // Returns the buffer of `slot`, filled with the latest set. The GPU must have finished the
    // slot's previous frame.
    const gpu::Buffer& update(uint32_t slot) noexcept;

    // Where the gpu::EmitterCorners of the polygons begin in the buffer, in bytes. If there are
    // none, at least as many bytes as one element follow.
    VkDeviceSize cornersOffset() const { return cornersOffsetOf(records_.size()); }

    // The lights of one shape, contiguous in the buffer.
    struct Group {
        uint32_t first = 0, count = 0;
    };
    static constexpr size_t shapeCount = std::popcount(gpu::AREA_LIGHT_TYPES);
    // shapes[i] is the light type of group i: the types of lights that have a size. Distant ones
    // come last, because they are drawn where nothing else was drawn.
    static constexpr std::array<uint32_t, shapeCount> shapes = [] {
        std::array<uint32_t, shapeCount> out{};
        size_t count = 0;
        for (const uint32_t types : {gpu::AREA_LIGHT_TYPES & gpu::TYPES_WITH_POSITION,
                                     gpu::AREA_LIGHT_TYPES & ~gpu::TYPES_WITH_POSITION})
            for (uint32_t type = 0; type < gpu::LIGHT_TYPE_COUNT; ++type)
                if (types >> type & 1)
                    out[count++] = type;
        return out;
    }();
    static constexpr bool isDistant(uint32_t type)
    {
        return !(gpu::TYPES_WITH_POSITION >> type & 1);
    }
    const std::array<Group, shapeCount>& groups() const { return groups_; }
    bool empty() const { return records_.empty(); }
    const std::array<double, 3>& origin() const { return origin_; } // world space

private:
    struct Slot {
        gpu::Buffer buffer;
        // Replaces `buffer` at the next update, because the GPU may still read `buffer` until then.
        gpu::Buffer larger;
        uint64_t version = 0;
    };
    static VkDeviceSize cornersOffsetOf(size_t records)
    {
        return (records * sizeof(gpu::EmitterRecord) + 15) / 16 * 16; // aligned to a vec4
    }

    const gpu::Device* device_;
    std::vector<Slot> slots_;
    std::vector<gpu::EmitterRecord> records_;
    std::vector<gpu::EmitterCorners> corners_; // one per polygon, or one that nothing reads
    std::array<Group, shapeCount> groups_{};
    std::array<double, 3> origin_{};
    uint64_t version_ = 0;
};

} // namespace candelabra::gbuffer
