// SPDX-License-Identifier: Apache-2.0
// The lighting module behind the C ABI: Lighting holds pipelines and lights, View the buffers of
// one view and the order of the passes.
#pragma once

#include <deque>
#include <memory>
#include <vector>

#include "clusters/clusters.h"
#include "gpu/kernel.h"
#include "lights/device_lights.h"
#include "lights/light_order.h"
#include "lights/light_table.h"
#include "lights/pack_lights.h"
#include "lights/reach.h"
#include "shading/influence.h"
#include "shading/shade_kernels.h"
#include "shared/lighting.h"
#include "shared/surface_overlay.h"
#include "surfaces/host_gbuffer.h"
#include "surfaces/host_kernels.h"
#include "tables/dfg_table.h"
#include "view/forward.h"
#include "view/frame_passes.h"

namespace candelabra::lighting
{

class View;

// Largest light set that a device with these limits can take.
uint32_t maxLights(const VkPhysicalDeviceLimits& limits);

struct Kernels {
    // `gbuffer`: value of SPEC_GBUFFER. `host` must outlive it.
    Kernels(const gpu::Device& device, const HostKernels& host, const CndLightingDesc& desc,
            uint32_t gbuffer, bool withIds);
    gpu::Kernel<gpu::PrepareLightsParams> prepareLights;
    LightOrder order;
    ClusterKernels clusters;
    ShadeKernels shade;
    InfluenceKernels influence; // CndLightingDesc::influenceByError
    gpu::Kernel<gpu::SurfaceOverlayParams> surfaceOverlay;
};

class Lighting
{
public:
    Lighting(const CndDeviceDesc& device, const CndLightingDesc& desc);

    // Validates, packs into the staging slot of the next recording, grows buffers when needed.
    void setLights(const CndLightSet& set);
    // Edits of the set (light_edits.cpp); `ids`: as many as lights.
    void addLights(std::span<const CndLight> lights, CndLightId* ids);
    void updateLights(std::span<const CndLightId> ids, std::span<const CndLight> lights);
    void removeLights(std::span<const CndLightId> ids);
    // Copies what changed of the light set to the device and sorts it; barriers before and after
    // are the caller's.
    void recordUpload(const gpu::Frame& frame, uint64_t recording) noexcept;
    // What was found of lights on the device, into LightingCounters.
    void recordDeviceCounts(const gpu::Frame& frame, const gpu::Buffer& counters) const noexcept;
    // Makes what reads the G-buffer ready, once; before all that does.
    void recordGBuffer(const gpu::Frame& frame) noexcept { gbuffer_.record(frame); }
    // Fills, once each, the tables that shading reads; directional albedos only on demand.
    void recordTables(const gpu::Frame& frame, bool directionalAlbedo) noexcept;

    // Views register to have their light-sized buffers grown with the set.
    void add(View* view) { views_.push_back(view); }
    void remove(View* view) { std::erase(views_, view); }
    // Replaces buffers or sets; the old ones stay alive until no frame in flight can use them.
    template <typename T>
    void replace(T& old, T&& with)
    {
        replace(old, std::move(with), recordings_);
    }
    // `last`: number of the last recording that may use the old one.
    template <typename T>
    void replace(T& old, T&& with, uint64_t last)
    {
        retired_.push_back({nullptr, last}); // first: when it fails, `old` may be in use
        retired_.back().object = std::make_shared<T>(std::move(old));
        old = std::move(with);
    }
    // Numbers recordings of all views from 1.
    uint64_t nextRecording() noexcept { return ++recordings_; }

