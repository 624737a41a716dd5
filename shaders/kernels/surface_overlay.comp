// SPDX-License-Identifier: Apache-2.0
// Shows the surfaces that are read from the G-buffer, and marks faulty values.
#version 460
#extension GL_GOOGLE_include_directive : require
#include "shared/surface_overlay.h"
#include "kernels/common/read_gbuffer.glsl"
#include "kernels/common/stored_depth.glsl"
#include "lib/projection.glsl"
#include "lib/tone_map.glsl"

layout(local_size_x = SURFACE_OVERLAY_GROUP, local_size_y = SURFACE_OVERLAY_GROUP) in;
layout(push_constant, scalar) uniform Push
{
    SurfaceOverlayParams params;
};
layout(binding = SHADE_DEPTH) uniform texture2D depthImage;
layout(binding = SURFACE_OVERLAY_IMAGE, rgba8) uniform writeonly image2D overlayImage;

// Tests the bits, because isnan() and isinf() may be compiled to false.
bool isFinite(vec4 x)
{
    return all(lessThan(floatBitsToUint(x) & 0x7FFFFFFFu, uvec4(0x7F800000u)));
}

bool isOutside(vec4 x)
{
    const float margin = SURFACE_RANGE_TOLERANCE;
    return any(lessThan(x, vec4(-margin))) || any(greaterThan(x, vec4(1.0 + margin)));
}

// Returns the normal as it is stored. Only a layout of the host can store normals whose length is not
// 1.
vec3 normalBeforeReading(HostTexels t, vec3 normal)
{
    return gbufferLayout == GBUFFER_LAYOUT_HOST ? storedNormal(t.normal) : normal;
}

float roughnessBeforeReading(HostTexels t, float perceptualRoughness)
{
    return gbufferLayout == GBUFFER_LAYOUT_HOST ? storedRoughness(t) : perceptualRoughness;
}

// Returns the colour of the first fault that is found, or a shade of grey if there is none.
vec3 faults(Surface s, HostTexels t, vec3 position)
{
    const vec3 view = normalize(towardsEye(frameParams.projection, position));
    const float facing = dot(s.normal, view);
    const vec3 stored = normalBeforeReading(t, s.normal);
    const float rough = roughnessBeforeReading(t, s.perceptualRoughness);
    const vec4 reflected = vec4(s.albedo, s.specularWeight);
    if (!isFinite(vec4(stored, rough)) || !isFinite(reflected) || !isFinite(vec4(s.F0, 0.0)))
        return vec3(1.0, 0.0, 1.0);
    // The projection decides whether the eye looks along -z or +z.
    const vec3 ahead = viewRay(frameParams.projection, frameParams.size / 2u, frameParams.invImageSize);
    const bool inFront = frameParams.projection.eyeIsPoint == 0.0 || dot(position, ahead) > 0.0;
    if (!inFront || !isFinite(vec4(position, 0.0)))
        return vec3(0.0, 0.0, 1.0);
    if (abs(length(stored) - 1.0) > SURFACE_LENGTH_TOLERANCE)
        return vec3(1.0, 1.0, 0.0);
    if (facing < -SURFACE_FACING_TOLERANCE)
        return vec3(1.0, 0.0, 0.0);
    if (isOutside(vec4(rough)))
        return vec3(0.0, 1.0, 1.0);
    if (isOutside(reflected) || isOutside(vec4(s.F0, 0.0)))
        return vec3(1.0, 0.5, 0.0);
    return vec3(0.5 * max(facing, 0.0));
}

// Returns a quantity at a pixel as a display colour.
vec3 quantityAt(uint quantity, uvec2 pixel)
{
    const vec4 texel = texelFetch(depthImage, texelOf(pixel), 0);
    if (!storesSurface(params.depth, texel))
        return vec3(0.0);
    const float depth = projectedDepth(params.depth, texel);
    const Surface s = readSurface(pixel);
    const vec3 position = viewPosition(frameParams.projection, pixel, frameParams.invImageSize, depth);
    switch (quantity) {
    case SURFACE_NORMAL:
        return 0.5 + 0.5 * (transpose(frameParams.viewFromWorld) * s.normal);
    case SURFACE_ROUGHNESS:
        return vec3(s.perceptualRoughness);
    case SURFACE_ALBEDO:
        return encodeSrgb(s.albedo);
    case SURFACE_F0:
        return encodeSrgb(s.F0);
    case SURFACE_POSITION: {
        const vec3 world = transpose(frameParams.viewFromWorld) * position + params.eyeWorld;
        return abs(fract(world / SURFACE_PERIOD) * 2.0 - 1.0);
    }
    default:
        return faults(s, readHostTexels(texelOf(pixel)), position);
    }
}

void main()
{
    const uvec2 at = gl_GlobalInvocationID.xy;
    if (any(greaterThanEqual(at, frameParams.size)))
        return;
    uint quantity = params.quantity;
    uvec2 pixel = at;
    if (quantity == SURFACE_ALL) {
        const uvec2 panels = uvec2(SURFACE_COLUMNS, SURFACE_ROWS);
        const uvec2 panel = at * panels / frameParams.size;
        const uvec2 first = (panel * frameParams.size + panels - 1u) / panels;
        quantity = SURFACE_NORMAL + panel.y * SURFACE_COLUMNS + panel.x;
        pixel = min((at - first) * panels, frameParams.size - 1u);
    }
    imageStore(overlayImage, texelOf(at), vec4(quantityAt(quantity, pixel), 1.0));
}
