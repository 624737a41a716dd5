// SPDX-License-Identifier: Apache-2.0
// The shadows of one view: what its pixels see of each light between the occluders
// (shared/occluder_data.h), and the passes that find it.
#pragma once

#include "clusters/clusters.h"
#include "occluders/occluder_set.h"
#include "occluders/prepared_occluders.h"
#include "shading/shade_kernels.h"
#include "view/frame_plan.h"

namespace candelabra::lighting
{

// What a frame uses of the previous one instead of making it again.
struct KeptWork {
    bool lists = false; // clusters and lists, and the occluders of the view
    bool slots = false; // the visibility of all lights in view; only together with lists
};

class Shadows
{
public:
    // `budget`: bytes for slots. `maxTiles`: of the largest frame. All arguments must outlive this
    // object.
    Shadows(const Module& module, const Clusters& clusters, uint32_t slots, VkDeviceSize budget,
            uint32_t maxTiles);
    Shadows(const Shadows&) = delete;
    Shadows& operator=(const Shadows&) = delete;

    // Returns the bytes of the slots of a distant light.
    static VkDeviceSize distantBytes(uint32_t tiles);

    void makeRoom(uint32_t places) { prepared_.makeRoom(places); }

    struct Inputs {
        const surfaces::GBufferViews& gbuffer;
        const surfaces::FrameUniforms& uniforms;
        const gpu::Buffer &core, &shapes, &ids, &albedoTable, &counters;
    };
    // Writes the bindings of the frame's kernels.
    void writeBindings(const FramePlan& plan, const Inputs& inputs) const;
    // The bindings through which kernels walk through occluders.
    std::array<gpu::Binding, 5> occluderBindings(uint32_t slot) const;
    // The same buffers as texels. The forward set does not have them.
    std::array<gpu::Binding, 3> occluderTexels() const;
    // The binding of the gpu::ShadowCounters.
    static gpu::Binding counters(const gpu::Buffer& counters,
                                 uint32_t binding = gpu::SHADE_COUNTERS);
    gpu::Binding view(uint32_t slot) const;
    uint32_t capacity() const { return capacity_; } // slots that lists may take
    gpu::Binding slots() const { return gpu::Binding::of(gpu::SHADOW_SLOTS, slots_); }
    // The bindings through which kernels find the visible shares of lights in lists.
    std::array<gpu::Binding, 3> slotBindings() const;

    // Tells whether a frame leaves the visibility of all of its lights in the slots. Otherwise its
    // distant lights take those of the lists, or rays of the host find other points each time.
    bool keepsSlots(const FramePlan& plan) const noexcept;
    // Returns the first slot of a batch of distant lights.
    uint32_t firstSlotOf(const FramePlan& plan, uint32_t type,
                         const gpu::LightBatch& batch) const noexcept;

    // Writes the parameters of the frame, after the upload of its occluders. Clears the counters
    // except those of what is kept.
    void recordBegin(const gpu::Frame& frame, const FramePlan& plan, const gpu::Buffer& counters,
                     const KeptWork& kept) const noexcept;
    // Records what the other passes need, for frames that prepare lights. The caller puts barriers
    // before and after, and one between.
    void recordPrepare(const gpu::Frame& frame, const FramePlan& plan) const noexcept;
    void recordPolygons(const gpu::Frame& frame, const FramePlan& plan) const noexcept;
    // Finds the visibility of every light in the lists of a type, whose slots follow those of the
    // types before. Ends with a barrier.
    void recordListed(const gpu::Frame& frame, const FramePlan& plan, uint32_t type) const noexcept;
    // Returns how many lights recordBatch() can take at once.
    uint32_t lightsPerBatch(glm::uvec2 tileCount) const noexcept;
    // Finds the visibility of the lights of a batch in tiles from a pixel on. Ends with a barrier.
    void recordBatch(const gpu::Frame& frame, uint32_t type, const gpu::LightBatch& batch,
                     uint32_t firstSlot, glm::uvec2 firstPixel,
                     glm::uvec2 tileCount) const noexcept;
    // Counts what recordListed(), or recordBatch() with this batch for all tiles, has found.
    void recordCounts(const gpu::Frame& frame, const FramePlan& plan, uint32_t type,
                      const gpu::LightBatch& batch) const noexcept;

private:
    void writeListBindings(uint32_t slot, uint32_t type, const Inputs& inputs,
                           const gpu::BindingList& occluders) const;
    // The offset of each slot is a multiple of this, the largest minUniformBufferOffsetAlignment
    // that Vulkan allows a device.
    static constexpr VkDeviceSize viewStride = 256;
    uint32_t setOf(const gpu::Frame& frame, uint32_t type) const noexcept
    {
        return frame.slot * CND_LIGHT_TYPE_COUNT + type;
    }

    const Module& module_;
    const Clusters& clusters_;
    PreparedOccluders prepared_;
    uint32_t capacity_; // of slots that lists may take; those of distant lights follow
    gpu::Buffer slots_, asked_, bounds_, pagePairs_, points_, views_;
    gpu::Bindings askSets_, visibilitySets_, countSets_, listSets_; // per slot and type
    gpu::Bindings polygonSets_;                                     // per slot
};

} // namespace candelabra::lighting
