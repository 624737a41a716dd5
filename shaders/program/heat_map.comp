// SPDX-License-Identifier: Apache-2.0
// Shows in false colours, with a legend, what the lights cost each pixel. Maps of light counts end at
// the smallest scale that holds 99% of the pixels with a surface, so a few extreme pixels do not
// darken the rest.
#version 460
#extension GL_GOOGLE_include_directive : require
#include "shared/heat_map.h"

layout(local_size_x = HEAT_MAP_GROUP, local_size_y = HEAT_MAP_GROUP) in;
layout(push_constant, scalar) uniform Push
{
    HeatMapParams params;
};
layout(binding = HEAT_MAP_PAIRS, rgba32f) uniform readonly image2D pairImage;
layout(binding = HEAT_MAP_DISPLAY, rgba8) uniform writeonly image2D displayImage;
layout(scalar, binding = HEAT_MAP_COLOURS) readonly buffer Colours
{
    uint colours[];
};
layout(scalar, binding = HEAT_MAP_COUNTS) buffer Counts
{
    uint counts[HEAT_MAP_SCALES];
};

bool countsLights()
{
    return params.which == HEAT_MAP_LISTED || params.which == HEAT_MAP_EVALUATED;
}

float lightsOf(vec4 pairs)
{
    return params.which == HEAT_MAP_LISTED ? pairs.x : pairs.y;
}

// The number of lights at the end of a scale.
float scaleEnd(uint scale)
{
    return float(colours[HEAT_MAP_STEPS + HEAT_MAP_CLASSES + scale]);
}

void count(vec4 pairs)
{
    if (pairs.w == 0.0) // no surface
        return;
    uint scale = 0u;
    while (scale + 1u < HEAT_MAP_SCALES && lightsOf(pairs) > scaleEnd(scale))
        ++scale;
    atomicAdd(counts[scale], 1u);
}

// The scale of the picture. It is 0 for maps that do not count lights.
shared uint scale;

uint scaleOfPicture()
{
    if (!countsLights())
        return 0u;
    uint all = 0u, within = 0u, found = 0u;
    for (uint i = 0u; i < HEAT_MAP_SCALES; ++i)
        all += counts[i];
    for (; found + 1u < HEAT_MAP_SCALES; ++found) {
        within += counts[found];
        if (all - within <= all / 100u)
            break;
    }
    return found;
}

uint colourOf(vec4 pairs)
{
    const uint pixelClass = uint(pairs.w);
    if (params.which == HEAT_MAP_CLASS || pixelClass == 0u) // class 0: no surface
        return HEAT_MAP_STEPS + min(pixelClass, HEAT_MAP_CLASSES - 1u);
    const float place = params.which == HEAT_MAP_EFFICIENCY ? pairs.z / max(pairs.x, 1.0)
                                                            : lightsOf(pairs) / scaleEnd(scale);
    return uint(clamp(place, 0.0, 1.0) * float(HEAT_MAP_STEPS - 1u) + 0.5);
}

vec4 classColour(uint index)
{
    return unpackUnorm4x8(colours[HEAT_MAP_STEPS + index]);
}

// The colour of the legend in a column and a row from its top.
vec4 legendColour(uint x, uint y)
{
    const uvec2 size = params.legendSize;
    return classColour(HEAT_MAP_CLASSES + HEAT_MAP_SCALES + (scale * size.y + y) * size.x + x);
}

vec4 shadowColour(vec4 shadows)
{
    const float asked = shadows.x, partly = shadows.y, dark = shadows.z;
    if (asked == 0.0)
        return classColour(0u);
    const float lit = asked - partly - dark;
    return (lit * classColour(1u) + partly * classColour(2u) + dark * classColour(3u)) / asked;
}

void main()
{
    // Each group searches once. In the dispatch that counts, the scale is not used.
    if (gl_LocalInvocationIndex == 0u && params.onlyCounts == 0u)
        scale = scaleOfPicture();
    barrier();
    const uvec2 pixel = gl_GlobalInvocationID.xy;
    if (any(greaterThanEqual(pixel, params.size)))
        return;
    const vec4 pairs = imageLoad(pairImage, ivec2(pixel));
    if (params.onlyCounts != 0u) {
        count(pairs);
        return;
    }
    const uint fromBottom = params.size.y - 1u - pixel.y;
    vec4 colour;
    if (pixel.x < params.legendSize.x && fromBottom < params.legendSize.y)
        colour = legendColour(pixel.x, params.legendSize.y - 1u - fromBottom);
    else if (params.which == HEAT_MAP_SHADOW)
        colour = shadowColour(pairs);
    else
        colour = unpackUnorm4x8(colours[colourOf(pairs)]);
    imageStore(displayImage, ivec2(pixel), colour);
}
