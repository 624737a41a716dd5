// SPDX-License-Identifier: Apache-2.0
// One frame: View::record is the order of its passes, the functions after it are the passes.
#include <algorithm>

#include "shading/light_batches.h"
#include "view/frame_checks.h"
#include "view/view.h"

namespace candelabra::lighting
{
namespace
{

using gpu::divideUp;

// Calls `record` with the kernels and the work list of each class of tiles: no two have a tile in
// common.
template <typename Record>
void byClass(const ShadeKernels& kernels, const CndLightingFrame& frame, uint32_t type,
             Record&& record) noexcept
{
    for (uint32_t tileClass = 0; tileClass < gpu::TILE_CLASSES; ++tileClass)
        if (kernels.tellsApart(tileClass))
            record(kernels.tiles(type, frame.specularMethod, frame.errorBudget > 0, tileClass),
                   workListAt(tileClass));
}

gpu::LightBatch allLights(const FramePlan& p, uint32_t type)
{
    return {p.trees[type].firstLight, p.trees[type].lightCount};
}

gpu::ForwardView forwardView(const FramePlan& p)
{
    gpu::ForwardView view{.projection = p.params.projection, .lobes = p.params.lobes, .trees = {}};
    for (uint32_t type = 0; type < CND_LIGHT_TYPE_COUNT; ++type)
        if (p.lights[type])
            view.trees[type] = p.trees[type];
    return view;
}

} // namespace

void View::record(VkCommandBuffer cmd, const CndLightingFrame& frame)
{
    checkFrame(module_, desc_, frame);
    const FramePlan plan = planFrame(module_, frame);
    writeBindings(plan);

    const uint32_t slot = frame.frameSlot;
    const bool keep = keepsLists(plan);
    const FramePasses passes(contentOf(plan, keep));
    const uint64_t recording = slots_.begin(slot);
    plans_[slot] = {module_.lights.typeCounts(), passes};
    const gpu::Frame f{module_.device, cmd, timer_, slot, frame.hostSet};
    f.device.beginLabel(cmd, "candelabra lighting");
    timer_.begin(cmd, slot);

    forward_.recordBegin(f, forwardView(plan));
    f.barrier(); // against the frame before, which uses the same buffers
    module_.lights.recordUpload(f, recording);
    // Counters of reused lists keep their values: those lists are not made again in this frame.
    const VkDeviceSize firstCounter =
        keep ? offsetof(gpu::LightingCounters, listedPairs) : VkDeviceSize(0);
    f.device.CmdFillBuffer(cmd, counters_.get(), firstCounter, VK_WHOLE_SIZE, 0);
    f.barrier();
    module_.lights.recordDeviceCounts(f, counters_);
    if (passes.runs(Pass::ShadeTiles) || passes.runs(Pass::ShadeBrute))
        recordPasses(f, plan, passes);
    forward_.recordEnd(f);
    f.barrier();
    slots_.recordEnd(f, counters_);
    f.device.endLabel(cmd);
}

// Whether the lists of the frame recorded before are this one's; remembers what this one's are for.
bool View::keepsLists(const FramePlan& p)
{
    const CndLightingFrame& frame = p.frame;
    ListsKey key;
    if (frame.culling == CND_CULLING_CLUSTERED && module_.lights.count())
        key = {module_.lights.number(), frame.specularMethod, p.params.sampleCount,
               layersOf(frame.layers), influenceOf(frame)};
    // What an error allows depends on the other light of the image as well, and is measured at
    // other pixels in each frame.
    const bool same = frame.surfacesUnchanged && key.lightSet &&
                      key.rule != CND_INFLUENCE_BY_ERROR && key == lists_;
    lists_ = key;
    return same;
}

FrameContent View::contentOf(const FramePlan& p, bool listsKept) const
{
    const CndLightingFrame& frame = p.frame;
    const LightSet& lights = module_.lights;
    FrameContent out{.lights = lights.count() > 0,
                     .inLayers = lights.countsInLayers(layersOf(frame.layers)) != LightTypeCounts{},
                     .lightsChanged = lights.isChanged(),
                     .deviceLights = lights.hasDeviceLights(),
                     .deviceLightsChanged = lights.deviceLightsChanged(),
                     .brute = frame.culling == CND_CULLING_BRUTE,
                     .listsKept = listsKept,
                     .readsAlbedoTable = frame.lobes != CND_LOBES_SUM || frame.energyCompensation,
                     .albedoTableFilled = module_.tables.directionalAlbedoFilled(),
                     .cutByError = influenceOf(frame) == CND_INFLUENCE_BY_ERROR,
                     .countPairs = frame.countPairs == VK_TRUE,
                     .forward = forward_.wanted()};
    for (uint32_t type = 0; type < CND_LIGHT_TYPE_COUNT; ++type)
        if (p.lights[type])
            (isDistant(type) ? out.distantInView : out.placedInView) = true;
    return out;
}

void View::recordPasses(const gpu::Frame& f, const FramePlan& p, const FramePasses& passes) noexcept
{
    module_.gbuffer.record(f);
    module_.tables.record(f, passes.runs(Pass::DfgTable));
    if (passes.runs(Pass::PrepareLights))
        module_.kernels.prepareLights.dispatch(
            f, sets_.prepareLights.set(f.slot), p.prepare,
            divideUp(p.prepare.lightCount, gpu::PREPARE_LIGHTS_GROUP));
    if (passes.runs(Pass::TileClusters))
        clusters_.recordReset(f, module_.lights.typeCounts());
    f.barrier();
    if (passes.runs(Pass::MeasureInfluence))
        recordInfluence(f, p);
    recordClusters(f, p, passes);
    if (passes.runs(Pass::ClusterLists))
        recordLists(f, p);
    for (uint32_t type = 0; type < CND_LIGHT_TYPE_COUNT; ++type)
        if (p.lights[type]) {
            if (passes.runs(Pass::ShadeTiles))
                recordClustered(f, p, type);
            else
                recordBrute(f, p, type);
        }
}

// The radii of influence at which the display misses no more light than the frame allows.
void View::recordInfluence(const gpu::Frame& f, const FramePlan& p) noexcept
{
    gpu::Timer untimed; // all rounds are one row
    const gpu::Frame u{f.device, f.cmd, untimed, f.slot};
    const char* measured = nullptr;
    const uint32_t rounds = influence_->recordBegin(u, p.frame);
    for (uint32_t round = 0; round < rounds; ++round) {
        influence_->recordRound(u);
        for (uint32_t type = 0; type < CND_LIGHT_TYPE_COUNT; ++type) {
            if (!p.lights[type])
                continue;
            // Lights are measured in full, whatever the frame's error budget: the kernel has no
            // variant for one.
            const Influence::MeasureKernel& kernel =
                module_.kernels.shade.variant(type, p.frame.specularMethod, false).measure;
            measured = kernel.name();
            // The lanes of a sample share the lights out among them.
            const uint64_t largest =
                uint64_t(lightsPerBatch(p, type)) * gpu::MEASURE_INFLUENCE_LANES;
            inBatches(allLights(p, type), uint32_t(std::min<uint64_t>(largest, UINT32_MAX)),
                      [&](const gpu::LightBatch& batch) {
                          influence_->recordMeasure(u, kernel, {batch, round});
                      });
        }
        influence_->recordChoice(u, round);
    }
    f.timer.stamp(f.cmd, measured);
    influence_->recordCut(f, p.lights, p.trees);
}

void View::recordClusters(const gpu::Frame& f, const FramePlan& p,
                          const FramePasses& passes) const noexcept
{
    if (passes.runs(Pass::TileClusters)) {
        clusters_.recordClusters(f, p.tileCount, p.splitLength, passes.runs(Pass::BlockClusters));
        recordTileCounts(f);
    }
    if (passes.runs(Pass::LightTree))
        for (uint32_t type = 0; type < CND_LIGHT_TYPE_COUNT; ++type)
            if (p.lights[type] && !isDistant(type))
                clusters_.recordTree(f, p.trees[type]);
}

// The lengths of work lists are statistics as well.
void View::recordTileCounts(const gpu::Frame& f) const noexcept
{
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

void View::recordLists(const gpu::Frame& f, const FramePlan& p) const noexcept
{
    for (uint32_t type = 0; type < CND_LIGHT_TYPE_COUNT; ++type)
        if (p.lights[type] && !isDistant(type))
            clusters_.recordLists(f, type, p.trees[type], p.tileCount, lightsPerBatch(p, type));
    f.barrier();
}

uint32_t View::lightsPerBatch(const FramePlan& p, uint32_t type) const noexcept
{
    return lighting::lightsPerBatch(module_.device, type, p.frame.specularMethod,
                                    p.params.sampleCount);
}

void View::recordClustered(const gpu::Frame& f, const FramePlan& p, uint32_t type) const noexcept
{
    const uint32_t set = f.slot * CND_LIGHT_TYPE_COUNT + type;
    const auto shade = [&](const gpu::LightBatch& batch) {
        byClass(module_.kernels.shade, p.frame, type,
                [&](const ShadeKernels::Tiles& kernels, VkDeviceSize workList) {
                    kernels.shade.dispatchIndirect(f, sets_.shadeTiles.set(set), {batch},
                                                   clusters_.tilesToShade(type), workList);
                });
        f.barrier();
    };
    if (isDistant(type)) { // they light every surface: no lists
        inBatches(allLights(p, type), lightsPerBatch(p, type), shade);
    } else {
        shade(allLights(p, type));
        recordUnlisted(f, p, type);
    }
    if (p.frame.countPairs)
        recordCountPairs(f, p, type);
}

// Clusters whose list found no page; then, where the device limits loops, those of too many lights,
// by parts of the light tree.
void View::recordUnlisted(const gpu::Frame& f, const FramePlan& p, uint32_t type) const noexcept
{
    const ShadeKernels& kernels = module_.kernels.shade;
    const uint32_t set = f.slot * CND_LIGHT_TYPE_COUNT + type;
    gpu::Timer untimed; // the parts are one row
    const gpu::Frame u{f.device, f.cmd, untimed, f.slot, f.hostSet};
    const auto record = [&](const gpu::ShadeUnlistedParams& part) {
        byClass(kernels, p.frame, type,
                [&](const ShadeKernels::Tiles& tiles, VkDeviceSize workList) {
                    tiles.unlisted.dispatchIndirect(u, sets_.shadeUnlisted.set(set), part,
                                                    clusters_.lists(type).unlisted, workList);
                });
        u.barrier();
    };
    record({.listHead = gpu::LIST_UNLISTED,
            .topLevel = gpu::TREE_LEVELS,
            .batch = allLights(p, type),
            .tree = p.trees[type]});
    if (module_.device.maxLoopIterations != UINT32_MAX) {
        // A row of eight pixels may hold four clusters that take turns at walking the tree;
        // besides, finding a light takes about as many iterations as evaluating it.
        const uint32_t largest =
            std::max(lightsPerBatch(p, type) / (2 * gpu::SLICES), gpu::TREE_WIDTH);
        uint32_t level = 1, size = gpu::TREE_WIDTH; // of the nodes that batches consist of
        for (; level < 3 && size * gpu::TREE_WIDTH <= largest; ++level)
            size *= gpu::TREE_WIDTH;
        inBatches(allLights(p, type), largest / size * size, [&](const gpu::LightBatch& batch) {
            record({.listHead = gpu::LIST_LONG,
                    .topLevel = level,
                    .batch = batch,
                    .tree = p.trees[type]});
        });
    }
    f.timer.stamp(f.cmd, kernels.anyVariant().any.unlisted.name());
}

void View::recordCountPairs(const gpu::Frame& f, const FramePlan& p, uint32_t type) const noexcept
{
    const uint32_t set = f.slot * CND_LIGHT_TYPE_COUNT + type;
    const gpu::CountPairsParams params{.batch = allLights(p, type),
                                       .writesImage = p.frame.pairImage != VK_NULL_HANDLE};
    byClass(module_.kernels.shade, p.frame, type,
            [&](const ShadeKernels::Tiles& kernels, VkDeviceSize workList) {
                kernels.countPairs.dispatchIndirect(f, sets_.countPairs.set(set), params,
                                                    clusters_.surfaces(), workList);
            });
    f.barrier();
}

// Every light at every pixel of the frame, or of a rectangle of it.
void View::recordBrute(const gpu::Frame& f, const FramePlan& p, uint32_t type) const noexcept
{
    const ShadeKernels::Variant& kernels =
        module_.kernels.shade.variant(type, p.frame.specularMethod, p.frame.errorBudget > 0);
    gpu::ShadeBruteParams params{.batch = {}, .first = {0, 0}, .end = p.params.size};
    const VkRect2D& r = p.frame.bruteRect;
    if (r.extent.width && r.extent.height) {
        params.first = {r.offset.x, r.offset.y};
        params.end = params.first + glm::uvec2(r.extent.width, r.extent.height);
    }
    const glm::uvec2 pixels = params.end - params.first;
    inBatches(allLights(p, type), lightsPerBatch(p, type), [&](const gpu::LightBatch& batch) {
        params.batch = batch;
        kernels.brute.dispatch(f, sets_.shadeBrute.set(f.slot), params, tilesAlong(pixels.x),
                               tilesAlong(pixels.y));
        f.barrier();
    });
}

} // namespace candelabra::lighting
