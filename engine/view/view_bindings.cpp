// SPDX-License-Identifier: Apache-2.0
// Buffers of a light each, and what each kernel of a frame reads and writes.
#include <string>

#include "lighting/lighting.h"

namespace candelabra::lighting
{

void View::makeRoom(const LightTypeCounts& types)
{
    constexpr VkBufferUsageFlags storage = VK_BUFFER_USAGE_STORAGE_BUFFER_BIT;
    const gpu::Device& device = lighting_.device();
    const VkDeviceSize lights = lighting_.lightCapacity();
    clusters_.grow(uint32_t(lights), lighting_.withReserved(types));
    const VkDeviceSize coreBytes = lights * gpu::LIGHT_CORE_STRIDE * sizeof(glm::vec4);
    const VkDeviceSize auxBytes = lights * gpu::LIGHT_AUX_STRIDE * sizeof(glm::vec4);
    const VkDeviceSize idBytes = (lighting_.readsIds() ? lights : 1) * sizeof(uint32_t);
    if (coreBytes <= core_.size && auxBytes <= aux_.size)
        return;
    gpu::Buffer core = gpu::createBuffer(device, "light core", coreBytes,
                                         storage | VK_BUFFER_USAGE_UNIFORM_TEXEL_BUFFER_BIT,
                                         gpu::MemoryUse::Scratch);
    gpu::createTexelView(device, core);
    gpu::Buffer aux =
        gpu::createBuffer(device, "light aux", auxBytes, storage, gpu::MemoryUse::Scratch);
    gpu::Buffer ids =
        gpu::createBuffer(device, "light ids", idBytes, storage, gpu::MemoryUse::Device);
    lighting_.replace(ids_, std::move(ids));
    lighting_.replace(core_, std::move(core));
    lighting_.replace(aux_, std::move(aux));
}

void View::writeBindings(const CndLightingFrame& frame) const
{
    using namespace gpu;
    const uint32_t slot = frame.frameSlot;
    gbufferParams_.write(slot, lighting_.gbuffer(), frame.camera);
    const GBufferViews images = lighting_.gbuffer().views(frame, gbufferParams_);
    const Binding normals = Binding::sampled(SHADE_NORMAL_ROUGHNESS, images.packedNormal);
    const Binding hostNormals = Binding::sampled(SHADE_HOST_NORMAL, images.hostNormal);
    const Binding albedo = Binding::sampled(SHADE_ALBEDO, images.albedo);
    const Binding f0 = Binding::sampled(SHADE_SPECULAR, images.specular);
    const Binding depth = Binding::sampled(SHADE_DEPTH, images.depth);
    const Binding gbufferView = images.params(SHADE_GBUFFER_VIEW);
    sets_.prepareLights.write(slot, {Binding::of(PREPARE_LIGHTS_RECORDS, lighting_.records()),
                                     Binding::of(PREPARE_LIGHTS_CORE, core_),
                                     Binding::of(PREPARE_LIGHTS_AUX, aux_),
                                     Binding::of(PREPARE_LIGHTS_ORDER, lighting_.lightOrder()),
                                     Binding::of(PREPARE_LIGHTS_IDS, ids_)});
    const LightTypeCounts& types = lighting_.typeCounts();
    clusters_.writeBindings(slot, types, {.gbuffer = images, .core = core_, .counters = counters_});
    if (forward_.wanted())
        forward_.write(slot, {.core = core_,
                              .aux = aux_,
                              .nodes = clusters_.nodes(),
                              .ids = ids_,
                              .directionalAlbedo = lighting_.directionalAlbedo(),
                              .transformedCosines = lighting_.transformedCosines()});
    if (lighting_.desc().influenceByError)
        influence_.writeBindings(slot, lighting_,
                                 {.gbuffer = images,
                                  .radiance = frame.radiance,
                                  .core = core_,
                                  .aux = aux_,
                                  .ids = ids_,
                                  .counters = counters_});
    const Binding ids = Binding::of(SHADE_LIGHT_IDS, ids_);
    if (frame.culling == CND_CULLING_BRUTE) {
        sets_.shadeBrute.write(
            slot, {Binding::ofTexels(SHADE_CORE, core_), Binding::of(SHADE_CORE_WORDS, core_),
                   Binding::of(SHADE_AUX, aux_), ids, normals, hostNormals, albedo, f0, depth,
                   gbufferView, Binding::storage(SHADE_RADIANCE, frame.radiance),
                   Binding::ofTexels(SHADE_DFG, lighting_.directionalAlbedo()),
                   Binding::ofTexels(SHADE_LTC, lighting_.transformedCosines())});
        return;
    }
    for (uint32_t type = 0; type < CND_LIGHT_TYPE_COUNT; ++type) {
        if (!types[type])
            continue;
        const uint32_t set = slot * CND_LIGHT_TYPE_COUNT + type;
        const Clusters::Lists& lists = clusters_.lists(type);
        const Binding core = Binding::ofTexels(SHADE_CORE, core_);
        const Binding coreWords = Binding::of(SHADE_CORE_WORDS, core_);
        const Binding aux = Binding::of(SHADE_AUX, aux_);
        const Binding radiance = Binding::storage(SHADE_RADIANCE, frame.radiance);
        const Binding dfg = Binding::ofTexels(SHADE_DFG, lighting_.directionalAlbedo());
        const Binding ltc = Binding::ofTexels(SHADE_LTC, lighting_.transformedCosines());
        const Binding tiles = Binding::of(SHADE_TILES, clusters_.tiles());
        const Binding heads = Binding::of(SHADE_LISTS, lists.heads);
        const Binding entries = Binding::of(SHADE_ENTRIES, clusters_.entries());
        const Binding surfaces = Binding::of(SHADE_WORK, clusters_.surfaces());
        const Binding toShade = Binding::of(SHADE_WORK, clusters_.tilesToShade(type));
        const Binding unlisted = Binding::of(SHADE_WORK, lists.unlisted);
        sets_.shadeTiles.write(set,
                               {core, coreWords, aux, ids, normals, hostNormals, albedo, f0, depth,
                                gbufferView, radiance, dfg, ltc, tiles, heads, entries, toShade});
        sets_.shadeUnlisted.write(set, {core, coreWords, aux, ids, normals, hostNormals, albedo, f0,
                                        depth, gbufferView, radiance, dfg, ltc, tiles, heads,
                                        unlisted, Binding::of(SHADE_CLUSTERS, clusters_.clusters()),
                                        Binding::ofTexels(SHADE_NODES, clusters_.nodes()),
                                        Binding::of(SHADE_NODE_WORDS, clusters_.nodes())});
        sets_.countPairs.write(
            set,
            {core, coreWords, aux, ids, normals, hostNormals, albedo, f0, depth, gbufferView, dfg,
             ltc, tiles, heads, entries, surfaces, Binding::of(SHADE_COUNTERS, counters_),
             // Without one it is not written.
             Binding::storage(SHADE_PAIRS, frame.pairImage ? frame.pairImage : frame.radiance)});
    }
}

VkDescriptorSet View::forwardSet(uint32_t slot) const
{
    if (!forward_.wanted())
        gpu::failArgument("cndGetForwardSet: CndLightingDesc::forwardStages was 0");
    if (slot >= slots_.size())
        gpu::failArgument("cndGetForwardSet: frameSlot is " + std::to_string(slot) +
                          ", framesInFlight is " + std::to_string(slots_.size()));
    return forward_.set(slot);
}

} // namespace candelabra::lighting
