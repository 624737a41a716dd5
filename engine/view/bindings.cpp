// SPDX-License-Identifier: Apache-2.0
// The bindings of each kernel of a frame.
#include "view/view.h"

namespace candelabra::lighting
{

using gpu::Binding;

void View::writeBindings(const FramePlan& plan) const
{
    const CndLightingFrame& frame = plan.frame;
    const uint32_t slot = frame.frameSlot;
    const LightSet& lights = module_.lights;
    const gpu::Buffer& albedoTable = module_.albedoTable.buffer();
    uniforms_.write(slot, plan.params);
    surfaces::GBufferViews images = module_.gbuffer.views(frame);
    if (!module_.gbuffer.depthIsProjected()) {
        sets_.projectDepth.write(slot,
                                 {Binding::sampled(gpu::PROJECT_DEPTH_STORED, images.depth),
                                  Binding::storage(gpu::PROJECT_DEPTH_OUTPUT, depth_.view.get()),
                                  uniforms_.at(slot)});
        images.depth = {depth_.view.get(), VK_IMAGE_LAYOUT_GENERAL};
    }
    sets_.prepareLights.write(slot, {Binding::of(gpu::PREPARE_LIGHTS_RECORDS, lights.records()),
                                     Binding::of(gpu::PREPARE_LIGHTS_CORE, core_),
                                     Binding::of(gpu::PREPARE_LIGHTS_SHAPES, shapes_),
                                     Binding::of(gpu::PREPARE_LIGHTS_ORDER, lights.order()),
                                     Binding::of(gpu::PREPARE_LIGHTS_IDS, ids_),
                                     Binding::of(gpu::PREPARE_LIGHTS_POLYGONS, lights.polygons())});
    clusters_.writeBindings(
        slot, lights.typeCounts(),
        {.gbuffer = images, .uniforms = uniforms_, .core = core_, .counters = counters_});
    if (forward_.wanted())
        forward_.write(slot,
                       {.core = core_,
                        .shapes = shapes_,
                        .nodes = clusters_.nodes(),
                        .ids = ids_,
                        .directionalAlbedo = albedoTable},
                       forwardShadowBindings(slot));
    if (shadows_)
        shadows_->writeBindings(plan, {.gbuffer = images,
                                       .uniforms = uniforms_,
                                       .core = core_,
                                       .shapes = shapes_,
                                       .ids = ids_,
                                       .albedoTable = albedoTable,
                                       .counters = counters_});
    if (proofs_)
        proofs_->writeBindings(
            plan, {.uniforms = uniforms_, .core = core_, .shapes = shapes_, .counters = counters_});
    if (influence_)
        influence_->writeBindings(slot, {.gbuffer = images,
                                         .uniforms = uniforms_,
                                         .radiance = frame.radiance,
                                         .core = core_,
                                         .shapes = shapes_,
                                         .ids = ids_,
                                         .directionalAlbedo = albedoTable,
                                         .counters = counters_});
    if (frame.culling == CND_CULLING_BRUTE) {
        writeBruteBindings(frame, images);
        return;
    }
    for (uint32_t type = 0; type < CND_LIGHT_TYPE_COUNT; ++type)
        if (lights.typeCounts()[type])
            writeShadeBindings(frame, images, type);
}

void View::writeBruteBindings(const CndLightingFrame& frame,
                              const surfaces::GBufferViews& images) const
{
    using namespace gpu;
    const gpu::Buffer& albedoTable = module_.albedoTable.buffer();
    BindingList gbuffer;
    gbuffer.add(images.bindings());
    if (shadows_)
        gbuffer.add(std::array{shadows_->slots(), shadows_->view(frame.frameSlot)});
    sets_.shadeBrute.write(
        frame.frameSlot,
        {Binding::ofTexels(LIGHT_CORE_TEXELS, core_), Binding::of(LIGHT_CORE, core_),
         Binding::of(SHADE_SHAPES, shapes_), Binding::of(SHADE_LIGHT_IDS, ids_),
         Binding::sampled(SHADE_DEPTH, images.depth), uniforms_.at(frame.frameSlot),
         Binding::storage(RADIANCE_IMAGE, frame.radiance),
         Binding::ofTexels(SHADE_DFG, albedoTable)},
        gbuffer);
}

gpu::BindingList View::forwardShadowBindings(uint32_t slot) const
{
    gpu::BindingList out;
    if (!shadows_)
        return out;
    const auto all = shadows_->occluderBindings(slot);
    if (!module_.hostKernels.findsPoints()) {
        out.add(all);
        return out;
    }
    for (gpu::Binding b : std::span(all).last(2)) { // SHADOW_POINTS and SHADOW_VIEW
        b.binding = b.binding == gpu::SHADOW_VIEW ? gpu::SHADOW_VIEW_OF_RAYS : b.binding;
        out.add({&b, 1});
    }
    return out;
}

void View::writeShadeBindings(const CndLightingFrame& frame, const surfaces::GBufferViews& images,
                              uint32_t type) const
{
    using namespace gpu;
    const uint32_t set = frame.frameSlot * CND_LIGHT_TYPE_COUNT + type;
    const gpu::Buffer& albedoTable = module_.albedoTable.buffer();
    const Clusters::Lists& lists = clusters_.lists(type);
    const Binding core = Binding::ofTexels(LIGHT_CORE_TEXELS, core_);
    const Binding coreWords = Binding::of(LIGHT_CORE, core_);
    const Binding shapes = Binding::of(SHADE_SHAPES, shapes_);
    const Binding ids = Binding::of(SHADE_LIGHT_IDS, ids_);
    const std::array gbuffer = images.bindings();
    const Binding depth = Binding::sampled(SHADE_DEPTH, images.depth);
    const Binding uniforms = uniforms_.at(frame.frameSlot);
    const Binding radiance = Binding::storage(RADIANCE_IMAGE, frame.radiance);
    const Binding dfg = Binding::ofTexels(SHADE_DFG, albedoTable);
    const Binding tiles = Binding::of(SHADE_TILES, clusters_.tiles());
    const Binding heads = Binding::of(SHADE_LISTS, lists.heads);
    const Binding entries = Binding::of(SHADE_ENTRIES, clusters_.entries());
    const Binding entryTexels = Binding::ofTexels(SHADE_ENTRY_TEXELS, clusters_.entries());
    const Binding surfaces = Binding::of(SHADE_WORK, clusters_.surfaces());
    const Binding toShade = Binding::of(SHADE_WORK, clusters_.tilesToShade(type));
    const Binding unlisted = Binding::of(SHADE_WORK, lists.unlisted);
    BindingList listed, walked;
    listed.add(gbuffer);
    walked.add(gbuffer);
    if (shadows_) {
        listed.add(shadows_->slotBindings());
        listed.add(std::array{shadows_->view(frame.frameSlot)});
        walked.add(shadows_->occluderBindings(frame.frameSlot));
        walked.add(shadows_->occluderTexels());
        walked.add(std::array{Shadows::counters(counters_)});
    }
    sets_.shadeTiles.write(set,
                           {core, coreWords, shapes, ids, depth, uniforms, radiance, dfg, tiles,
                            heads, entries, entryTexels, Binding::of(SHADE_SUMS, clusters_.sums()),
                            toShade},
                           listed);
    sets_.shadeUnlisted.write(set,
                              {core, coreWords, shapes, ids, depth, uniforms, radiance, dfg, tiles,
                               heads, unlisted,
                               Binding::ofTexels(TREE_NODE_TEXELS, clusters_.nodes()),
                               Binding::of(TREE_NODES, clusters_.nodes())},
                              walked);
    // Every binding needs an image, even if the frame has no pairImage and count_pairs writes none.
    const VkImageView pairs = frame.pairImage ? frame.pairImage : frame.radiance;
    sets_.countPairs.write(set,
                           {core, coreWords, shapes, ids, depth, uniforms, dfg, tiles, heads,
                            entries, entryTexels, surfaces, Binding::of(SHADE_COUNTERS, counters_),
                            Binding::storage(SHADE_PAIRS, pairs)},
                           gbuffer);
}

} // namespace candelabra::lighting
