// SPDX-License-Identifier: Apache-2.0
// What one frame of a view is made with: everything that its dispatches are sized with and given.
#pragma once

#include "view/module.h"

namespace candelabra::lighting
{

struct FramePlan {
    const CndLightingFrame& frame;
    gpu::FrameParams params; // for the frame's uniform buffer
    glm::uvec2 tileCount;
    LightTypeCounts lights; // by type, 0 for types that the frame can do without
    TreeShapes trees;
    float splitLength; // gpu::TileClustersParams
    gpu::PrepareLightsParams prepare;
};

// `frame` is valid and must outlive the plan. Throws gpu::Failure when the kernels cannot take its
// projection.
FramePlan planFrame(const Module& module, const CndLightingFrame& frame);

// Tiles in a row of so many pixels.
inline uint32_t tilesAlong(uint32_t pixels)
{
    return gpu::divideUp(pixels, gpu::TILE_SIZE);
}

} // namespace candelabra::lighting
