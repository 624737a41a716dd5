// SPDX-License-Identifier: Apache-2.0
// One view: its buffers, and the passes of its frames in their order.
#pragma once

#include <optional>

#include "clusters/clusters.h"
#include "view/dark_proofs.h"
#include "view/forward.h"
#include "view/frame_passes.h"
#include "view/frame_plan.h"
#include "view/shadows.h"

namespace candelabra::lighting
{

class View
{
public:
    // `module` must outlive the view.
    View(const Module& module, const CndLightingViewDesc& desc);
    View(const View&) = delete;
    View& operator=(const View&) = delete;

    // Both throw gpu::Failure, before anything is recorded, if an argument is out of range.
    void record(VkCommandBuffer cmd, const CndLightingFrame& asked);
    void recordOverlay(VkCommandBuffer cmd, const CndLightingFrame& frame,
                       const CndSurfaceOverlay& overlay); // surface_overlay.cpp

    CndResult stats(uint32_t slot, CndLightingStats& stats) const noexcept;
    // Sends the host a message, once, for each statistic of a slot that shows a problem. `stats`:
    // what stats() has just returned.
    void reportProblems(const CndLightingStats& stats) const noexcept;
    VkDescriptorSet forwardSet(uint32_t slot) const; // throws gpu::Failure if there is none
    // Makes room for a set of lights before the module takes it. Throws gpu::Failure if that fails.
    void makeRoom(uint32_t lightCapacity, LightTypeCounts types);
    // Makes room for so many occluders, in the same way.
    void makeRoomForOccluders(uint32_t places)
    {
        lists_ = {}; // as in makeRoom()
        if (shadows_)
            shadows_->makeRoom(places);
    }

private:
    // The values on which the lists of a frame depend, apart from its surfaces. A frame may reuse
    // the lists of the previous one if they are the same.
    struct ListsKey {
        uint64_t lightSet = 0; // 0: there are no lists
        CndSpecularMethod method = CND_SPECULAR_DEFAULT;
        uint32_t sampleCount = 0;
        uint32_t layers = 0;
        CndInfluenceRule rule = CND_INFLUENCE_GIVEN;
        bool shadows = false;   // lists without slots count as having no pages
        uint64_t occluders = 0; // number of the occluder set
        bool operator==(const ListsKey&) const = default;
    };

    gpu::ShadowCounters shadowCounters(const gpu::LightingCounters* counted) const noexcept;
    void makeRoomForShapes(VkDeviceSize lights, VkDeviceSize polygons);
    void reportMissing(const CndLightingStats& stats) const noexcept;

    // record.cpp
    KeptWork keptWork(const FramePlan& plan);
    FrameContent contentOf(const FramePlan& plan, const KeptWork& kept) const;
    void recordPasses(const gpu::Frame& f, const FramePlan& plan,
                      const FramePasses& passes) noexcept;
    void recordProjectDepth(const gpu::Frame& f, const FramePlan& plan) const noexcept;
    void recordInfluence(const gpu::Frame& f, const FramePlan& plan) noexcept;
    void recordClusters(const gpu::Frame& f, const FramePlan& plan,
                        const FramePasses& passes) const noexcept;
    void recordTileCounts(const gpu::Frame& f) const noexcept;
    void recordLists(const gpu::Frame& f, const FramePlan& plan,
                     const FramePasses& passes) const noexcept;
    void recordClustered(const gpu::Frame& f, const FramePlan& plan, const FramePasses& passes,
                         uint32_t type) const noexcept;
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

    // Returns what the forward set has for shadows (ForwardShadows).
    gpu::BindingList forwardShadowBindings(uint32_t slot) const;

    // One descriptor set per slot. shadeTiles, shadeUnlisted and countPairs have one per slot and
    // light type.
    struct Sets {
        gpu::Bindings prepareLights, shadeTiles, shadeUnlisted, shadeBrute, countPairs,
            surfaceOverlay, projectDepth;
    };
    // The part of the statistics of a slot's recording that the device does not count.
    struct SlotPlan {
        LightTypeCounts lights{};
        FramePasses passes;
    };

    const Module& module_;
    CndLightingViewDesc desc_;
    gpu::Timer timer_;
    Clusters clusters_;
    surfaces::FrameUniforms uniforms_;
    // The overlay's parameters have a buffer of their own: an overlay with another camera may be
    // recorded for the same slot before the GPU has read the parameters of the lighting.
    surfaces::FrameUniforms overlayUniforms_;
    Sets sets_;
    gpu::Buffer core_, shapes_, ids_; // per light; ids_ holds one element if nothing reads ids
    VkDeviceSize polygonRoom_ = 0;    // how many polygons have room for their corners in shapes_
    gpu::Image depth_;     // what project_depth computes; empty if the host's depth is projected
    gpu::Buffer counters_; // gpu::LightingCounters
    gpu::RecordingSlots slots_;   // through which the host reads the counters
    std::vector<SlotPlan> plans_; // per slot
    ForwardLights forward_;
    std::optional<Influence> influence_; // CndLightingDesc::influenceByError
    std::optional<Shadows> shadows_;     // CndLightingDesc::shadows
    std::optional<DarkProofs> proofs_;   // the same
    ListsKey lists_;                     // what the lists of the last frame were made for
    // What reportProblems() has already sent a message about.
    struct Told {
        bool pages = false, slots = false, length = false; // why clusters have no list
        bool unfinished = false; // pairs whose occluders were not all found
        uint64_t rejected = 0;   // lights of the light set of this number
    };
    mutable Told told_;
};

} // namespace candelabra::lighting
