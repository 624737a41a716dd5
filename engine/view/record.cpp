// SPDX-License-Identifier: Apache-2.0
// Records one frame: View::record has its passes in their order, the functions after it have the
// passes.
#include <algorithm>

#include "shading/brute_rects.h"
#include "shading/light_batches.h"
#include "view/frame_checks.h"
#include "view/view.h"

namespace candelabra::lighting
{
namespace
{

using gpu::divideUp;

// Calls `record` for each tile class, with its kernels. No tile is on two work lists of a buffer,
// so the dispatches for these lists need no barriers between them.
template <typename Record>
void forEachTileClass(const ShadeKernels& kernels, const CndLightingFrame& frame, uint32_t type,
                      Record&& record) noexcept
{
    for (uint32_t tileClass = 0; tileClass < kernels.tileClasses(); ++tileClass)
        record(kernels.tiles(type, frame.specularMethod, tileClass), tileClass);
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

void View::record(VkCommandBuffer cmd, const CndLightingFrame& asked)
{
    const CndLightingFrame frame = checkedFrame(module_, desc_, asked);
    const FramePlan plan = planFrame(module_, frame);
    writeBindings(plan);

    const uint32_t slot = frame.frameSlot;
    const KeptWork kept = keptWork(plan);
    const FramePasses passes(contentOf(plan, kept));
    const uint64_t recording = slots_.begin(slot);
    plans_[slot] = {module_.lights.typeCounts(), passes};
    const gpu::Frame f{module_.device, cmd, timer_, slot, frame.hostSet};
    f.device.beginLabel(cmd, "candelabra lighting");
    timer_.begin(cmd, slot);

    forward_.recordBegin(f, forwardView(plan));
    f.barrier(); // the previous frame uses the same buffers
    module_.lights.recordUpload(f, recording);
    if (module_.occluders)
        module_.occluders->recordUpload(f, recording);
    // Counters of reused lists keep their values: those lists are not made again in this frame.
    const VkDeviceSize firstCounter =
        kept.lists ? offsetof(gpu::LightingCounters, listedPairs) : VkDeviceSize(0);
    f.device.CmdFillBuffer(cmd, counters_.get(), firstCounter,
                           sizeof(gpu::LightingCounters) - firstCounter, 0);
    if (shadows_)
        shadows_->recordBegin(f, plan, counters_, kept);
    f.barrier();
    if (passes.runs(Pass::RefitOccluders))
        module_.occluders->recordRefit(f, recording);
    module_.lights.recordDeviceCounts(f, counters_);
    if (passes.runs(Pass::ShadeTiles) || passes.runs(Pass::ShadeBrute))
        recordPasses(f, plan, passes);
    forward_.recordEnd(f);
    f.barrier();
    slots_.recordEnd(f, counters_);
    f.device.endLabel(cmd);
}

// Tells what this frame can use of the previous frame. Stores what this frame's lists are made for.
KeptWork View::keptWork(const FramePlan& p)
{
    const CndLightingFrame& frame = p.frame;
    ListsKey key;
    if (frame.culling == CND_CULLING_CLUSTERED && module_.lights.count())
        key = {module_.lights.number(),
               frame.specularMethod,
               p.params.sampleCount,
               layersOf(frame.layers),
               influenceOf(frame),
               p.shadows,
               p.occluders ? module_.occluders->number() : 0};
    // Radii by error depend on light from elsewhere in the image too, and each frame measures them
    // at other pixels. So lists that are made with such radii are not kept.
    const bool same = frame.surfacesUnchanged && key.lightSet &&
                      key.rule != CND_INFLUENCE_BY_ERROR && key == lists_;
    lists_ = key;
    return {.lists = same, .slots = same && p.shadows && shadows_->keepsSlots(p)};
}

FrameContent View::contentOf(const FramePlan& p, const KeptWork& kept) const
{
    const CndLightingFrame& frame = p.frame;
    const LightSet& lights = module_.lights;
    FrameContent out{.lights = lights.count() > 0,
                     .inLayers = lights.countsInLayers(layersOf(frame.layers)) != LightTypeCounts{},
                     .lightsChanged = lights.isChanged(),
                     .deviceLights = lights.hasDeviceLights(),
                     .deviceLightsChanged = lights.deviceLightsChanged(),
                     .depthIsProjected = module_.gbuffer.depthIsProjected(),
                     .brute = frame.culling == CND_CULLING_BRUTE,
                     .listsKept = kept.lists,
                     .slotsKept = kept.slots,
                     .readsAlbedoTable = frame.lobes != CND_LOBES_SUM || frame.energyCompensation,
                     .albedoTableFilled = module_.albedoTable.filled(),
                     .cutByError = influenceOf(frame) == CND_INFLUENCE_BY_ERROR,
                     .countPairs = frame.countPairs == VK_TRUE,
                     .forward = forward_.wanted(),
                     .findsShadows = module_.occluders != nullptr,
                     .occludersChanged = module_.occluders && module_.occluders->isChanged(),
                     .refitsOccluders = module_.occluders && module_.occluders->refits(),
                     .occludersInLayers = p.occluders || frame.shadowsOff,
                     .shadowsOff = frame.shadowsOff == VK_TRUE,
                     .hostFindsPoints = module_.hostKernels.findsPoints(),
                     .polygons = lights.typeCounts()[CND_LIGHT_POLYGON] > 0};
    for (uint32_t type = 0; type < CND_LIGHT_TYPE_COUNT; ++type)
        if (p.lights[type])
            (isDistant(type) ? out.distantInView : out.placedInView) = true;
    return out;
}

void View::recordPasses(const gpu::Frame& f, const FramePlan& p, const FramePasses& passes) noexcept
{
    module_.gbuffer.record(f);
    if (passes.runs(Pass::DfgTable))
        module_.albedoTable.recordFill(f);
    if (passes.runs(Pass::PrepareLights))
        module_.kernels.prepareLights.dispatch(
            f, sets_.prepareLights.set(f.slot), p.prepare,
            divideUp(p.prepare.lightCount, gpu::PREPARE_LIGHTS_GROUP));
    if (passes.runs(Pass::PrepareOccluders))
        shadows_->recordPrepare(f, p);
    if (passes.runs(Pass::ProjectDepth))
        recordProjectDepth(f, p);
    if (passes.runs(Pass::TileClusters))
        clusters_.recordReset(f, module_.lights.typeCounts());
    f.barrier();
    if (passes.runs(Pass::PolygonFacets)) {
        shadows_->recordPolygons(f, p);
        f.barrier();
    }
    if (passes.runs(Pass::MeasureInfluence))
        recordInfluence(f, p);
    recordClusters(f, p, passes);
    if (passes.runs(Pass::ClusterLists))
        recordLists(f, p, passes);
    for (uint32_t type = 0; type < CND_LIGHT_TYPE_COUNT; ++type)
        if (p.lights[type]) {
            if (passes.runs(Pass::ShadeTiles))
                recordClustered(f, p, passes, type);
            else
                recordBrute(f, p, type);
        }
}

void View::recordProjectDepth(const gpu::Frame& f, const FramePlan& p) const noexcept
{
    f.layoutBarrier(depth_.image.get(), VK_IMAGE_LAYOUT_GENERAL); // all of it is overwritten
    module_.kernels.projectDepth.dispatch(
        f, sets_.projectDepth.set(f.slot),
        {surfaces::storedDepth(module_.gbuffer.desc(), p.frame.camera, p.frame.clearDepth,
                               p.params.projection)},
        divideUp(p.frame.width, gpu::PROJECT_DEPTH_GROUP),
        divideUp(p.frame.height, gpu::PROJECT_DEPTH_GROUP));
}

// Sets the radii of influence so that the display differs by no more than the frame allows.
void View::recordInfluence(const gpu::Frame& f, const FramePlan& p) noexcept
{
    const gpu::UntimedFrame untimed(f); // the rounds share one row of times
    const gpu::Frame& u = untimed;
    const char* measured = nullptr;
    const uint32_t rounds = influence_->recordBegin(u, p.frame, p.params);
    for (uint32_t round = 0; round < rounds; ++round) {
        influence_->recordRound(u);
        for (uint32_t type = 0; type < CND_LIGHT_TYPE_COUNT; ++type) {
            if (!p.lights[type])
                continue;
            const Influence::MeasureKernel& kernel =
                module_.kernels.shade.variant(type, p.frame.specularMethod).measure;
            measured = kernel.name();
            // Each of the lanes of a sample takes only its share of the lights.
            const uint64_t largest =
                uint64_t(lightsPerBatch(p, type)) * gpu::MEASURE_INFLUENCE_LANES;
            inBatches(allLights(p, type), uint32_t(std::min<uint64_t>(largest, UINT32_MAX)),
                      [&](const gpu::LightBatch& batch) {
                          influence_->recordMeasure(u, kernel, {batch, round, 0});
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

// Copies the lengths of the work lists of tiles into the counters, since they are statistics.
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

void View::recordLists(const gpu::Frame& f, const FramePlan& p,
                       const FramePasses& passes) const noexcept
{
    const gpu::UntimedFrame u(f); // lists of one type may be made at the same time as of another
    const char* const row = module_.kernels.clusters.clusterLists.name();
    const bool proves = passes.runs(Pass::ProveDark);
    const auto forEachType = [&](auto&& record) {
        for (uint32_t type = 0; type < CND_LIGHT_TYPE_COUNT; ++type)
            if (p.lights[type] && !isDistant(type))
                record(type);
    };
    forEachType([&](uint32_t type) {
        clusters_.recordBlockLists(u, type, p.trees[type], p.tileCount, proves);
    });
    if (proves) {
        f.timer.stamp(f.cmd, row);
        f.barrier();
        proofs_->record(f, p);
    }
    f.barrier();
    forEachType([&](uint32_t type) {
        clusters_.recordLists(u, type, p.trees[type], p.tileCount, lightsPerBatch(p, type));
    });
    f.timer.stamp(f.cmd, row);
    f.barrier();
}

uint32_t View::lightsPerBatch(const FramePlan& p, uint32_t type) const noexcept
{
    const uint32_t most = lighting::lightsPerBatch(module_.device, type, p.frame.specularMethod,
                                                   p.params.sampleCount);
    const bool inBatches = isDistant(type) || p.frame.culling == CND_CULLING_BRUTE;
    return p.shadows && inBatches ? std::min(most, shadows_->lightsPerBatch(p.tileCount)) : most;
}

void View::recordClustered(const gpu::Frame& f, const FramePlan& p, const FramePasses& passes,
                           uint32_t type) const noexcept
{
    const ShadeKernels& kernels = module_.kernels.shade;
    const uint32_t set = f.slot * CND_LIGHT_TYPE_COUNT + type;
    const bool asks = passes.runs(Pass::PairVisibility);
    const auto shade = [&](const gpu::LightBatch& batch) {
        const gpu::UntimedFrame u(f);
        forEachTileClass(
            kernels, p.frame, type, [&](const ShadeKernels::Tiles& tiles, uint32_t tileClass) {
                for (uint32_t height = 0; height < tileHeightsOf(module_.device, type); ++height)
                    tiles.shade[height].dispatchIndirect(u, sets_.shadeTiles.set(set), {batch},
                                                         clusters_.tilesToShade(type),
                                                         tileWorkListAt(height, tileClass));
            });
        f.timer.stamp(f.cmd, sets_.shadeTiles.name());
        f.barrier();
    };
    if (isDistant(type)) { // they light every surface: no lists
        inBatches(allLights(p, type), lightsPerBatch(p, type), [&](const gpu::LightBatch& batch) {
            if (asks)
                shadows_->recordBatch(f, type, batch, shadows_->firstSlotOf(p, type, batch), {0, 0},
                                      p.tileCount);
            if (p.shadows && p.frame.countPairs)
                shadows_->recordCounts(f, p, type, batch);
            shade(batch);
        });
    } else {
        if (asks)
            shadows_->recordListed(f, p, type);
        if (p.shadows && p.frame.countPairs)
            shadows_->recordCounts(f, p, type, {});
        shade(allLights(p, type));
        recordUnlisted(f, p, type);
    }
    if (p.frame.countPairs)
        recordCountPairs(f, p, type);
}

// Shades the clusters whose lists found no page. Then, if the device limits loops, shades the
// clusters with more lights than a loop can take, in several dispatches that walk a part of the
// tree each.
void View::recordUnlisted(const gpu::Frame& f, const FramePlan& p, uint32_t type) const noexcept
{
    const ShadeKernels& kernels = module_.kernels.shade;
    const uint32_t set = f.slot * CND_LIGHT_TYPE_COUNT + type;
    const gpu::UntimedFrame untimed(f); // the dispatches share one row of times
    const gpu::Frame& u = untimed;
    const auto record = [&](const gpu::ShadeUnlistedParams& part) {
        forEachTileClass(
            kernels, p.frame, type, [&](const ShadeKernels::Tiles& tiles, uint32_t tileClass) {
                tiles.unlisted.dispatchIndirect(u, sets_.shadeUnlisted.set(set), part,
                                                clusters_.lists(type).unlisted,
                                                tileWorkListAt(gpu::ANY_HEIGHT, tileClass));
            });
        u.barrier();
    };
    const bool limited = module_.device.maxLoopIterations != UINT32_MAX;
    if (!limited || !p.shadows)
        record({.listHead = gpu::LIST_UNLISTED,
                .topLevel = gpu::TREE_LEVELS,
                .batch = allLights(p, type),
                .tree = p.trees[type]});
    if (limited) {
        // Eight pixels of a row may belong to four clusters, whose walks run one after the other if
        // the device runs these pixels together. Finding a light also takes about as many loop
        // iterations as evaluating it.
        const uint32_t evaluated =
            std::max(lightsPerBatch(p, type) / (2 * gpu::SLICES), gpu::TREE_WIDTH);
        const uint32_t largest = p.shadows ? std::min(evaluated, walkedLightsPerBatch) : evaluated;
        // Batches consist of whole nodes of this level, which hold this many lights.
        uint32_t level = 1, size = gpu::TREE_WIDTH;
        for (; level < 3 && size * gpu::TREE_WIDTH <= largest; ++level)
            size *= gpu::TREE_WIDTH;
        inBatches(allLights(p, type), largest / size * size, [&](const gpu::LightBatch& batch) {
            for (const uint32_t head : {gpu::LIST_LONG, gpu::LIST_UNLISTED})
                if (head == gpu::LIST_LONG || p.shadows)
                    record({.listHead = head,
                            .topLevel = level,
                            .batch = batch,
                            .tree = p.trees[type]});
        });
    }
    f.timer.stamp(f.cmd, sets_.shadeUnlisted.name());
}

void View::recordCountPairs(const gpu::Frame& f, const FramePlan& p, uint32_t type) const noexcept
{
    const uint32_t set = f.slot * CND_LIGHT_TYPE_COUNT + type;
    const gpu::CountPairsParams params{.batch = allLights(p, type),
                                       .writesImage = p.frame.pairImage != VK_NULL_HANDLE};
    const gpu::UntimedFrame u(f);
    forEachTileClass(module_.kernels.shade, p.frame, type,
                     [&](const ShadeKernels::Tiles& kernels, uint32_t tileClass) {
                         kernels.countPairs.dispatchIndirect(
                             u, sets_.countPairs.set(set), params, clusters_.surfaces(),
                             tileWorkListAt(gpu::ANY_HEIGHT, tileClass));
                     });
    f.timer.stamp(f.cmd, sets_.countPairs.name());
    f.barrier();
}

// Shades every pixel of the frame, or of bruteRect, by every light of the type. Dispatches for
// different pixels need no barrier between them, and their sizes change no sum.
void View::recordBrute(const gpu::Frame& f, const FramePlan& p, uint32_t type) const noexcept
{
    const ShadeKernels::Variant& kernels =
        module_.kernels.shade.variant(type, p.frame.specularMethod);
    glm::uvec2 first(0), end = p.params.size;
    const VkRect2D& r = p.frame.bruteRect;
    if (r.extent.width && r.extent.height) {
        first = {r.offset.x, r.offset.y};
        end = first + glm::uvec2(r.extent.width, r.extent.height);
    }
    inBatches(allLights(p, type), lightsPerBatch(p, type), [&](const gpu::LightBatch& batch) {
        const gpu::UntimedFrame untimed(f);
        const gpu::Frame& u = untimed;
        inBruteRects(
            first, end, batch.count, brutePairsPerDispatch, [&](glm::uvec2 from, glm::uvec2 to) {
                const glm::uvec2 tiles(tilesAlong(to.x - from.x), tilesAlong(to.y - from.y));
                if (p.shadows) {
                    u.barrier(); // the rectangle before this one has the same slots
                    shadows_->recordBatch(u, type, batch, 0, from, tiles);
                }
                kernels.brute.dispatch(u, sets_.shadeBrute.set(f.slot), {batch, from, to}, tiles.x,
                                       tiles.y);
            });
        f.timer.stamp(f.cmd, kernels.brute.name());
        f.barrier();
    });
}

} // namespace candelabra::lighting
