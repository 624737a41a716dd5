// SPDX-License-Identifier: Apache-2.0
// A transparent ball, drawn into the radiance of a frame. Ball has the push constants of ball.frag.
#ifndef CANDELABRA_SAMPLES_BALL_H
#define CANDELABRA_SAMPLES_BALL_H

#include <candelabra/candelabra.h>
#include <vulkan/vulkan.h>

struct Ball {
    float centre[3], radius; // view space, metres
    // Diffuse albedo of its coat.
    float albedo[3];
    // Share of the background that the coat covers.
    float opacity;
    float F0, F90; // Fresnel reflectance of the coat at 0 and 90 degrees
    float perceptualRoughness;
};

struct BallPass {
    VkPipelineLayout layout;
    VkPipeline pipeline;
};

// `lights`: the layout of descriptor set 0, from cndGetForwardSetLayout.
BallPass createBallPass(VkDevice device, VkDescriptorSetLayout lights);
void destroyBallPass(VkDevice device, const BallPass& pass);

#endif
