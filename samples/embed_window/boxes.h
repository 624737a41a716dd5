// SPDX-License-Identifier: Apache-2.0
// The host's scene and its G-buffer pass: boxes, in images of the host's own choice.
#pragma once

#include <glm/glm.hpp>

#include "window.h"

// What the pass leaves behind, and what Candelabra adds its light to and shows.
struct GBuffer {
    HostImage normal;             // A2B10G10R10_UNORM: 0.5 + 0.5 * normal, world space
    HostImage baseColour;         // R8G8B8A8_SRGB
    HostImage roughnessMetalness; // R8G8_UNORM
    HostImage depth;              // D32_SFLOAT, 0 at the near plane, 1 far away
    HostImage radiance, display;

    void create(const Host& host, VkExtent2D size);
    void destroy(const Host& host);
};

// How Candelabra is told about it.
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

    // Draws the G-buffer and leaves it, and radiance, as CndLightingFrame wants them.
    void record(VkCommandBuffer cmd, const GBuffer& gbuffer, VkExtent2D size,
                const glm::mat4& clipFromWorld) const;

private:
    VkDevice device_;
    VkPipelineLayout layout_ = VK_NULL_HANDLE;
    VkPipeline pipeline_ = VK_NULL_HANDLE;
};
