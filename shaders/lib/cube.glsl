// SPDX-License-Identifier: Apache-2.0
// Directions, faces and texels of a cube map.
#ifndef CND_LIB_CUBE
#define CND_LIB_CUBE

#include "lib/math.glsl"

// Returns the direction, not normalised, through the point (u, v) in [-1, 1]^2 of a face, where v grows
// from row to row. This is "Cube Map Face Selection" of the Vulkan 1.3 specification, solved for the
// direction.
vec3 cubeDirection(uint face, vec2 uv)
{
    const vec3 directions[6] = vec3[6](vec3(1.0, -uv.y, -uv.x), vec3(-1.0, -uv.y, uv.x),
                                       vec3(uv.x, 1.0, uv.y), vec3(uv.x, -1.0, -uv.y),
                                       vec3(uv.x, -uv.y, 1.0), vec3(-uv.x, -uv.y, -1.0));
    return directions[face];
}

// Returns the point (u, v) in the centre of a texel.
vec2 cubeTexelCentre(uvec2 texel, uint size)
{
    return (2.0 * vec2(texel) + 1.0) / float(size) - 1.0;
}

// Returns the solid angle of the texel around (u, v), by the midpoint rule, whose relative error is
// below 1 / size^2.
float cubeTexelSolidAngle(vec2 uv, uint size)
{
    const float r2 = 1.0 + dot(uv, uv);
    const float side = 2.0 / float(size);
    return side * side * inversesqrt(r2) / r2;
}

#endif
