// SPDX-License-Identifier: Apache-2.0
// What the host's depth image holds, as depth under the frame's projection. For linear depths and
// positions, surfaces/projection.h chooses the depth part of that projection.
#ifndef CND_COMMON_STORED_DEPTH
#define CND_COMMON_STORED_DEPTH

#include "shared/host_gbuffer_data.h"
#include "kernels/common/frame_params.glsl"
#include "kernels/common/gbuffer_code.glsl"

const uint depthKind = (gbufferCode >> GBUFFER_DEPTH_KIND_SHIFT) & GBUFFER_DEPTH_KIND_MASK;

// Tells whether a texel of the host's depth image is of a pixel with a surface.
bool storesSurface(StoredDepth stored, vec4 texel)
{
    if (depthKind == DEPTH_PROJECTED)
        return texel.x != frameParams.clearDepth;
    return (depthKind == DEPTH_LINEAR ? texel.x : texel.a) != stored.clear;
}

// Returns the depth of a texel for which storesSurface() is true. If its position is not in front of
// the eye, or not finite, the result is not the depth of any visible surface.
float projectedDepth(StoredDepth stored, vec4 texel)
{
    if (depthKind == DEPTH_PROJECTED)
        return texel.x;
    const float z = depthKind == DEPTH_LINEAR ? stored.z.x * abs(texel.x)
                                              : dot(stored.z, vec4(texel.xyz, 1.0));
    const Projection m = frameParams.projection;
    return (m.m22 * z + m.m32) / (m.m23 * z + m.m33);
}

// Returns the depth of a texel, or clearDepth where the eye sees no surface.
float visibleDepth(StoredDepth stored, vec4 texel)
{
    if (depthKind == DEPTH_PROJECTED)
        return texel.x;
    const float depth = projectedDepth(stored, texel);
    // In orthographic views depth is 1 at the far plane. In perspective views it has no upper end. NaN
    // and infinity are found by their bits, because comparisons may be compiled as if there were none.
    const float end = frameParams.projection.eyeIsPoint != 0.0 ? 1e30 : 1.0;
    const bool visible = floatBitsToUint(depth) <= floatBitsToUint(end);
    return visible && storesSurface(stored, texel) ? depth : frameParams.clearDepth;
}

#endif
