// SPDX-License-Identifier: Apache-2.0
#include <algorithm>
#include <cmath>
#include <cstring>
#include <limits>

#include <glm/mat3x3.hpp>
#include <glm/mat4x4.hpp>

#include "lighting/lighting.h"
#include "surfaces/camera.h"
#include "view/view_plan.h"

namespace candelabra::lighting
{
namespace
{

using gpu::divideUp;

constexpr VkDeviceSize defaultListBudget = 64u << 20;
// Tiles longer than so many radii of influence are split. Half and twice of it are as fast
// (DECISIONS 25).
constexpr float splitLength = 2;
constexpr uint32_t maxGroupsPerDimension = 65535; // Vulkan's guaranteed maxComputeWorkGroupCount
constexpr uint32_t maxSide = 16384;               // pixels, of a view
constexpr uint32_t defaultSampleCount = 64;
static_assert(maxSide / gpu::TILE_SIZE * (maxSide / gpu::TILE_SIZE) <=
              maxGroupsPerDimension * gpu::TILE_CLUSTERS_GROUP);

constexpr VkBufferUsageFlags storageUse = VK_BUFFER_USAGE_STORAGE_BUFFER_BIT;

struct Readback {
    gpu::LightingCounters counters;
    uint32_t marker; // low half of the recording's number, written last
};

uint64_t join(glm::uvec2 lowHigh)
{
    return uint64_t(lowHigh.y) << 32 | lowHigh.x;
}

CndLightingViewDesc checked(const gpu::Device& device, CndLightingViewDesc desc)
{
    if (desc.structSize != sizeof desc)
        gpu::failArgument("CndLightingViewDesc: structSize is " + std::to_string(desc.structSize) +
                          ", this library expects " + std::to_string(sizeof desc));
    for (const uint32_t side : {desc.maxWidth, desc.maxHeight})
        if (side < 1 || side > maxSide)
            gpu::failArgument("CndLightingViewDesc: maxWidth and maxHeight must be 1..16384, are " +
                              std::to_string(desc.maxWidth) + " and " +
                              std::to_string(desc.maxHeight));
    if (!desc.listBudget)
        desc.listBudget =
            std::min<VkDeviceSize>(defaultListBudget, device.limits.maxStorageBufferRange);
    if (desc.listBudget > device.limits.maxStorageBufferRange)
        gpu::failUnsupported("CndLightingViewDesc: listBudget " + std::to_string(desc.listBudget) +
                             " exceeds the device's maxStorageBufferRange " +
                             std::to_string(device.limits.maxStorageBufferRange));
    return desc;
}

} // namespace

View::View(Lighting& lighting, const CndLightingViewDesc& desc)
    : lighting_(lighting),
      desc_(checked(lighting.device(), desc)),
      timer_(lighting.device(), "lighting", lighting.desc().framesInFlight,
             lighting.desc().timestamps),
      clusters_(lighting, {tiles(desc_.maxWidth), tiles(desc_.maxHeight)}, desc_.listBudget),
      gbufferParams_(lighting.device(), lighting.desc().framesInFlight),
      slots_(lighting.desc().framesInFlight)
{
    const gpu::Device& device = lighting.device();
    const uint32_t slots = lighting.desc().framesInFlight;
    const uint32_t perType = slots * CND_LIGHT_TYPE_COUNT;
    const Kernels& k = lighting.kernels();
    const ShadeKernels::Variant& shade = k.shade.anyVariant();
    sets_ = {.prepareLights = k.prepareLights.createBindings(slots),
             .shadeTiles = shade.any.shade.createBindings(perType),
             .shadeUnlisted = shade.any.unlisted.createBindings(perType),
             .shadeBrute = shade.brute.createBindings(slots),
             .countPairs = shade.any.countPairs.createBindings(perType),
             .surfaceOverlay = k.surfaceOverlay.createBindings(slots)};
    counters_ = gpu::createBuffer(device, "lighting counters", sizeof(gpu::LightingCounters),
                                  storageUse | VK_BUFFER_USAGE_TRANSFER_SRC_BIT |
                                      VK_BUFFER_USAGE_TRANSFER_DST_BIT,
                                  gpu::MemoryUse::Scratch);
    for (uint32_t i = 0; i < slots; ++i) {
        readback_.push_back(gpu::createBuffer(device, "lighting statistics", sizeof(Readback),
                                              VK_BUFFER_USAGE_TRANSFER_DST_BIT,
                                              gpu::MemoryUse::Readback));
        // Reused memory may hold the marker of an earlier view's recording.
        readback_.back().as<Readback>()[0].marker = 0;
    }
    if (lighting.desc().forwardStages)
        forward_ = ForwardLights(device, lighting.desc().forwardStages, slots);
    if (lighting.desc().influenceByError)
        influence_ = Influence(lighting, {desc_.maxWidth, desc_.maxHeight});
    makeRoom(lighting.typeCounts());
    lighting.add(this);
}

LightTypeCounts View::typesOf(const CndLightingFrame& frame) const
{
    if (frame.culling == CND_CULLING_BRUTE) // the check: it knows no bound
        return lighting_.typeCounts();
    const uint32_t layers = layersOf(frame.layers);
    return influenceOf(frame) == CND_INFLUENCE_GIVEN
               ? lighting_.countsInView(frame.camera, layers)
               : lighting_.countsInLayers(layers); // they may reach the view from anywhere
}

View::Plan View::plan(const CndLightingFrame& frame) const
{
    const CndInfluenceRule influence = influenceOf(frame);
    Plan p{.projection = projectionOf(frame.camera.clipFromView, frame.clearDepth),
           .size = {frame.width, frame.height},
           .invImageSize = 1.0f / glm::vec2(frame.width, frame.height),
           .clearDepth = frame.clearDepth,
           .lightCount = lighting_.lightCount(),
           .lights = typesOf(frame),
           .trees = treeShapes(lighting_.typeCounts()),
           .tileCountX = tiles(frame.width),
           .tileCountY = tiles(frame.height),
           .sampleCount = frame.sampleCount ? frame.sampleCount : defaultSampleCount,
           // Radii that are not those that are given are not known here.
           .splitLength = influence == CND_INFLUENCE_GIVEN
                              ? splitLength * lighting_.extent().influenceRadius
                              : std::numeric_limits<float>::infinity()};
    glm::dmat4 viewFromWorld;
    std::memcpy(&viewFromWorld, frame.camera.viewFromWorld, sizeof viewFromWorld);
    const double* o = lighting_.origin();
    p.prepare = {.viewFromWorld = glm::mat3(glm::dmat3(viewFromWorld)),
                 .originView = glm::vec3(viewFromWorld * glm::dvec4(o[0], o[1], o[2], 1)),
                 .lightCount = p.lightCount,
                 .layers = layersOf(frame.layers),
                 .uncut = influence != CND_INFLUENCE_GIVEN};
    return p;
}

void View::record(VkCommandBuffer cmd, const CndLightingFrame& frame)
{
    validate(frame);
    const Plan plan = this->plan(frame);
    writeBindings(frame);

    const uint32_t slot = frame.frameSlot;
    const bool keep = keepsLists(frame, plan.sampleCount);
    const FramePasses passes(contentOf(frame, plan.lights, keep));
    slots_[slot] = {lighting_.nextRecording(), lighting_.typeCounts(), passes};
    const gpu::Frame f{lighting_.device(), cmd, timer_, slot, frame.hostSet};
    f.device.beginLabel(cmd, "candelabra lighting");
    timer_.begin(cmd, slot);

    forward_.recordBegin(f, forwardView(frame, plan));
    f.barrier(); // against the frame before, which uses the same buffers
    lighting_.recordUpload(f, slots_[slot].recording);
    // Those of lists stay with them.
    const VkDeviceSize firstCounter =
        keep ? offsetof(gpu::LightingCounters, listedPairs) : VkDeviceSize(0);
    f.device.CmdFillBuffer(cmd, counters_.get(), firstCounter, VK_WHOLE_SIZE, 0);
    f.barrier();
    lighting_.recordDeviceCounts(f, counters_);
    if (passes.runs(Pass::ShadeTiles) || passes.runs(Pass::ShadeBrute)) {
        lighting_.recordGBuffer(f);
        lighting_.recordTables(f, passes.runs(Pass::DfgTable));
        if (passes.runs(Pass::PrepareLights))
            recordPrepare(f, plan);
        if (passes.runs(Pass::TileClusters))
            clusters_.recordReset(f, lighting_.typeCounts());
        f.barrier();
        if (passes.runs(Pass::MeasureInfluence))
            recordInfluence(f, frame, plan);
        recordClusters(f, plan, passes);
        if (passes.runs(Pass::ClusterLists))
            recordLists(f, frame, plan);
        for (uint32_t type = 0; type < CND_LIGHT_TYPE_COUNT; ++type)
            if (plan.lights[type]) {
                if (passes.runs(Pass::ShadeTiles))
                    recordClustered(f, frame, plan, type);
                else
                    recordBrute(f, frame, plan, type);
            }
    }
    forward_.recordEnd(f);
    f.barrier();
    recordReadback(f);
    f.device.endLabel(cmd);
}

void View::recordPrepare(const gpu::Frame& f, const Plan& plan) const noexcept
{
    lighting_.kernels().prepareLights.dispatch(
        f, sets_.prepareLights.set(f.slot), plan.prepare,
        divideUp(plan.lightCount, gpu::PREPARE_LIGHTS_GROUP));
}

void View::recordClusters(const gpu::Frame& f, const Plan& p,
                          const FramePasses& passes) const noexcept
{
    if (passes.runs(Pass::TileClusters)) {
        clusters_.recordClusters(f,
                                 {.projection = p.projection,
                                  .size = p.size,
                                  .tileCountX = p.tileCountX,
                                  .tileCount = p.tileCountX * p.tileCountY,
                                  .clearDepth = p.clearDepth,
                                  .invImageSize = p.invImageSize,
                                  .splitLength = p.splitLength},
                                 passes.runs(Pass::BlockClusters));
        const auto count = [&](const gpu::Buffer& work, uint32_t list, VkDeviceSize counter) {
            const VkBufferCopy copy{.srcOffset = workListAt(list) + offsetof(gpu::WorkList, count),
                                    .dstOffset = counter,
                                    .size = sizeof(uint32_t)};
            f.device.CmdCopyBuffer(f.cmd, work.get(), counters_.get(), 1, &copy);
        };
        for (uint32_t tileClass = 0; tileClass < gpu::TILE_CLASSES; ++tileClass)
            count(clusters_.surfaces(), tileClass,
                  offsetof(gpu::LightingCounters, surfaceTiles) + tileClass * sizeof(uint32_t));
        count(clusters_.splits(), 0, offsetof(gpu::LightingCounters, splitTiles));
    }
    if (passes.runs(Pass::LightTree))
        for (uint32_t type = 0; type < CND_LIGHT_TYPE_COUNT; ++type)
            if (p.lights[type] && !isDistant(type))
                clusters_.recordTree(f, p.trees[type]);
}

void View::recordLists(const gpu::Frame& f, const CndLightingFrame& frame,
                       const Plan& p) const noexcept
{
    for (uint32_t type = 0; type < CND_LIGHT_TYPE_COUNT; ++type)
        if (p.lights[type] && !isDistant(type))
            clusters_.recordLists(f, type, p.trees[type], {p.tileCountX, p.tileCountY},
                                  lightsPerBatch(frame, p, type));
    f.barrier();
}

gpu::ForwardView View::forwardView(const CndLightingFrame& frame, const Plan& p) const noexcept
{
    gpu::ForwardView view{.projection = p.projection, .lobes = lobesOf(frame), .trees = {}};
    for (uint32_t type = 0; type < CND_LIGHT_TYPE_COUNT; ++type)
        if (p.lights[type])
            view.trees[type] = p.trees[type];
    return view;
}

void View::recordReadback(const gpu::Frame& f) const noexcept
{
    const gpu::Device& d = f.device;
    const VkBuffer target = readback_[f.slot].get();
    const VkBufferCopy copy{.size = sizeof(gpu::LightingCounters)};
    d.CmdCopyBuffer(f.cmd, counters_.get(), target, 1, &copy);
    f.barrier(); // the marker says that all of the frame is done
    d.CmdFillBuffer(f.cmd, target, offsetof(Readback, marker), sizeof(uint32_t),
                    uint32_t(slots_[f.slot].recording));
    f.hostBarrier();
}

uint64_t View::oldestRunning() const
{
    uint64_t oldest = 0;
    for (size_t i = 0; i < slots_.size(); ++i) {
        const uint64_t recording = slots_[i].recording;
        const bool finished = readback_[i].as<Readback>()[0].marker == uint32_t(recording);
        if (recording && !finished && (!oldest || recording < oldest))
            oldest = recording;
    }
    return oldest;
}

uint64_t View::oldestPending() const
{
    uint64_t oldest = 0;
    for (const SlotState& slot : slots_)
        if (slot.recording && (!oldest || slot.recording < oldest))
            oldest = slot.recording;
    return oldest;
}

CndResult View::stats(uint32_t slot, CndLightingStats& out) const noexcept
{
    if (slot >= slots_.size() || !slots_[slot].recording || out.structSize != sizeof out)
        return CND_ERROR_INVALID_ARGUMENT;
    const Readback read = readback_[slot].as<Readback>()[0];
    if (read.marker != uint32_t(slots_[slot].recording))
        return CND_NOT_READY;
    const gpu::LightingCounters& c = read.counters;
    out.lightCount = 0;
    for (uint32_t type = 0; type < CND_LIGHT_TYPE_COUNT; ++type)
        out.lightCount += out.lightTypeCounts[type] = slots_[slot].lights[type];
    out.deviceLights = c.deviceLights;
    out.rejectedLights = c.rejectedLights;
    out.tileCount = surfaceTileCount(c);
    out.diffuseTileCount = c.surfaceTiles[gpu::CLASS_DIFFUSE];
    out.specularTileCount = c.surfaceTiles[gpu::CLASS_SPECULAR];
    out.splitTileCount = clusters_.splitTileCount(c.splitTiles);
    out.listEntries = c.listEntries;
    out.maxListLength = c.maxListLength;
    out.unlistedClusters = c.unlistedClusters;
    out.cutBelow = c.cutBelow;
    out.listedPairs = join(c.listedPairs);
    out.evaluatedPairs = join(c.evaluatedPairs);
    out.insidePairs = join(c.insidePairs);
    out.contributingPairs = join(c.contributingPairs);
    FramePasses passes = slots_[slot].passes;
    passes.addFindings(c);
    passes.write(out.passes, out.passCount);
    return timer_.read(slot, out.kernelTimes, out.kernelTimeCount);
}

} // namespace candelabra::lighting
