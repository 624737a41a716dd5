// SPDX-License-Identifier: Apache-2.0
// What one frame of a view is made with: view.cpp decides, view_shading.cpp shades.
#pragma once

#include "lighting/lighting.h"

namespace candelabra::lighting
{

inline uint32_t tiles(uint32_t pixels)
{
    return gpu::divideUp(pixels, gpu::TILE_SIZE);
}

inline uint32_t lobesOf(const CndLightingFrame& frame)
{
    return uint32_t(frame.lobes) | (frame.energyCompensation ? gpu::COMPENSATE_ENERGY : 0);
}

// Everything a frame's dispatches are sized with.
struct View::Plan {
    gpu::Projection projection;
    glm::uvec2 size;
    glm::vec2 invImageSize; // one value for all kernels: GPU divisions may differ in the last bit
    float clearDepth;
    uint32_t lightCount;
    LightTypeCounts lights; // by type, 0 for types none of which reaches the view
    TreeShapes trees;
    uint32_t tileCountX, tileCountY;
    uint32_t sampleCount;
    float splitLength; // gpu::TileClustersParams
    gpu::PrepareLightsParams prepare;
};

} // namespace candelabra::lighting
