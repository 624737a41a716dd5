// SPDX-License-Identifier: Apache-2.0
#include "view/shadows.h"

#include <algorithm>
#include <cstring>
#include <string>

#include <glm/mat3x3.hpp>
#include <glm/mat4x4.hpp>
#include <glm/matrix.hpp>

#include "candelabra_shaders.h"
#include "shading/light_batches.h"
#include "tables/point_table.h"

namespace candelabra::lighting
{

using gpu::Binding;

namespace
{

constexpr VkDeviceSize slotBytes = gpu::SLOT_WORDS * sizeof(uint32_t);
constexpr VkBufferUsageFlags storage = VK_BUFFER_USAGE_STORAGE_BUFFER_BIT;

// Returns the step of a depth format of integers, or 0 for floats. A host's own kinds of depth are
// floats.
float depthStep(const CndGBufferDesc& desc)
{
    switch (desc.depthFormat) {
    case VK_FORMAT_X8_D24_UNORM_PACK32:
    case VK_FORMAT_D24_UNORM_S8_UINT:
        return 1.0f / float((1 << 24) - 1);
    default:
        return 0;
    }
}

gpu::ShadowView shadowView(const Module& module, const FramePlan& plan)
{
    glm::dmat4 view;
    std::memcpy(&view, plan.frame.camera.viewFromWorld, sizeof view);
    const glm::dmat3 rotation(view);
    const glm::dvec3 eye = glm::transpose(rotation) * -glm::dvec3(view[3]);
    return {.viewFromTree = glm::mat3(rotation),
            .viewInTree = glm::vec3(eye - module.occluders->instances().origin()),
            .layers = plan.occluders ? layersOf(plan.frame.layers) : 0,
            .firstNode = module.occluders->meshes().firstInstanceNode(),
            .depthStep = depthStep(module.gbuffer.desc()),
            .points = module.desc.shadows.points,
            .walkTurns = walkTurns(module.device),
            .asks = plan.shadows};
}

gpu::Buffer createScratch(const Module& module, const char* what, VkDeviceSize bytes,
                          VkBufferUsageFlags more = 0)
{
    return gpu::createBuffer(module.device, what, bytes, storage | more, gpu::MemoryUse::Scratch);
}

// Returns the number of slots of a view with so many tiles: those of lists and, if the device
// allows it, those of a distant light. There are at least as many as tiles, since lights of a batch
// take one at each.
VkDeviceSize slotCount(const gpu::Device& device, VkDeviceSize budget, uint32_t maxTiles)
{
    const VkDeviceSize most = device.limits.maxStorageBufferRange;
    const VkDeviceSize ofTiles = Shadows::distantBytes(maxTiles);
    if (ofTiles > most)
        gpu::failUnsupported("CndLightingViewDesc: shadows of maxWidth x maxHeight pixels need a "
                             "buffer of " +
                             std::to_string(ofTiles) +
                             " bytes, more than the device's maxStorageBufferRange, " +
                             std::to_string(most));
    return std::min(budget / slotBytes + maxTiles, most / slotBytes);
}

} // namespace

VkDeviceSize Shadows::distantBytes(uint32_t tiles)
{
    return tiles * slotBytes;
}

Shadows::Shadows(const Module& module, const Clusters& clusters, uint32_t slots,
                 VkDeviceSize budget, uint32_t maxTiles)
    : module_(module),
      clusters_(clusters),
      prepared_(module.device, module.recordings, module.kernels.prepareOccluders, slots),
      capacity_(uint32_t(budget / slotBytes)),
      slots_(createScratch(module, "visibility slots",
                           slotCount(module.device, budget, maxTiles) * slotBytes)),
      asked_(createScratch(module, "asked pairs",
                           sizeof(gpu::AskedPairs) +
                               VkDeviceSize(capacity_) * gpu::ASKED_WORDS * sizeof(uint32_t),
                           VK_BUFFER_USAGE_INDIRECT_BUFFER_BIT | VK_BUFFER_USAGE_TRANSFER_SRC_BIT |
                               VK_BUFFER_USAGE_TRANSFER_DST_BIT)),
      bounds_(createScratch(module, "bounds of samples",
                            clusters.firstOfBlocks() * sizeof(gpu::SampleBounds))),
      pagePairs_(
          createScratch(module, "pairs of pages", clusters.entries().size / gpu::PAGE_WORDS)),
      points_(gpu::createBuffer(module.device, "visibility points",
                                tables::pointTable(module.desc.shadows.points).size() *
                                    sizeof(glm::uvec2),
                                VK_BUFFER_USAGE_UNIFORM_TEXEL_BUFFER_BIT, gpu::MemoryUse::Upload)),
      views_(gpu::createBuffer(module.device, "shadow parameters", slots * viewStride,
                               VK_BUFFER_USAGE_UNIFORM_BUFFER_BIT, gpu::MemoryUse::Upload)),
      askSets_(module.kernels.askPairs.createBindings(slots * CND_LIGHT_TYPE_COUNT)),
      visibilitySets_(module.device, spirv::pair_visibility_comp_sphere,
                      slots * CND_LIGHT_TYPE_COUNT),
      countSets_(module.kernels.countShadows[0].createBindings(slots * CND_LIGHT_TYPE_COUNT)),
      listSets_(module.kernels.listOccluders.createBindings(slots * CND_LIGHT_TYPE_COUNT)),
      polygonSets_(module.kernels.polygonFacets.createBindings(slots))
{
    static_assert(sizeof(gpu::ShadowView) <= viewStride);
    gpu::createTexelView(module.device, points_, VK_FORMAT_R32G32_UINT, sizeof(glm::uvec2));
    std::ranges::copy(tables::pointTable(module.desc.shadows.points),
                      points_.as<glm::uvec2>().begin());
    prepared_.makeRoom(
        std::max(module.desc.shadows.instanceCapacity, module.occluders->instances().places()));
}

Binding Shadows::view(uint32_t slot) const
{
    return {.binding = gpu::SHADOW_VIEW,
            .buffer = views_.get(),
            .offset = slot * viewStride,
            .range = sizeof(gpu::ShadowView)};
}

// Before there are occluders, a buffer that no walk reads stands for theirs.
std::array<Binding, 5> Shadows::occluderBindings(uint32_t slot) const
{
    const OccluderSet& occluders = *module_.occluders;
    const auto bind = [&](uint32_t binding, const gpu::Buffer& buffer) {
        return Binding::of(binding, buffer.get() ? buffer : pagePairs_);
    };
    return {bind(gpu::SHADOW_INSTANCES, prepared_.buffer()),
            bind(gpu::SHADOW_NODES, occluders.meshes().nodes()),
            bind(gpu::SHADOW_TRIANGLES, occluders.meshes().triangles()),
            Binding::ofTexels(gpu::SHADOW_POINTS, points_), view(slot)};
}

std::array<Binding, 3> Shadows::slotBindings() const
{
    return {slots(), Binding::of(gpu::SHADOW_PAGE_PAIRS, pagePairs_),
            Binding::of(gpu::SHADOW_ASKED, asked_)};
}

std::array<Binding, 3> Shadows::occluderTexels() const
{
    const OccluderSet& occluders = *module_.occluders;
    const auto bind = [&](uint32_t binding, const gpu::Buffer& buffer) {
        return Binding::ofTexels(binding, buffer.get() ? buffer : module_.albedoTable.buffer());
    };
    return {bind(gpu::SHADOW_INSTANCE_TEXELS, prepared_.buffer()),
            bind(gpu::SHADOW_NODE_TEXELS, occluders.meshes().nodes()),
            bind(gpu::SHADOW_TRIANGLE_TEXELS, occluders.meshes().triangles())};
}

Binding Shadows::counters(const gpu::Buffer& counters, uint32_t binding)
{
    Binding out = Binding::of(binding, counters);
    out.offset = gpu::SHADOW_COUNTERS_AT;
    return out;
}

void Shadows::writeBindings(const FramePlan& plan, const Inputs& in) const
{
    using namespace gpu;
    const CndLightingFrame& frame = plan.frame;
    const uint32_t slot = frame.frameSlot;
    const LightSet& lights = module_.lights;
    polygonSets_.write(slot, {Binding::of(POLYGON_FACETS_RECORDS, lights.records()),
                              Binding::of(POLYGON_FACETS_ORDER, lights.order()),
                              Binding::of(POLYGON_FACETS_SHAPES, in.shapes),
                              Binding::ofTexels(SHADOW_POINTS, points_)});
    BindingList occluders;
    occluders.add(occluderBindings(slot));
    occluders.add(occluderTexels());
    BindingList surfaces = occluders;
    surfaces.add(in.gbuffer.bindings());
    const Binding shadowCounters = counters(in.counters);
    for (uint32_t type = 0; type < CND_LIGHT_TYPE_COUNT; ++type) {
        if (!lights.typeCounts()[type])
            continue;
        const uint32_t set = slot * CND_LIGHT_TYPE_COUNT + type;
        const Clusters::Lists& lists = clusters_.lists(type);
        if (!isDistant(type))
            writeListBindings(slot, type, in, occluders);
        visibilitySets_.write(
            set,
            {Binding::ofTexels(LIGHT_CORE_TEXELS, in.core), Binding::of(LIGHT_CORE, in.core),
             Binding::of(SHADE_SHAPES, in.shapes), Binding::of(SHADE_LIGHT_IDS, in.ids),
             Binding::sampled(SHADE_DEPTH, in.gbuffer.depth), in.uniforms.at(slot),
             Binding::ofTexels(SHADE_DFG, in.albedoTable),
             Binding::of(SHADE_TILES, clusters_.tiles()), Binding::of(VISIBILITY_ASKED, asked_),
             shadowCounters, this->slots()},
            surfaces);
        countSets_.write(
            set,
            {Binding::sampled(SHADE_DEPTH, in.gbuffer.depth), in.uniforms.at(slot),
             Binding::of(SHADE_TILES, clusters_.tiles()), Binding::of(SHADE_LISTS, lists.heads),
             Binding::of(SHADE_ENTRIES, clusters_.entries()),
             Binding::of(SHADE_WORK, clusters_.surfaces()), shadowCounters,
             // Every binding needs an image, even if none is written.
             Binding::storage(SHADE_PAIRS, frame.shadowImage ? frame.shadowImage : frame.radiance)},
            slotBindings());
    }
}

// Writes the bindings of the kernels that find the triangles between clusters and the lights of
// their lists.
void Shadows::writeListBindings(uint32_t slot, uint32_t type, const Inputs& in,
                                const gpu::BindingList& occluders) const
{
    using namespace gpu;
    const uint32_t set = slot * CND_LIGHT_TYPE_COUNT + type;
    const Clusters::Lists& lists = clusters_.lists(type);
    const gpu::Buffer& neighbours = module_.occluders->meshes().neighbours();
    askSets_.write(set,
                   {Binding::of(ASK_PAIRS_CLUSTERS, clusters_.clusters()),
                    Binding::of(ASK_PAIRS_TILES, clusters_.tiles()),
                    Binding::of(ASK_PAIRS_SPLITS, clusters_.splits()),
                    Binding::of(ASK_PAIRS_LISTS, lists.heads),
                    Binding::of(ASK_PAIRS_ENTRIES, clusters_.entries()),
                    Binding::of(ASK_PAIRS_UNLISTED, lists.unlisted),
                    Binding::of(ASK_PAIRS_COUNTERS, in.counters),
                    counters(in.counters, ASK_PAIRS_SHADOW_COUNTERS),
                    Binding::of(ASK_PAIRS_ASKED, asked_), Binding::of(ASK_PAIRS_BOUNDS, bounds_),
                    Binding::sampled(ASK_PAIRS_DEPTH, in.gbuffer.depth),
                    Binding::of(SHADOW_PAGE_PAIRS, pagePairs_), in.uniforms.at(slot), view(slot)});
    listSets_.write(
        set,
        {Binding::of(SHADE_SHAPES, in.shapes), Binding::of(LIST_OCCLUDERS_ASKED, asked_),
         Binding::of(LIST_OCCLUDERS_BOUNDS, bounds_),
         // Before there are occluders, a buffer that nothing reads stands for theirs.
         Binding::of(LIST_OCCLUDERS_NEIGHBOURS, neighbours.get() ? neighbours : pagePairs_),
         Binding::of(LIST_OCCLUDERS_UNLISTED, lists.unlisted),
         Binding::of(LIST_OCCLUDERS_COUNTERS, in.counters),
         Binding::of(SHADE_TILES, clusters_.tiles()), Binding::of(SHADE_LISTS, lists.heads),
         Binding::ofTexels(LIGHT_CORE_TEXELS, in.core), Binding::of(LIGHT_CORE, in.core),
         counters(in.counters)},
        occluders);
}

bool Shadows::keepsSlots(const FramePlan& p) const noexcept
{
    VkDeviceSize lights = 0;
    for (uint32_t type = 0; type < CND_LIGHT_TYPE_COUNT; ++type)
        lights += isDistant(type) ? p.lights[type] : 0;
    return !module_.hostKernels.findsPoints() &&
           lights * p.tileCount.x * p.tileCount.y <= slots_.size / slotBytes - capacity_;
}

uint32_t Shadows::firstSlotOf(const FramePlan& p, uint32_t type,
                              const gpu::LightBatch& batch) const noexcept
{
    if (!keepsSlots(p))
        return 0;
    uint32_t before = batch.first - p.trees[type].firstLight;
    for (uint32_t other = 0; other < type; ++other)
        before += isDistant(other) ? p.lights[other] : 0;
    return capacity_ + before * p.tileCount.x * p.tileCount.y;
}

void Shadows::recordBegin(const gpu::Frame& f, const FramePlan& p, const gpu::Buffer& counters,
                          const KeptWork& kept) const noexcept
{
    gpu::ShadowView parameters = shadowView(module_, p);
    for (uint32_t type = 0; type < CND_LIGHT_TYPE_COUNT; ++type)
        parameters.distantSlots[type] = firstSlotOf(p, type, {0, 0});
    parameters.distantStride = keepsSlots(p) ? p.tileCount.x * p.tileCount.y : 0;
    std::memcpy(views_.mapped + f.slot * viewStride, &parameters, sizeof parameters);
    const VkDeviceSize first = kept.slots   ? offsetof(gpu::ShadowCounters, unfinished)
                               : kept.lists ? offsetof(gpu::ShadowCounters, pairs)
                                            : 0;
    f.device.CmdFillBuffer(f.cmd, counters.get(), gpu::SHADOW_COUNTERS_AT + first,
                           sizeof(gpu::ShadowCounters) - first, 0);
    f.device.CmdFillBuffer(f.cmd, asked_.get(), offsetof(gpu::AskedPairs, written),
                           sizeof(gpu::AskedPairs) - offsetof(gpu::AskedPairs, written), 0);
}

void Shadows::recordPrepare(const gpu::Frame& f, const FramePlan& p) const noexcept
{
    prepared_.record(f, module_.occluders->instances(), p.frame.camera.viewFromWorld);
}

void Shadows::recordPolygons(const gpu::Frame& f, const FramePlan& p) const noexcept
{
    const uint32_t count = module_.lights.typeCounts()[CND_LIGHT_POLYGON];
    module_.kernels.polygonFacets.dispatch(f, polygonSets_.set(f.slot),
                                           {.firstPolygon = p.prepare.firstPolygon, .count = count},
                                           gpu::divideUp(count, gpu::POLYGON_FACETS_GROUP));
}

void Shadows::recordListed(const gpu::Frame& f, const FramePlan& p, uint32_t type) const noexcept
{
    gpu::AskedPairs none{.groups = {gpu::ASK_ROW / gpu::LIST_OCCLUDERS_GROUP, 0, 1}};
    for (gpu::WorkList& kind : none.kinds)
        kind = {.groupsX = gpu::ASK_ROW, .groupsZ = 1};
    const VkBufferCopy end{.srcOffset = offsetof(gpu::AskedPairs, written),
                           .dstOffset = offsetof(gpu::AskedPairs, first),
                           .size = sizeof none.first};
    f.device.CmdUpdateBuffer(f.cmd, asked_.get(), 0, offsetof(gpu::AskedPairs, first), &none);
    f.device.CmdCopyBuffer(f.cmd, asked_.get(), asked_.get(), 1, &end);
    f.barrier();
    const uint32_t tiles = p.tileCount.x * p.tileCount.y;
    module_.kernels.askPairs.dispatchInRows(f, askSets_.set(setOf(f, type)),
                                            {.tileCount = tiles,
                                             .firstSplit = clusters_.firstSplit(),
                                             .splitCapacity = clusters_.splitCapacity(),
                                             .capacity = capacity_,
                                             .lightType = type},
                                            tiles);
    f.barrier();
    module_.kernels.listOccluders.dispatchIndirect(
        f, listSets_.set(setOf(f, type)),
        {.capacity = capacity_,
         .lightType = type,
         .fromHost = module_.kernels.shade.pairKinds(type) == 1},
        asked_, offsetof(gpu::AskedPairs, groups));
    f.barrier();
    const gpu::UntimedFrame untimed(f); // the kinds are found at the same time
    for (uint32_t kind = 0; kind < module_.kernels.shade.pairKinds(type); ++kind)
        module_.kernels.shade.visibility(type, kind)
            .dispatchIndirect(untimed, visibilitySets_.set(setOf(f, type)), {.capacity = capacity_},
                              asked_,
                              offsetof(gpu::AskedPairs, kinds) + kind * sizeof(gpu::WorkList));
    f.timer.stamp(f.cmd, visibilitySets_.name());
    f.barrier();
}

uint32_t Shadows::lightsPerBatch(glm::uvec2 tileCount) const noexcept
{
    return std::clamp(capacity_ / (tileCount.x * tileCount.y), 1u,
                      module_.device.limits.maxComputeWorkGroupCount[2]);
}

void Shadows::recordBatch(const gpu::Frame& f, uint32_t type, const gpu::LightBatch& batch,
                          uint32_t firstSlot, glm::uvec2 firstPixel,
                          glm::uvec2 tileCount) const noexcept
{
    module_.kernels.shade.visibility(type, gpu::PAIRS_WALKED)
        .dispatch(f, visibilitySets_.set(setOf(f, type)),
                  {.batch = batch,
                   .first = firstPixel,
                   .tileCountX = tileCount.x,
                   .firstSlot = firstSlot,
                   .capacity = capacity_},
                  tileCount.x, tileCount.y, batch.count);
    f.barrier();
}

void Shadows::recordCounts(const gpu::Frame& f, const FramePlan& p, uint32_t type,
                           const gpu::LightBatch& batch) const noexcept
{
    for (uint32_t tileClass = 0; tileClass < module_.kernels.shade.tileClasses(); ++tileClass)
        module_.kernels.countShadows[tileClass].dispatchIndirect(
            f, countSets_.set(setOf(f, type)),
            {.batch = batch,
             .firstSlot = isDistant(type) ? firstSlotOf(p, type, batch) : 0,
             .isDistant = isDistant(type),
             .writesImage = p.frame.shadowImage != VK_NULL_HANDLE},
            clusters_.surfaces(), tileWorkListAt(gpu::ANY_HEIGHT, tileClass));
    f.barrier();
}

} // namespace candelabra::lighting
