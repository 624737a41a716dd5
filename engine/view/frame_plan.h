// SPDX-License-Identifier: Apache-2.0
// A FramePlan holds the parameters of a frame's kernels and the counts that give the sizes of its
// dispatches. It is computed before the first pass of the frame is recorded.
#pragma once

#include "view/module.h"

namespace candelabra::lighting
{

struct FramePlan {
    const CndLightingFrame& frame;
    gpu::FrameParams params; // for the frame's uniform buffer
    glm::uvec2 tileCount;
    LightTypeCounts lights; // by type; 0 for types that the frame leaves out
    TreeShapes trees;
    float splitLength; // gpu::TileClustersParams
    gpu::PrepareLightsParams prepare;
    bool occluders; // some may shadow lights
    bool shadows;   // pairs are asked for: there are occluders, or the host finds visible points
};

// `frame` comes from checkedFrame and must outlive the plan. Throws gpu::Failure if its projection
// is none that projectionOf takes.
FramePlan planFrame(const Module& module, const CndLightingFrame& frame);

// Returns the number of tiles in a row of `pixels` pixels.
inline uint32_t tilesAlong(uint32_t pixels)
{
    return gpu::divideUp(pixels, gpu::TILE_SIZE);
}

} // namespace candelabra::lighting
