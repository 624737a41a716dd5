// SPDX-License-Identifier: Apache-2.0
// The host's own shadow map: the depth of a window frame as a spot light sees it, and descriptor
// set 1 with which Candelabra's kernels read it.
#pragma once

#include <cstdint>

#include "host.hpp"

// A bar of the window frame: a rectangle at z = frameZ.
struct Bar {
    float low[2], high[2]; // metres
};
constexpr Bar bars[] = {{{-0.2f, -0.15f}, {0.45f, -0.12f}}, {{-0.2f, 0.06f}, {0.45f, 0.09f}},
                        {{-0.2f, 0.27f}, {0.45f, 0.3f}},    {{-0.2f, -0.15f}, {-0.17f, 0.3f}},
                        {{0.11f, -0.15f}, {0.14f, 0.3f}},   {{0.42f, -0.15f}, {0.45f, 0.3f}}};
constexpr float frameZ = 0.2f; // behind the camera

constexpr uint32_t shadowMapSize = 1024; // texels

// The uniform block of the GLSL in main.cpp.
struct ShadowParameters {
    float shadowFromView[16]; // clip space of the shadow map from view space
    uint32_t light;           // low half of the id of the light that the map is for
};

struct ShadowMap {
    HostImage depth;
    VkSampler sampler;
    HostBuffer buffer;
    ShadowParameters* parameters; // in `buffer`
    VkDescriptorSetLayout setLayout;
    VkDescriptorPool pool;
    VkDescriptorSet set;
    Raster raster;
};

ShadowMap createShadowMap(const Host& host);
void destroyShadowMap(const Host& host, const ShadowMap& map);
// Draws the window frame into the map and makes it readable by compute shaders. The map's
// parameters must be set; the camera is at the world's origin, so view space is world space.
void drawShadowMap(const Host& host, const ShadowMap& map);
