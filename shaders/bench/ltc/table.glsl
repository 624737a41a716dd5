// SPDX-License-Identifier: Apache-2.0
// Binding of the table that bench/ltc/lobes.glsl reads.
#extension GL_EXT_samplerless_texture_functions : require
#include "shared/bench.h"

layout(binding = BENCH_LTC) uniform textureBuffer ltcTexels;

vec4 ltcTexel(uint index)
{
    return texelFetch(ltcTexels, int(index));
}