    const gpu::Device& device() const { return device_; }
    const CndLightingDesc& desc() const { return desc_; }
    const GBufferSource& gbuffer() const { return gbuffer_; }
    const HostKernels& hostKernels() const { return hostKernels_; }
    // Shaders may ask which light a light is.
    bool readsIds() const { return desc_.forwardStages || !hostKernels_.empty(); }
    const Kernels& kernels() const { return kernels_; }
    const gpu::Buffer& records() const { return store_.records; }
    const gpu::Buffer& lightOrder() const { return store_.sort.keys[0]; }
    const gpu::Buffer& directionalAlbedo() const { return dfg_.buffer(); }
    const gpu::Buffer& transformedCosines() const { return ltc_; }
    VkDescriptorSetLayout forwardLayout() const; // throws gpu::Failure when there is none
    uint32_t lightCount() const { return lightCount_; }
    // Number of the light set, from 1: another one has other lights.
    uint64_t lightSet() const { return lightSet_; }
    uint32_t lightCapacity() const { return lightCapacity_; }
    const LightExtent& extent() const { return extent_; }
    // Lights by type, 0 for types none of which reaches the view.
    LightTypeCounts countsInView(const CndCamera& camera, uint32_t layers) const;
    // The same wherever lights reach: 0 for types none of which has one of these layers.
    LightTypeCounts countsInLayers(uint32_t layers) const;
    // False only when no light has one of these layers.
    bool hasLightsIn(uint32_t layers) const { return countsInLayers(layers) != LightTypeCounts{}; }
    const LightTypeCounts& typeCounts() const { return typeCounts_; }
    // There is a light set that no recording has uploaded yet.
    bool lightsChanged() const { return pending_; }
    bool hasDeviceLights() const { return deviceLights_.present(); }
    bool deviceLightsChanged() const { return deviceLightsPending_; }
    bool albedoTableFilled() const { return dfg_.filled(); }
    const double* origin() const { return origin_; }
    // The types of a set and those that creation made ready.
    LightTypeCounts withReserved(LightTypeCounts types) const noexcept;
    // Lights that one walk may take, at most: all, unless the device limits loops.
    // `loopIterations`: that evaluating one light takes.
    uint32_t lightsPerBatch(uint32_t loopIterations) const;

private:
    struct Retired {
        std::shared_ptr<void> object;
        uint64_t recording; // number of the last recording that may use it
    };
    struct Staging {
        gpu::Buffer buffer;
        uint64_t recording = 0; // number of the recording that copies from it, 0: none yet
    };
    // What has a place for every light.
    struct Store {
        gpu::Buffer
            records; // device copy of the packed lights: first the device's, then the host's
        LightOrder::State sort;
        std::deque<Staging> staging; // elements stay where they are when it grows
    };
    Store createStore(uint32_t capacity) const;
    // `keepRecords`: they move into larger buffers with the next recording, else all come anew.
    void grow(uint32_t count, const LightTypeCounts& counts, bool keepRecords);
    gpu::Buffer createStaging(uint32_t capacity) const;
    Staging& freeStaging();
    void requireRoom(const char* what, uint64_t count) const;
    void requirePipelines(const LightTypeCounts& counts);
    LightTable::Records prepareEdit(const LightTypeCounts& counts, size_t edits, size_t added);
    void finishEdit(const LightTypeCounts& counts, std::span<const CndLight> lights,
                    size_t edits) noexcept;
    LightTable::Records hostRecords(const Staging& staging) const;
    LightExtent currentExtent() const noexcept;
    void freeRetired();
    // Over all views; recordings_ + 1 when there is none.
    uint64_t oldest(uint64_t (View::*ofView)() const) const;

    gpu::Device device_;
    CndLightingDesc desc_;
    GBufferSource gbuffer_;
    HostKernels hostKernels_;
    Kernels kernels_;
    tables::DfgTable dfg_;
    gpu::Buffer ltc_;
    bool ltcFilled_ = false;
    gpu::Handle<VkDescriptorSetLayout> forwardLayout_;
    std::vector<View*> views_;
    std::vector<Retired> retired_;
    DeviceLights deviceLights_;
    LightExtent extent_;
    ReachBoxes reach_;
    Store store_;
    LightTable lights_;                     // the host's
    Staging* pending_ = nullptr;            // holds what no recording has uploaded yet
    VkBuffer carriedFrom_ = VK_NULL_HANDLE; // smaller records that the next recording copies
    uint32_t onDevice_ = 0;                 // records that recordings so far have filled
    uint32_t firstRecord_ = 0;              // of the host's lights
    uint32_t lightCount_ = 0, lightCapacity_ = 0;
    uint32_t editsSinceExtent_ = 0;
    bool deviceLightsPending_ = false;
    uint64_t lightSet_ = 0;
    LightTypeCounts typeCounts_{};
    double origin_[3]{};
    uint64_t recordings_ = 0;
};

class View
{
public:
    View(Lighting& lighting, const CndLightingViewDesc& desc);
    ~View() { lighting_.remove(this); }
    View(const View&) = delete;
    View& operator=(const View&) = delete;

