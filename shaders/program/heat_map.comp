// SPDX-License-Identifier: Apache-2.0
// Shows in false colours, with a legend, what the lights cost each pixel.
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

uint colourOf(vec4 pairs)
{
    const uint pixelClass = uint(pairs.w);
    if (params.which == HEAT_MAP_CLASS || pixelClass == 0u) // class 0: no surface
        return HEAT_MAP_STEPS + min(pixelClass, HEAT_MAP_CLASSES - 1u);
    const float lights = params.which == HEAT_MAP_LISTED ? pairs.x : pairs.y;
    const float place = params.which == HEAT_MAP_EFFICIENCY
                            ? pairs.z / max(pairs.x, 1.0)
                            : log(1.0 + lights) / log(1.0 + HEAT_MAP_MOST);
    return uint(clamp(place, 0.0, 1.0) * float(HEAT_MAP_STEPS - 1u) + 0.5);
}

// The colour of a class or, after the classes, of a pixel of the legend.
vec4 classColour(uint index)
{
    return unpackUnorm4x8(colours[HEAT_MAP_STEPS + index]);
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
    const uvec2 pixel = gl_GlobalInvocationID.xy;
    if (any(greaterThanEqual(pixel, params.size)))
        return;
    const vec4 pairs = imageLoad(pairImage, ivec2(pixel));
    const uint fromBottom = params.size.y - 1u - pixel.y;
    vec4 colour;
    if (pixel.x < params.legendSize.x && fromBottom < params.legendSize.y)
        colour = classColour(HEAT_MAP_CLASSES +
                             (params.legendSize.y - 1u - fromBottom) * params.legendSize.x + pixel.x);
    else if (params.which == HEAT_MAP_SHADOW)
        colour = shadowColour(pairs);
    else
        colour = unpackUnorm4x8(colours[colourOf(pairs)]);
    imageStore(displayImage, ivec2(pixel), colour);
}
