// SPDX-License-Identifier: Apache-2.0
// Everything that crosses between the environment module and its kernels.
//
// Directions are in the environment's own space, with y up. A cube face is a square of side 2 at
// distance 1; faces and texels are numbered as in Vulkan (faces +x -x +y -y +z -z). The top row of
// the equirectangular image is +y, its middle is -z, and +x is to the right of the middle.
#ifndef CND_SHARED_ENVIRONMENT_H
#define CND_SHARED_ENVIRONMENT_H

#include "shared/host_gbuffer.h"
#include "shared/lighting.h"

GPU_BEGIN

// Larger luminances are clamped to this when the environment is read. It is 1000 times the
// luminance of the Sun's disc, and its sums over a cube are still finite.
const float ENVIRONMENT_MAX_LUMINANCE = 2e12f;

// --- environment_cube: makes mip 0 from the equirectangular image, one lane per texel, z = face. A
// texel is the mean of `samples` by `samples` bilinear look-ups, so that no texel of the image is
// skipped.
const uint ENVIRONMENT_GROUP = 8u; // x and y, for all kernels that write cubes
const uint ENVIRONMENT_CUBE_IMAGE = 0u;
const uint ENVIRONMENT_CUBE_OUTPUT = 1u;
const uint ENVIRONMENT_CUBE_MIRROR = 2u; // level 0 of the prefiltered cube
const uint ENVIRONMENT_MAX_SAMPLES = 16u;
struct EnvironmentCubeParams {
    uvec2 imageSize;
    uint cubeSize;
    uint samples;
};
GPU_SIZE(EnvironmentCubeParams, 16)

// --- environment_mip: a texel is the mean of four texels of the finer mip, weighted by their solid
// angles, so that integrals over the sphere are the same in every mip.
const uint ENVIRONMENT_MIP_INPUT = 0u;
const uint ENVIRONMENT_MIP_OUTPUT = 1u;
struct EnvironmentMipParams {
    uint size; // size of the output
};
GPU_SIZE(EnvironmentMipParams, 4)

// --- environment_prefilter: mean radiance over the GGX lobe, including shadowing and cosine, of a
// surface that faces both the eye and the direction (v = n, as in Karis 2013, "Real Shading in
// Unreal Engine 4"). Karis weights samples by NoL; the weights here are those of the lobe itself,
// which are exact for v = n. It uses filtered importance sampling (Krivanek and Colbert 2008): each
// sample reads a mip whose texels are twice as wide as the sample's share of the lobe, so that
// neighbours overlap.
const uint ENVIRONMENT_PREFILTER_SOURCE = 0u;
const uint ENVIRONMENT_PREFILTER_OUTPUT = 1u;
const uint ENVIRONMENT_PREFILTER_SAMPLES = 1024u;
struct EnvironmentPrefilterParams {
    uint size; // size of the output
    uint sourceSize;
    float alpha;
};
GPU_SIZE(EnvironmentPrefilterParams, 12)
// The last level of the prefiltered cube is for alpha = 1. Each level before it has twice the size
// and half the alpha, except that level 0 is the mirror image.
const uint ENVIRONMENT_LAST_LEVEL_SIZE = 8u;

// --- environment_irradiance: radiance of a white diffuse surface (irradiance / pi) for each
// normal, summed over the texels of one mip of the source. The largest error, relative to the
// brightest normal, is 0.05% for a cloudy sky and 0.2% for a small sun alone, where nine spherical
// harmonics have an error of 9%.
const uint ENVIRONMENT_IRRADIANCE_SOURCE = 0u;
const uint ENVIRONMENT_IRRADIANCE_OUTPUT = 1u;
const uint ENVIRONMENT_IRRADIANCE_SIZE = 32u;
const uint ENVIRONMENT_IRRADIANCE_SOURCE_SIZE = 32u; // size of the source's mip
struct EnvironmentIrradianceParams {
    uint sourceSize;
};
GPU_SIZE(EnvironmentIrradianceParams, 4)

// --- shade_environment: one lane per pixel
const uint SHADE_ENVIRONMENT_GROUP = 8u; // x and y
const uint SHADE_ENVIRONMENT_DEPTH = 0u;
const uint SHADE_ENVIRONMENT_RADIANCE = 1u;
const uint SHADE_ENVIRONMENT_CUBE = 2u;
const uint SHADE_ENVIRONMENT_PREFILTERED = 3u;
const uint SHADE_ENVIRONMENT_IRRADIANCE = 4u;
const uint SHADE_ENVIRONMENT_DFG = 5u;
const uint SHADE_ENVIRONMENT_FRAME = 6u;   // FrameParams
const uint SHADE_ENVIRONMENT_GBUFFER = 7u; // six bindings (shared/host_gbuffer.h)
struct ShadeEnvironmentParams {
    mat3 environmentFromView; // rotation
    float lastLevel;          // last level of the prefiltered cube
    float scale;              // factor on the environment's luminance
    uint showsBackground;     // 1: pixels without a surface show the environment
    StoredDepth depth;
};
GPU_SIZE(ShadeEnvironmentParams, 68)

GPU_END

#endif