    // Throws gpu::Failure on arguments out of range; once recording starts nothing can fail.
    void record(VkCommandBuffer cmd, const CndLightingFrame& frame);
    // The same of the overlay (surface_overlay.cpp).
    void recordOverlay(VkCommandBuffer cmd, const CndLightingFrame& frame,
                       const CndSurfaceOverlay& overlay);
    CndResult stats(uint32_t slot, CndLightingStats& stats) const noexcept;
    // Tells the host of statistics that it should do something about, once.
    void tell(const CndLightingStats& stats) const noexcept;
    VkDescriptorSet forwardSet(uint32_t slot) const; // throws gpu::Failure when there is none
    // Called by Lighting before a set of lights: buffers grow, old ones are retired.
    void makeRoom(const LightTypeCounts& types);
    // Number of the oldest recording whose commands have not all run, 0 when all have: what they
    // read may be overwritten.
    uint64_t oldestRunning() const;
    // Number of the oldest recording that the host has not promised to be finished (it does so by
    // recording the slot again), 0 when there is none: what older ones use may be destroyed.
    uint64_t oldestPending() const;

private:
    struct Plan; // sizes derived from a frame
    Plan plan(const CndLightingFrame& frame) const;
    // Lights by type, 0 for types that the frame can do without.
    LightTypeCounts typesOf(const CndLightingFrame& frame) const;
    void validateSurfaces(const CndLightingFrame& frame) const;
    void validate(const CndLightingFrame& frame) const;
    bool keepsLists(const CndLightingFrame& frame, uint32_t sampleCount);
    FrameContent contentOf(const CndLightingFrame& frame, const LightTypeCounts& inView,
                           bool listsKept) const;
    void writeBindings(const CndLightingFrame& frame) const;
    void recordPrepare(const gpu::Frame& f, const Plan& plan) const noexcept;
    void recordInfluence(const gpu::Frame& f, const CndLightingFrame& frame,
                         const Plan& plan) noexcept;
    void recordClusters(const gpu::Frame& f, const Plan& plan,
                        const FramePasses& passes) const noexcept;
    void recordLists(const gpu::Frame& f, const CndLightingFrame& frame,
                     const Plan& plan) const noexcept;
    void recordClustered(const gpu::Frame& f, const CndLightingFrame& frame, const Plan& plan,
                         uint32_t type) const noexcept;
    gpu::ForwardView forwardView(const CndLightingFrame& frame, const Plan& plan) const noexcept;
    gpu::ShadeParams shadeParams(const CndLightingFrame& frame, const Plan& plan,
                                 uint32_t type) const noexcept;
    // Calls `record` for consecutive lights of a type, at most `largest` at once.
    template <typename Record>
    void inBatches(gpu::ShadeParams params, uint32_t largest, Record&& record) const noexcept
    {
        const uint32_t end = params.firstLight + params.lightCount;
        for (; params.firstLight < end; params.firstLight += params.lightCount) {
            params.lightCount = std::min(largest, end - params.firstLight);
            record(params);
        }
    }
    uint32_t lightsPerBatch(const CndLightingFrame& frame, const Plan& plan,
                            uint32_t type) const noexcept;
    void recordUnlisted(const gpu::Frame& f, const CndLightingFrame& frame, gpu::ShadeParams params,
                        uint32_t type, uint32_t perBatch) const noexcept;
    void recordBrute(const gpu::Frame& f, const CndLightingFrame& frame, const Plan& plan,
                     uint32_t type) const noexcept;
    void recordReadback(const gpu::Frame& f) const noexcept;

    // Per slot; those of clustered shading per slot and light type.
    struct Sets {
        gpu::Bindings prepareLights, shadeTiles, shadeUnlisted, shadeBrute, countPairs,
            surfaceOverlay;
    };
    // What lists were made for, besides surfaces.
    struct ListsKey {
        uint64_t lightSet = 0; // 0: there are none
        CndSpecularMethod method = CND_SPECULAR_NONE;
        uint32_t sampleCount = 0;
        uint32_t layers = 0;
        CndInfluenceRule rule = CND_INFLUENCE_GIVEN;
        bool operator==(const ListsKey&) const = default;
    };
    struct SlotState {
        uint64_t recording = 0; // 0: never used
        LightTypeCounts lights{};
        FramePasses passes;
    };

    Lighting& lighting_;
    CndLightingViewDesc desc_;
    gpu::Timer timer_;
    Sets sets_;
    Clusters clusters_;
    GBufferParams gbufferParams_;
    gpu::Buffer core_, aux_, ids_; // per light; ids, when nobody reads them, of one
    ForwardLights forward_;
    Influence influence_; // CndLightingDesc::influenceByError
    gpu::Buffer counters_;
    std::vector<gpu::Buffer> readback_; // per slot
    std::vector<SlotState> slots_;
    ListsKey lists_; // of the frame recorded last
    mutable bool toldUnlisted_ = false;
    mutable uint64_t toldRejected_ = 0; // light set
};

} // namespace candelabra::lighting
