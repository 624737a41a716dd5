// SPDX-License-Identifier: Apache-2.0
// The host's scene and its G-buffer pass: boxes, drawn into images whose formats the host chose.
#pragma once

#include <glm/glm.hpp>

#include "window.h"

// The images of the pass, and those that Candelabra adds its light to and displays.
struct GBuffer {
    HostImage normal;             // A2B10G10R10_UNORM: 0.5 + 0.5 * normal, world space
    HostImage baseColour;         // R8G8B8A8_SRGB
    HostImage roughnessMetalness; // R8G8_UNORM
    HostImage depth;              // D32_SFLOAT, 0 at the near plane, 1 at the far plane
    HostImage radiance, display;

    void create(const Host& host, VkExtent2D size);
    void destroy(const Host& host);
};

// Describes this layout to Candelabra.
constexpr CndGBufferDesc gbufferDesc{.normalEncoding = CND_NORMAL_UNORM,
                                     .normalSpace = CND_NORMALS_WORLD,
                                     .roughness = CND_CHANNEL_SPECULAR_R,
                                     .roughnessKind = CND_ROUGHNESS_PERCEPTUAL,
                                     .reflectance = CND_REFLECTANCE_METALNESS,
                                     .metalness = CND_CHANNEL_SPECULAR_G,
                                     .normalRoughnessFormat = VK_FORMAT_A2B10G10R10_UNORM_PACK32,
                                     .albedoFormat = VK_FORMAT_R8G8B8A8_SRGB,
                                     .specularFormat = VK_FORMAT_R8G8_UNORM,
                                     .depthFormat = VK_FORMAT_D32_SFLOAT};

class Boxes
{
public:
    explicit Boxes(const Host& host);
    ~Boxes();
    Boxes(const Boxes&) = delete;
    Boxes& operator=(const Boxes&) = delete;

    // Draws the G-buffer. Leaves its images in the state that CndLightingFrame requires.
    void record(VkCommandBuffer cmd, const GBuffer& gbuffer, VkExtent2D size,
                const glm::mat4& clipFromWorld) const;

private:
    VkDevice device_;
    Raster raster_;
};
