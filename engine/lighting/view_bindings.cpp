// SPDX-License-Identifier: Apache-2.0
// What each kernel of a frame reads and writes.
#include "lighting/lighting.h"

namespace candelabra::lighting
{

void View::writeBindings(const CndLightingFrame& frame) const
{
    using namespace gpu;
    const uint32_t slot = frame.frameSlot;
    const VkImageView specular = frame.specular ? frame.specular : frame.albedo;
    sets_.prepareLights.write(slot, {Binding::of(PREPARE_LIGHTS_RECORDS, lighting_.records()),
                                     Binding::of(PREPARE_LIGHTS_CORE, core_),
                                     Binding::of(PREPARE_LIGHTS_AUX, aux_)});
    if (frame.culling == CND_CULLING_BRUTE) {
        sets_.shadeBrute.write(slot,
                               {Binding::ofTexels(SHADE_CORE, core_),
                                Binding::of(SHADE_CORE_WORDS, core_), Binding::of(SHADE_AUX, aux_),
                                Binding::sampled(SHADE_NORMAL_ROUGHNESS, frame.normalRoughness),
                                Binding::sampled(SHADE_ALBEDO, frame.albedo),
                                Binding::sampled(SHADE_SPECULAR, specular),
                                Binding::sampled(SHADE_DEPTH, frame.depth),
                                Binding::storage(SHADE_RADIANCE, frame.radiance),
                                Binding::ofTexels(SHADE_DFG, lighting_.directionalAlbedo()),
                                Binding::ofTexels(SHADE_LTC, lighting_.transformedCosines())});
        return;
    }
    sets_.tileBounds.write(slot, {Binding::sampled(TILE_BOUNDS_DEPTH, frame.depth),
                                  Binding::of(TILE_BOUNDS_BOUNDS, tileBounds_),
                                  Binding::of(TILE_BOUNDS_COUNTERS, counters_)});
    sets_.coarseBounds.write(slot, {Binding::of(COARSE_BOUNDS_TILES, tileBounds_),
                                    Binding::of(COARSE_BOUNDS_COARSE, coarseBounds_)});
    sets_.coarseMasks.write(slot, {Binding::ofTexels(COARSE_MASKS_CORE, core_),
                                   Binding::of(COARSE_MASKS_CORE_WORDS, core_),
                                   Binding::of(COARSE_MASKS_BOUNDS, coarseBounds_),
                                   Binding::of(COARSE_MASKS_MASKS, masks_)});
    sets_.tileLists.write(
        slot, {Binding::ofTexels(TILE_LISTS_CORE, core_), Binding::of(TILE_LISTS_CORE_WORDS, core_),
               Binding::of(TILE_LISTS_BOUNDS, tileBounds_), Binding::of(TILE_LISTS_MASKS, masks_),
               Binding::of(TILE_LISTS_LISTS, lists_), Binding::of(TILE_LISTS_ENTRIES, entries_),
               Binding::of(TILE_LISTS_COUNTERS, counters_)});
    const auto writeShade = [&](const Bindings& set) {
        set.write(slot, {Binding::ofTexels(SHADE_CORE, core_), Binding::of(SHADE_CORE_WORDS, core_),
                         Binding::of(SHADE_AUX, aux_),
                         Binding::sampled(SHADE_NORMAL_ROUGHNESS, frame.normalRoughness),
                         Binding::sampled(SHADE_ALBEDO, frame.albedo),
                         Binding::sampled(SHADE_SPECULAR, specular),
                         Binding::sampled(SHADE_DEPTH, frame.depth),
                         Binding::storage(SHADE_RADIANCE, frame.radiance),
                         Binding::of(SHADE_LISTS, lists_), Binding::of(SHADE_ENTRIES, entries_),
                         Binding::ofTexels(SHADE_DFG, lighting_.directionalAlbedo()),
                         Binding::ofTexels(SHADE_LTC, lighting_.transformedCosines())});
    };
    writeShade(sets_.shadeTiles);
    sets_.countPairs.write(
        slot,
        {Binding::ofTexels(SHADE_CORE, core_), Binding::of(SHADE_CORE_WORDS, core_),
         Binding::of(SHADE_AUX, aux_),
         Binding::sampled(SHADE_NORMAL_ROUGHNESS, frame.normalRoughness),
         Binding::sampled(SHADE_ALBEDO, frame.albedo), Binding::sampled(SHADE_SPECULAR, specular),
         Binding::sampled(SHADE_DEPTH, frame.depth), Binding::of(SHADE_LISTS, lists_),
         Binding::of(SHADE_ENTRIES, entries_), Binding::of(SHADE_COUNTERS, counters_)});
}

} // namespace candelabra::lighting
