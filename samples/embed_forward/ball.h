// SPDX-License-Identifier: Apache-2.0
// A transparent ball, drawn into the radiance of a frame. Push constants of ball.frag.
#ifndef CANDELABRA_SAMPLES_BALL_H
#define CANDELABRA_SAMPLES_BALL_H

#include <candelabra/candelabra.h>
#include <vulkan/vulkan.h>

struct Ball {
    float centre[3], radius; // view space, metres
    float albedo[3];         // of its coat, which covers
    float opacity;           // this share of what is behind
    float F0, F90;           // of the coat
    float perceptualRoughness;
};

struct BallPass {
    VkPipelineLayout layout;
    VkPipeline pipeline;
};

// `lights`: the layout of set 0, cndGetForwardSetLayout.
BallPass createBallPass(VkDevice device, VkDescriptorSetLayout lights);
void destroyBallPass(VkDevice device, const BallPass& pass);

#endif
