// SPDX-License-Identifier: Apache-2.0
// View: the buffers of one view, and the passes of its frames in their order.
#pragma once

#include <optional>

#include "clusters/clusters.h"
#include "view/forward.h"
#include "view/frame_passes.h"
#include "view/frame_plan.h"

namespace candelabra::lighting
{

class View
{
public:
    // `module` must outlive it.
    View(const Module& module, const CndLightingViewDesc& desc);
    View(const View&) = delete;
    View& operator=(const View&) = delete;

    // Both throw gpu::Failure on arguments out of range; once recording starts nothing can fail.
    void record(VkCommandBuffer cmd, const CndLightingFrame& frame);
    void recordOverlay(VkCommandBuffer cmd, const CndLightingFrame& frame,
                       const CndSurfaceOverlay& overlay); // surface_overlay.cpp

    CndResult stats(uint32_t slot, CndLightingStats& stats) const noexcept;
    // Tells the host of statistics that it should do something about, once.
    void tell(const CndLightingStats& stats) const noexcept;
    VkDescriptorSet forwardSet(uint32_t slot) const; // throws gpu::Failure when there is none
    // Makes room for a set of lights that the module is about to take; throws when that fails.
    void makeRoom(uint32_t lightCapacity, LightTypeCounts types);

private:
    // What the lists of a frame were made for, besides its surfaces.
    struct ListsKey {
        uint64_t lightSet = 0; // 0: there are no lists
        CndSpecularMethod method = CND_SPECULAR_NONE;
        uint32_t sampleCount = 0;
        uint32_t layers = 0;
        CndInfluenceRule rule = CND_INFLUENCE_GIVEN;
        bool operator==(const ListsKey&) const = default;
    };

    // record.cpp
    bool keepsLists(const FramePlan& plan);
    FrameContent contentOf(const FramePlan& plan, bool listsKept) const;
    void recordPasses(const gpu::Frame& f, const FramePlan& plan,
                      const FramePasses& passes) noexcept;
    void recordInfluence(const gpu::Frame& f, const FramePlan& plan) noexcept;
    void recordClusters(const gpu::Frame& f, const FramePlan& plan,
                        const FramePasses& passes) const noexcept;
    void recordTileCounts(const gpu::Frame& f) const noexcept;
    void recordLists(const gpu::Frame& f, const FramePlan& plan) const noexcept;
    void recordClustered(const gpu::Frame& f, const FramePlan& plan, uint32_t type) const noexcept;
    void recordUnlisted(const gpu::Frame& f, const FramePlan& plan, uint32_t type) const noexcept;
    void recordCountPairs(const gpu::Frame& f, const FramePlan& plan, uint32_t type) const noexcept;
    void recordBrute(const gpu::Frame& f, const FramePlan& plan, uint32_t type) const noexcept;
    uint32_t lightsPerBatch(const FramePlan& plan, uint32_t type) const noexcept;

    // bindings.cpp
    void writeBindings(const FramePlan& plan) const;
    void writeShadeBindings(const CndLightingFrame& frame, const surfaces::GBufferViews& images,
                            uint32_t type) const;
    void writeBruteBindings(const CndLightingFrame& frame,
                            const surfaces::GBufferViews& images) const;

    // One set per slot; of the kernels that shade clusters one per slot and light type.
    struct Sets {
        gpu::Bindings prepareLights, shadeTiles, shadeUnlisted, shadeBrute, countPairs,
            surfaceOverlay;
    };
    // What statistics of a slot's recording say that the device does not count.
    struct SlotPlan {
        LightTypeCounts lights{};
        FramePasses passes;
    };

    const Module& module_;
    CndLightingViewDesc desc_;
    gpu::Timer timer_;
    Clusters clusters_;
    surfaces::FrameUniforms uniforms_;
    // An overlay may be recorded after the lighting of its slot, with another camera or other
    // settings, before the GPU has read what the lighting wrote: it needs a buffer of its own.
    surfaces::FrameUniforms overlayUniforms_;
    Sets sets_;
    gpu::Buffer core_, shapes_, ids_; // one per light; when nobody reads ids, one in all
    gpu::Buffer counters_;            // gpu::LightingCounters
    gpu::RecordingSlots slots_;       // they read the counters back
    std::vector<SlotPlan> plans_;     // per slot
    ForwardLights forward_;
    std::optional<Influence> influence_; // CndLightingDesc::influenceByError
    ListsKey lists_;                     // of the frame recorded last
    mutable bool toldUnlisted_ = false;
    mutable uint64_t toldRejected_ = 0; // light set
};

} // namespace candelabra::lighting
