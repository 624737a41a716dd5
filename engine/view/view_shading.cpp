// SPDX-License-Identifier: Apache-2.0
// The dispatches that evaluate lights: by type, in batches where the device limits loops.
#include <algorithm>

#include "view/view_plan.h"

namespace candelabra::lighting
{
namespace
{

// Of loops inside the evaluation of one light, at most: outlines of tubes have 16 edges and are
// walked for the diffuse lobe and two specular ones, discs have a series of 9 terms.
uint32_t loopIterations(uint32_t lightType, CndSpecularMethod method, uint32_t sampleCount)
{
    const uint32_t shape = lightType == CND_LIGHT_TUBE ? 64 : isSphere(lightType) ? 0 : 24;
    return shape + (method == CND_SPECULAR_SAMPLED ? sampleCount : 0);
}

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

} // namespace

gpu::ShadeParams View::shadeParams(const CndLightingFrame& frame, const Plan& p,
                                   uint32_t type) const noexcept
{
    return {.projection = p.projection,
            .size = p.size,
            .origin = {0, 0},
            .firstLight = p.trees[type].firstLight,
            .lightCount = p.trees[type].lightCount,
            .tileCountX = p.tileCountX,
            .clearDepth = p.clearDepth,
            .invImageSize = p.invImageSize,
            .sampleCount = p.sampleCount,
            .sampleSeed = frame.sampleSeed,
            .errorBudget = frame.errorBudget,
            .lobes = lobesOf(frame),
            .tree = p.trees[type]};
}

void View::recordBrute(const gpu::Frame& f, const CndLightingFrame& frame, const Plan& p,
                       uint32_t type) const noexcept
{
    const ShadeKernels::Variant& kernels =
        lighting_.kernels().shade.variant(type, frame.specularMethod, frame.errorBudget > 0);
    inBatches(shadeParams(frame, p, type), lightsPerBatch(frame, p, type),
              [&](gpu::ShadeParams params) {
                  const VkRect2D& r = frame.bruteRect;
                  if (r.extent.width && r.extent.height) {
                      params.origin = {r.offset.x, r.offset.y};
                      params.size = params.origin + glm::uvec2(r.extent.width, r.extent.height);
                  }
                  const glm::uvec2 pixels = params.size - params.origin;
                  kernels.brute.dispatch(f, sets_.shadeBrute.set(f.slot), params, tiles(pixels.x),
                                         tiles(pixels.y));
                  f.barrier();
              });
}

uint32_t View::lightsPerBatch(const CndLightingFrame& frame, const Plan& p,
                              uint32_t type) const noexcept
{
    return lighting_.lightsPerBatch(loopIterations(type, frame.specularMethod, p.sampleCount));
}

void View::recordClustered(const gpu::Frame& f, const CndLightingFrame& frame, const Plan& p,
                           uint32_t type) const noexcept
{
    const ShadeKernels& kernels = lighting_.kernels().shade;
    const uint32_t set = f.slot * CND_LIGHT_TYPE_COUNT + type;
    const gpu::ShadeParams params = shadeParams(frame, p, type);
    const uint32_t perBatch = lightsPerBatch(frame, p, type);
    const auto shade = [&](const gpu::ShadeParams& batch) {
        byClass(kernels, frame, type, [&](const ShadeKernels::Tiles& tiles, VkDeviceSize workList) {
            tiles.shade.dispatchIndirect(f, sets_.shadeTiles.set(set), batch,
                                         clusters_.tilesToShade(type), workList);
        });
        f.barrier();
    };
    if (isDistant(type)) { // they reach everything: no lists
        inBatches(params, perBatch, shade);
    } else {
        shade(params);
        recordUnlisted(f, frame, params, type, perBatch);
    }
    if (frame.countPairs) {
        gpu::ShadeParams counted = params;
        counted.batchLevel = frame.pairImage ? 1 : 0;
        byClass(kernels, frame, type, [&](const ShadeKernels::Tiles& tiles, VkDeviceSize workList) {
            tiles.countPairs.dispatchIndirect(f, sets_.countPairs.set(set), counted,
                                              clusters_.surfaces(), workList);
        });
        f.barrier();
    }
}

// Clusters whose list found no page; then, where the device limits loops, those of too many lights,
// by parts of the light tree.
void View::recordUnlisted(const gpu::Frame& f, const CndLightingFrame& frame,
                          gpu::ShadeParams params, uint32_t type, uint32_t perBatch) const noexcept
{
    const ShadeKernels& kernels = lighting_.kernels().shade;
    const uint32_t set = f.slot * CND_LIGHT_TYPE_COUNT + type;
    gpu::Timer untimed; // the parts are one row
    const gpu::Frame u{f.device, f.cmd, untimed, f.slot, f.hostSet};
    const auto record = [&](const gpu::ShadeParams& part) {
        byClass(kernels, frame, type, [&](const ShadeKernels::Tiles& tiles, VkDeviceSize workList) {
            tiles.unlisted.dispatchIndirect(u, sets_.shadeUnlisted.set(set), part,
                                            clusters_.lists(type).unlisted, workList);
        });
        u.barrier();
    };
    record(params);
    if (lighting_.device().maxLoopIterations != UINT32_MAX) {
        // A row of eight pixels may hold four clusters that take turns at walking the tree;
        // besides, finding a light takes about as many iterations as evaluating it.
        const uint32_t largest = std::max(perBatch / (2 * gpu::SLICES), gpu::TREE_WIDTH);
        uint32_t size = gpu::TREE_WIDTH;
        for (params.batchLevel = 1; params.batchLevel < 3 && size * gpu::TREE_WIDTH <= largest;
             ++params.batchLevel)
            size *= gpu::TREE_WIDTH;
        inBatches(params, largest / size * size, record);
    }
    f.timer.stamp(f.cmd, lighting_.kernels().shade.anyVariant().any.unlisted.name());
}

} // namespace candelabra::lighting
