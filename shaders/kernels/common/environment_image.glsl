// SPDX-License-Identifier: Apache-2.0
// Reads the equirectangular image of an environment. No sampler is used, so that the host's image may
// have any format and usage.
#ifndef CND_KERNELS_ENVIRONMENT_IMAGE
#define CND_KERNELS_ENVIRONMENT_IMAGE

#extension GL_EXT_samplerless_texture_functions : require

#include "shared/environment_data.h"

layout(binding = ENVIRONMENT_IMAGE) uniform texture2D equirectangularImage;

// Returns the luminance of a texel. Files may contain any value: NaN and negative values become 0,
// infinity becomes ENVIRONMENT_MAX_LUMINANCE.
vec3 luminanceAt(uint column, uint row)
{
    const vec3 value = texelFetch(equirectangularImage, ivec2(column, row), 0).rgb;
    return mix(vec3(0.0), min(value, ENVIRONMENT_MAX_LUMINANCE), greaterThan(value, vec3(0.0)));
}

#endif
