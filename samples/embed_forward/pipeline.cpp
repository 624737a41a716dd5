// SPDX-License-Identifier: Apache-2.0
#include "ball.h"
#include "ball_frag.h"
#include "ball_vert.h"

Raster createBallPass(VkDevice device, VkDescriptorSetLayout lights)
{
    constexpr VkFormat radiance[] = {VK_FORMAT_R32G32B32A32_SFLOAT};
    return createRaster(
        device, {.vertex = ball_vert,
                 .fragment = ball_frag,
                 .setLayout = lights, // all that is specific to Candelabra
                 .constants = {VK_SHADER_STAGE_FRAGMENT_BIT, 0, sizeof(Ball) + 2 * sizeof(float)},
                 // Reversed depth: nearer is greater. Transparent surfaces write no depth.
                 .depthTest = VK_COMPARE_OP_GREATER,
                 .depthWrite = VK_FALSE,
                 // Blends over what is already there, with premultiplied alpha.
                 .blend = {.blendEnable = VK_TRUE,
                           .srcColorBlendFactor = VK_BLEND_FACTOR_ONE,
                           .dstColorBlendFactor = VK_BLEND_FACTOR_ONE_MINUS_SRC_ALPHA,
                           .srcAlphaBlendFactor = VK_BLEND_FACTOR_ZERO,
                           .dstAlphaBlendFactor = VK_BLEND_FACTOR_ONE,
                           .colorWriteMask = 0xF},
                 .colours = radiance});
}
