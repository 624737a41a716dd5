// SPDX-License-Identifier: Apache-2.0
// Everything that crosses between the environment module and its kernels.
//
// Directions are in the environment's own space, with y up. A cube face is a square of side 2 at
// distance 1; faces and texels are numbered as in Vulkan (faces +x -x +y -y +z -z). The top row of
// the equirectangular image is +y, its middle is -z, and +x is to the right of the middle.
#ifndef CND_SHARED_ENVIRONMENT_DATA_H
#define CND_SHARED_ENVIRONMENT_DATA_H

#include "shared/host_gbuffer_data.h"
#include "shared/lighting_data.h"

GPU_BEGIN

// Larger luminances are clamped to this when the environment is read. Sums over a cube are still
// finite.
const float ENVIRONMENT_MAX_LUMINANCE = 2e12f;

const uint ENVIRONMENT_GROUP = 8u; // x and y, for all kernels that prepare an image
const uint ENVIRONMENT_IMAGE = 0u; // binding of environment_cube and environment_cells

// --- environment_cube: makes mip 0 from the equirectangular image, one lane per texel, z = face.
// Each part of the image gives its luminance times solid angle to the texels around it, in shares
// that add up to 1 and keep its place on the face (a tent per texel), so that sum and first moment
// stay the same. Next to the edges of a face the outer texel gets all. A texel holds its sum
// divided by the solid angle that it has gathered.
const uint ENVIRONMENT_CUBE_OUTPUT = 1u;
const uint ENVIRONMENT_CUBE_MIRROR = 2u; // level 0 of the prefiltered cube
// Texels near the poles gather from whole rows of the image. So that their loops stay below the
// limit that some devices have, a dispatch gathers from a few of a texel's rows, and the next from
// the next.
struct EnvironmentCubeParams {
    uvec2 imageSize;
    uint cubeSize;
    uint skippedRows; // of each texel
    uint rows;        // likewise, to be gathered
};
GPU_SIZE(EnvironmentCubeParams, 20)

// --- environment_mip: a texel gathers from 16 texels of the finer mip, in shares that keep sum and
// first moment as in environment_cube.
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
// sample reads a mip whose texels are about as wide as the sample's share of the lobe.
const uint ENVIRONMENT_PREFILTER_SOURCE = 0u;
const uint ENVIRONMENT_PREFILTER_OUTPUT = 1u;
const uint ENVIRONMENT_PREFILTER_SAMPLES = 2u; // vec4 each: x and y in the frame of n, mip, weight
const uint ENVIRONMENT_SAMPLES = 96u;          // of each level
struct EnvironmentPrefilterParams {
    uint size; // size of the output
    uint firstSample;
};
GPU_SIZE(EnvironmentPrefilterParams, 8)
// The last level of the prefiltered cube is for alpha = 1. Each level before it has twice the size
// and half the alpha, except that level 0 is the mirror image.
const uint ENVIRONMENT_LAST_LEVEL_SIZE = 8u;

// --- environment_cells: integrates luminance times direction over each cell of a grid of polar
// angles and azimuths, per channel, exactly for texels of constant luminance. One lane per cell.
const uint ENVIRONMENT_CELLS_OUTPUT = 1u; // mat3 per cell, row by row; a column is a channel
const uint ENVIRONMENT_CELL_ROWS = 64u;
const uint ENVIRONMENT_CELL_COLUMNS = 128u;
struct EnvironmentCellsParams {
    uvec2 imageSize;
};
GPU_SIZE(EnvironmentCellsParams, 8)

// --- environment_irradiance: radiance of a white diffuse surface (irradiance / pi) for each
// normal, summed over all cells. A cell gives n . moment if that is positive. This is exact unless
// the horizon of n cuts through the light of a cell, as that of level ground and of walls along the
// axes never does. Nine spherical harmonics have an error of 9% under a small sun.
const uint ENVIRONMENT_IRRADIANCE_CELLS = 0u;
const uint ENVIRONMENT_IRRADIANCE_OUTPUT = 1u;
// Odd, so that the axes, which most floors and walls face, are centres of texels. Between the
// centres of 65 texels interpolation loses 0.03%, and up to 0.8% of the illuminance at normal
// incidence where a small sun is within 2 degrees of the horizon.
const uint ENVIRONMENT_IRRADIANCE_SIZE = 65u;
const uint ENVIRONMENT_IRRADIANCE_NORMALS = 5u; // and as many opposite ones: of one lane

// --- shade_environment: one lane per pixel
const uint SHADE_ENVIRONMENT_GROUP = 8u; // x and y
const uint SHADE_ENVIRONMENT_DEPTH = 0u;
const uint SHADE_ENVIRONMENT_CUBE = 1u;
const uint SHADE_ENVIRONMENT_PREFILTERED = 2u;
const uint SHADE_ENVIRONMENT_IRRADIANCE = 3u;
const uint SHADE_ENVIRONMENT_DFG = 4u;
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
