// SPDX-License-Identifier: Apache-2.0
// Computes the irradiance divided by pi for every normal, as a sum over all cells.
#version 460
#extension GL_GOOGLE_include_directive : require
#include "shared/environment_data.h"
#include "lib/cube.glsl"

layout(local_size_x = ENVIRONMENT_GROUP, local_size_y = ENVIRONMENT_GROUP) in;
layout(scalar, binding = ENVIRONMENT_IRRADIANCE_CELLS) readonly buffer Cells
{
    mat3 cells[];
};
layout(binding = ENVIRONMENT_IRRADIANCE_OUTPUT, rgba32f) uniform writeonly image2DArray irradiance;

const uint SIZE = ENVIRONMENT_IRRADIANCE_SIZE;
const uint NORMALS = ENVIRONMENT_IRRADIANCE_NORMALS;

// Returns the texel of the opposite normal, on the next face.
uvec3 oppositeOf(uvec3 texel)
{
    const bool ofX = texel.z == 2u; // on +y and -y u changes its sign, on the others v
    return uvec3(ofX ? SIZE - 1u - texel.x : texel.x, ofX ? texel.y : SIZE - 1u - texel.y,
                 texel.z + 1u);
}

// A lane sums for several normals of a column of texels and for their opposites, because reading cells
// takes longer than the sums do.
void main()
{
    const uvec3 first = uvec3(gl_GlobalInvocationID.x, NORMALS * gl_GlobalInvocationID.y,
                              2u * gl_GlobalInvocationID.z);
    if (first.x >= SIZE || first.y >= SIZE)
        return;
    vec3 normals[NORMALS];
    vec3 sums[NORMALS];
    vec3 opposite[NORMALS];
    for (uint i = 0u; i < NORMALS; ++i) {
        const vec2 centre = cubeTexelCentre(first.xy + uvec2(0u, i), SIZE);
        normals[i] = normalize(cubeDirection(first.z, centre));
        sums[i] = opposite[i] = vec3(0.0);
    }
    for (uint row = 0u; row < ENVIRONMENT_CELL_ROWS; ++row) {
        vec3 rowSums[NORMALS];
        vec3 rowOpposite[NORMALS];
        for (uint i = 0u; i < NORMALS; ++i)
            rowSums[i] = rowOpposite[i] = vec3(0.0);
        for (uint column = 0u; column < ENVIRONMENT_CELL_COLUMNS; ++column) {
            const mat3 moments = cells[row * ENVIRONMENT_CELL_COLUMNS + column];
            for (uint i = 0u; i < NORMALS; ++i) {
                const vec3 light = normals[i] * moments;
                rowSums[i] += max(light, vec3(0.0));
                rowOpposite[i] -= min(light, vec3(0.0));
            }
        }
        for (uint i = 0u; i < NORMALS; ++i) {
            sums[i] += rowSums[i];
            opposite[i] += rowOpposite[i];
        }
    }
    for (uint i = 0u; i < NORMALS && first.y + i < SIZE; ++i) {
        const uvec3 texel = first + uvec3(0u, i, 0u);
        imageStore(irradiance, ivec3(texel), vec4(INV_PI * sums[i], 1.0));
        imageStore(irradiance, ivec3(oppositeOf(texel)), vec4(INV_PI * opposite[i], 1.0));
    }
}
