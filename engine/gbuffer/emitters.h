// SPDX-License-Identifier: Apache-2.0
// The visible area lights. Changed lights are copied into one upload buffer per frame slot. On
// llvmpipe, cull_emitters leaves out those that cover no sample.
#pragma once

#include <array>
#include <bit>
#include <cstdint>
#include <span>
#include <vector>

#include "candelabra/candelabra.h"
#include "gpu/kernel.h"
#include "shared/light_type_list.h"
#include "shared/raster.h"

namespace candelabra::gbuffer
{

class Emitters
{
public:
    Emitters(const gpu::Device& device, uint32_t slots);

    // Stores the area lights among `lights`. Throws gpu::Failure; then the previous set stays.
    void set(std::span<const CndLight> lights, const double origin[3]);

    // Fills the buffers of `slot` with the latest set. `rasterFrame` holds the slot's RasterFrame.
    // The GPU must have finished the slot's previous frame.
    void update(uint32_t slot, const gpu::Buffer& rasterFrame) noexcept;
    // Tells whether recordCulling() has anything to do.
    bool canCull() const { return !empty() && culls(bytes()); }
    // Records cull_emitters. Needed before drawing culled emitters.
    void recordCulling(const gpu::Frame& frame) const noexcept;

    // The buffer to draw from: all emitters of `slot`, or those that culling left.
    VkBuffer buffer(uint32_t slot, bool culled) const
    {
        const Buffers& buffers = slots_[slot].buffers;
        return culled ? buffers.kept.get() : buffers.records.get();
    }
    // gpu::EmitterDraw for each piece; Group tells which.
    VkBuffer draws(uint32_t slot) const { return slots_[slot].buffers.draws.get(); }

    // The offset of the gpu::EmitterCorners of the polygons in the buffer, in bytes. If there are
    // none, at least as many bytes as one element follow.
    VkDeviceSize cornersOffset() const { return cornersOffsetOf(records_.size()); }

    // The lights of one shape, contiguous in the buffer.
    struct Group {
        uint32_t first = 0, count = 0;
        uint32_t firstPiece = 0, pieceCount = 0; // of cull_emitters
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
    struct Buffers {
        gpu::Buffer records;
        gpu::Buffer kept, draws; // of cull_emitters; empty if there is none

        bool hold(VkDeviceSize bytes) const { return records.size >= bytes; }
    };
    struct Slot {
        Buffers buffers;
        // Replace `buffers` at the next update, because the GPU may still read these until then.
        Buffers larger;
        uint64_t version = 0;
    };
    Buffers createBuffers(VkDeviceSize bytes) const;
    // Tells whether cull_emitters is run for so many bytes of emitters. If a storage buffer cannot
    // hold them, all are drawn.
    bool culls(VkDeviceSize bytes) const
    {
        return culls_ && bytes <= device_->limits.maxStorageBufferRange;
    }
    VkDeviceSize bytes() const
    {
        return cornersOffset() + corners_.size() * sizeof(gpu::EmitterCorners);
    }
    static VkDeviceSize cornersOffsetOf(size_t records)
    {
        return (records * sizeof(gpu::EmitterRecord) + 15) / 16 * 16; // aligned to a vec4
    }

    const gpu::Device* device_;
    bool culls_;
    gpu::Kernel<gpu::CullEmittersParams> cullEmitters_;
    gpu::Bindings cullSets_; // one per slot
    std::vector<Slot> slots_;
    std::vector<gpu::EmitterRecord> records_;
    std::vector<gpu::EmitterCorners> corners_; // one per polygon, or one that nothing reads
    std::array<Group, shapeCount> groups_{};
    std::array<double, 3> origin_{};
    uint64_t version_ = 0;
};

} // namespace candelabra::gbuffer
