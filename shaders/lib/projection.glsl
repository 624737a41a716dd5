// SPDX-License-Identifier: Apache-2.0
// View-space positions and directions from pixels and depths.
#ifndef CND_LIB_PROJECTION
#define CND_LIB_PROJECTION

#include "shared/lighting_data.h"

// Returns an integer that is ordered like the depth; -0 gives 0.
uint depthBits(float depth)
{
    return floatBitsToUint(depth) & 0x7FFFFFFFu;
}

// Returns the view-space z at a depth, as viewPosition() does.
float viewZ(Projection m, float depth)
{
    precise float z = (m.m32 - depth * m.m33) / (depth * m.m23 - m.m22);
    return z;
}

// Returns the view-space position of the centre of `pixel` at `depth`. The arithmetic is `precise`,
// without fused operations, so that two pipelines can differ only by the rounding of the divisions,
// which lib/cluster_margins.glsl allows for.
// It inverts clip = clipFromView * (x, y, z, 1), ndc = clip / clip.w, where
// depth = (m22 z + m32) / (m23 z + m33).
vec3 viewPosition(Projection m, uvec2 pixel, vec2 invImageSize, float depth)
{
    precise float z = viewZ(m, depth);
    precise float w = m.m23 * z + m.m33;
    precise vec2 ndc = vec2(2u * pixel + 1u) * invImageSize - 1.0;
    precise float x = (ndc.x * w - m.m20 * z - m.m30) / m.m00;
    precise float y = (ndc.y * w - m.m21 * z - m.m31) / m.m11;
    return vec3(x, y, z);
}

// Returns the direction in which the eye looks through the centre of `pixel`, not normalised.
vec3 viewRay(Projection m, uvec2 pixel, vec2 invImageSize)
{
    const vec2 ndc = vec2(2u * pixel + 1u) * invImageSize - 1.0;
    const float z = 1.0 / m.m23; // here clip.w is 1
    const vec3 through = vec3((ndc.x - m.m20 * z) / m.m00, (ndc.y - m.m21 * z) / m.m11, z);
    return m.eyeIsPoint != 0.0 ? through : -m.eye;
}

// Returns the direction from `position` to the eye, not normalised.
vec3 towardsEye(Projection m, vec3 position)
{
    return m.eye - m.eyeIsPoint * position;
}

#endif
