// SPDX-License-Identifier: Apache-2.0
#include "view/view.h"

#include <algorithm>
#include <cmath>
#include <cstdio>
#include <cstring>
#include <string>
#include <utility>

#include "candelabra_shaders.h"

namespace candelabra::lighting
{
namespace
{

constexpr VkDeviceSize defaultListBudget = 64u << 20;
constexpr VkDeviceSize defaultShadowBudget = 128u << 20;

constexpr VkBufferUsageFlags storageUse = VK_BUFFER_USAGE_STORAGE_BUFFER_BIT;

// Returns how many bytes the counters of a frame take.
VkDeviceSize counterBytes(const Module& module)
{
    static_assert(sizeof(gpu::LightingCounters) <= gpu::SHADOW_COUNTERS_AT);
    return module.occluders ? gpu::SHADOW_COUNTERS_AT + sizeof(gpu::ShadowCounters)
                            : sizeof(gpu::LightingCounters);
}

uint64_t join(glm::uvec2 lowHigh)
{
    return uint64_t(lowHigh.y) << 32 | lowHigh.x;
}

// Estimates how many more slots would be enough for a frame. It assumes that lists without room for
// their records would take slots as often as the other lists do. capacity: the slots that lists may
// take. In a frame that keeps its lists, c.pairs and c.slots do not count the lists that found no
// room.
uint32_t missingSlots(const gpu::ShadowCounters& c, uint32_t capacity)
{
    if (!c.missingPairs && !c.missingSlots)
        return 0;
    const double made = c.missingPairs
                            ? std::max(double(c.pairs), double(gpu::PAIRS_PER_SLOT) * capacity)
                            : c.pairs;
    const double slots =
        c.missingSlots ? std::max(c.slots, capacity) + double(c.missingSlots) : c.slots;
    const double pairs = made + c.missingPairs;
    const double needed =
        std::max({std::ceil(pairs / gpu::PAIRS_PER_SLOT),
                  std::ceil(slots * pairs / std::max(made, 1.0)), capacity + 1.0});
    return uint32_t(std::min(needed, double(UINT32_MAX))) - c.slots;
}

CndLightingViewDesc checkedDesc(const gpu::Device& device, CndLightingViewDesc desc)
{
    if (desc.structSize != sizeof desc)
        gpu::failArgument("CndLightingViewDesc: structSize is " + std::to_string(desc.structSize) +
                          ", this library expects " + std::to_string(sizeof desc));
    for (const uint32_t side : {desc.maxWidth, desc.maxHeight})
        if (side < 1 || side > gpu::largestSide)
            gpu::failArgument("CndLightingViewDesc: maxWidth and maxHeight must be 1..16384, are " +
                              std::to_string(desc.maxWidth) + " and " +
                              std::to_string(desc.maxHeight));
    const VkDeviceSize range = device.limits.maxStorageBufferRange;
    const VkDeviceSize ofDistant =
        Shadows::distantBytes(tilesAlong(desc.maxWidth) * tilesAlong(desc.maxHeight));
    if (!desc.listBudget)
        desc.listBudget = std::min(defaultListBudget, range);
    if (!desc.shadowBudget)
        desc.shadowBudget = std::min(defaultShadowBudget, range - std::min(ofDistant, range / 2));
    for (const auto& [member, budget] :
         {std::pair("listBudget", desc.listBudget), std::pair("shadowBudget", desc.shadowBudget)})
        if (budget > range)
            gpu::failUnsupported(
                std::string("CndLightingViewDesc: ") + member + " " + std::to_string(budget) +
                " exceeds the device's maxStorageBufferRange " + std::to_string(range));
    return desc;
}

} // namespace

View::View(const Module& module, const CndLightingViewDesc& desc)
    : module_(module),
      desc_(checkedDesc(module.device, desc)),
      timer_(module.device, "lighting", module.desc.framesInFlight, module.desc.timestamps),
      clusters_(module.device, module.kernels.clusters, module.recordings,
                {.slots = module.desc.framesInFlight,
                 .tileClasses = module.kernels.shade.tileClasses(),
                 .maxTiles = {tilesAlong(desc_.maxWidth), tilesAlong(desc_.maxHeight)},
                 .listBudget = desc_.listBudget}),
      uniforms_(module.device, module.desc.framesInFlight),
      overlayUniforms_(module.device, module.desc.framesInFlight),
      counters_(gpu::createBuffer(module.device, "lighting counters", counterBytes(module),
                                  storageUse | VK_BUFFER_USAGE_TRANSFER_SRC_BIT |
                                      VK_BUFFER_USAGE_TRANSFER_DST_BIT,
                                  gpu::MemoryUse::Scratch)),
      slots_(module.recordings, module.device, "lighting statistics", module.desc.framesInFlight,
             counterBytes(module)),
      plans_(module.desc.framesInFlight)
{
    const uint32_t slots = module.desc.framesInFlight;
    const uint32_t perType = slots * CND_LIGHT_TYPE_COUNT;
    const Kernels& k = module.kernels;
    // The kernels of all families and of hosts have the same bindings.
    const auto bindingsOf = [&](const auto& families, uint32_t count) {
        return gpu::Bindings(module.device, *families[0], count);
    };
    sets_ = {.prepareLights = k.prepareLights.createBindings(slots),
             .shadeTiles = module.occluders ? bindingsOf(spirv::shade_tiles_comp_shadows, perType)
                                            : bindingsOf(spirv::shade_tiles_comp, perType),
             .shadeUnlisted = module.occluders
                                  ? bindingsOf(spirv::shade_unlisted_comp_shadows, perType)
                                  : bindingsOf(spirv::shade_unlisted_comp, perType),
             .shadeBrute = module.occluders ? bindingsOf(spirv::shade_brute_comp_shadows, slots)
                                            : bindingsOf(spirv::shade_brute_comp, slots),
             .countPairs = bindingsOf(spirv::count_pairs_comp, perType),
             .surfaceOverlay = k.surfaceOverlay.createBindings(slots)};
    if (!module.gbuffer.depthIsProjected()) {
        sets_.projectDepth = k.projectDepth.createBindings(slots);
        depth_ = gpu::createImage(
            module.device, "projected depth", VK_FORMAT_R32_SFLOAT, desc_.maxWidth, desc_.maxHeight,
            VK_IMAGE_USAGE_STORAGE_BIT | VK_IMAGE_USAGE_SAMPLED_BIT, VK_IMAGE_ASPECT_COLOR_BIT);
    }
    if (module.desc.forwardStages)
        forward_ = ForwardLights(module.device, module.desc.forwardStages,
                                 forwardShadows(module.desc, module.hostKernels), slots);
    if (module.desc.influenceByError)
        influence_.emplace(module.device, k.influence, slots,
                           glm::uvec2(desc_.maxWidth, desc_.maxHeight));
    if (module.occluders) {
        shadows_.emplace(module, clusters_, slots, desc_.shadowBudget,
                         tilesAlong(desc_.maxWidth) * tilesAlong(desc_.maxHeight));
        proofs_.emplace(module, clusters_, *shadows_, slots);
    }
    makeRoom(module.lights.capacity(), module.lights.typeCounts());
}

void View::makeRoom(uint32_t lightCapacity, LightTypeCounts types)
{
    const gpu::Device& device = module_.device;
    const VkDeviceSize lights = lightCapacity, polygons = types[CND_LIGHT_POLYGON];
    lists_ = {}; // the next frame makes new lists, since buffers may be new
    for (uint32_t type = 0; type < CND_LIGHT_TYPE_COUNT; ++type)
        types[type] += module_.desc.lightTypes >> type & 1;
    clusters_.grow(lightCapacity, types);
    const VkDeviceSize coreBytes = lights * gpu::LIGHT_CORE_STRIDE * sizeof(glm::vec4);
    const VkDeviceSize idBytes = (readsLightIds(module_.desc) ? lights : 1) * sizeof(uint32_t);
    makeRoomForShapes(lights, polygons);
    if (coreBytes <= core_.size)
        return;
    gpu::Buffer core = gpu::createBuffer(device, "light core", coreBytes,
                                         storageUse | VK_BUFFER_USAGE_UNIFORM_TEXEL_BUFFER_BIT,
                                         gpu::MemoryUse::Scratch);
    gpu::createTexelView(device, core);
    gpu::Buffer ids =
        gpu::createBuffer(device, "light ids", idBytes, storageUse, gpu::MemoryUse::Device);
    module_.recordings.replace(ids_, std::move(ids));
    module_.recordings.replace(core_, std::move(core));
}

// The shapes of the lights are followed by those of corners. The room for corners grows by half at
// least, so that adding polygons reallocates rarely.
void View::makeRoomForShapes(VkDeviceSize lights, VkDeviceSize polygons)
{
    constexpr VkDeviceSize cornerBytes = gpu::CORNER_SHAPES * sizeof(gpu::LightShape);
    const VkDeviceSize lightBytes = lights * sizeof(gpu::LightShape);
    const VkDeviceSize needed = lightBytes + polygons * cornerBytes;
    if (needed <= shapes_.size)
        return;
    const VkDeviceSize wanted =
        lightBytes + std::max(polygons, polygonRoom_ + polygonRoom_ / 2) * cornerBytes;
    const VkDeviceSize most = module_.device.limits.maxStorageBufferRange;
    gpu::Buffer shapes =
        gpu::createBuffer(module_.device, "light shapes", wanted <= most ? wanted : needed,
                          storageUse, gpu::MemoryUse::Scratch);
    module_.recordings.replace(shapes_, std::move(shapes));
    polygonRoom_ = (shapes_.size - lightBytes) / cornerBytes;
}

// Returns what a frame has counted of shadows. `counted`: all its counters.
gpu::ShadowCounters View::shadowCounters(const gpu::LightingCounters* counted) const noexcept
{
    gpu::ShadowCounters out{};
    if (shadows_)
        std::memcpy(&out, reinterpret_cast<const std::byte*>(counted) + gpu::SHADOW_COUNTERS_AT,
                    sizeof out);
    return out;
}

CndResult View::stats(uint32_t slot, CndLightingStats& out) const noexcept
{
    if (slot >= slots_.count() || !slots_.isUsed(slot) || out.structSize != sizeof out)
        return CND_ERROR_INVALID_ARGUMENT;
    const auto* const counted = slots_.read<gpu::LightingCounters>(slot);
    if (!counted)
        return CND_NOT_READY;
    const gpu::LightingCounters& c = *counted;
    out.lightCount = 0;
    for (uint32_t type = 0; type < CND_LIGHT_TYPE_COUNT; ++type)
        out.lightCount += out.lightTypeCounts[type] = plans_[slot].lights[type];
    out.deviceLights = c.deviceLights;
    out.rejectedLights = c.rejectedLights;
    out.tileCount = surfaceTileCount(c);
    out.diffuseTileCount = c.surfaceTiles[gpu::CLASS_DIFFUSE];
    out.splitTileCount = clusters_.splitTileCount(c.splitTiles);
    out.listEntries = c.listEntries;
    out.maxListLength = c.maxListLength;
    out.unlistedClusters = c.unlistedClusters;
    out.missingListBytes = clusters_.missingBytes(c);
    out.cutBelow = c.cutBelow;
    out.listedPairs = join(c.listedPairs);
    out.evaluatedPairs = join(c.evaluatedPairs);
    out.insidePairs = join(c.insidePairs);
    out.contributingPairs = join(c.contributingPairs);
    const gpu::ShadowCounters shadows = shadowCounters(counted);
    out.askedPairs = join(shadows.asked);
    out.partlyLitPairs = join(shadows.partly);
    out.darkPairs = join(shadows.dark);
    out.shadowSlots = shadows.slots;
    out.missingShadowSlots = shadows_ ? missingSlots(shadows, shadows_->capacity()) : 0;
    out.unfinishedPairs = shadows.unfinished;
    out.litEntries = shadows.kinds[gpu::PAIRS_LIT];
    out.hiddenEntries = shadows.kinds[gpu::PAIRS_DARK];
    out.testedEntries = shadows.kinds[gpu::PAIRS_LISTED];
    out.walkedEntries = shadows.kinds[gpu::PAIRS_WALKED];
    out.triedProofs = shadows.triedProofs;
    out.wonProofs = shadows.wonProofs;
    FramePasses passes = plans_[slot].passes;
    passes.addFindings(c);
    passes.write(out.passes, out.passCount);
    return timer_.read(slot, out.kernelTimes, out.kernelTimeCount);
}

// Names what the lists of clusters found too little of. What shadows need is known if no other list
// is missing.
void View::reportMissing(const CndLightingStats& stats) const noexcept
{
    const gpu::Device& device = module_.device;
    const auto tell = [&](const char* member, VkDeviceSize budget, VkDeviceSize enough) {
        char needed[80] = "";
        if (enough)
            std::snprintf(
                needed, sizeof needed, ", and about %llu would do%s", (unsigned long long)enough,
                enough > device.limits.maxStorageBufferRange ? ", more than maxStorageBufferRange"
                                                             : "");
        char what[80] = "blocks of clusters have no list, or long lists are not shared";
        if (stats.unlistedClusters)
            std::snprintf(what, sizeof what, "%u clusters have no list", stats.unlistedClusters);
        device.say(CND_MESSAGE_WARNING,
                   "cndGetLightingStats: %s, because CndLightingViewDesc::%s, %llu bytes, was "
                   "used up%s: %s",
                   what, member, (unsigned long long)budget, needed,
                   stats.unlistedClusters ? "they walk the light tree, slower"
                                          : "frames take longer");
    };
    if (stats.missingListBytes && !std::exchange(told_.pages, true))
        tell("listBudget", desc_.listBudget, desc_.listBudget + stats.missingListBytes);
    if (stats.missingShadowSlots && !std::exchange(told_.slots, true)) {
        const VkDeviceSize needed = (VkDeviceSize(stats.shadowSlots) + stats.missingShadowSlots) *
                                    gpu::SLOT_WORDS * sizeof(uint32_t);
        tell("shadowBudget", desc_.shadowBudget, stats.missingListBytes ? 0 : needed);
    }
    if (!stats.missingListBytes && !stats.missingShadowSlots && !std::exchange(told_.length, true))
        device.say(CND_MESSAGE_WARNING,
                   "cndGetLightingStats: %u clusters have no list, because it would be too long "
                   "for the device: they walk the light tree, slower",
                   stats.unlistedClusters);
}

void View::reportProblems(const CndLightingStats& stats) const noexcept
{
    const gpu::Device& device = module_.device;
    if (stats.unlistedClusters || stats.missingListBytes)
        reportMissing(stats);
    if (stats.unfinishedPairs && !std::exchange(told_.unfinished, true)) {
        device.say(CND_MESSAGE_WARNING,
                   "cndGetLightingStats: %u pairs of pixel and light have less shadow than they "
                   "should, because the device ends loops after %u iterations",
                   stats.unfinishedPairs, device.maxLoopIterations);
    }
    if (stats.rejectedLights && told_.rejected != module_.lights.number()) {
        told_.rejected = module_.lights.number();
        device.say(CND_MESSAGE_WARNING,
                   "cndGetLightingStats: %u lights of CndDeviceLights give no light, because a "
                   "field is outside its range or they are more than maxCount",
                   stats.rejectedLights);
    }
}

VkDescriptorSet View::forwardSet(uint32_t slot) const
{
    if (!forward_.wanted())
        gpu::failArgument("cndGetForwardSet: CndLightingDesc::forwardStages was 0");
    if (slot >= slots_.count())
        gpu::failArgument("cndGetForwardSet: frameSlot is " + std::to_string(slot) +
                          ", framesInFlight is " + std::to_string(slots_.count()));
    return forward_.set(slot);
}

} // namespace candelabra::lighting
