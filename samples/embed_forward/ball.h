// SPDX-License-Identifier: Apache-2.0
// A transparent ball, drawn into the radiance of a frame. Ball has the push constants of ball.frag.
#ifndef CANDELABRA_SAMPLES_BALL_H
#define CANDELABRA_SAMPLES_BALL_H

#include "host.hpp"

struct Ball {
    float centre[3], radius; // view space, metres
    // Diffuse albedo of its coat.
    float albedo[3];
    // Share of the background that the coat covers.
    float opacity;
    float F0, F90; // Fresnel reflectance of the coat at 0 and 90 degrees
    float perceptualRoughness;
};

// The pipeline of the transparent pass. `lights`: the layout of descriptor set 0, from
// cndGetForwardSetLayout.
Raster createBallPass(VkDevice device, VkDescriptorSetLayout lights);

#endif
