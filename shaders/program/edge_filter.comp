// SPDX-License-Identifier: Apache-2.0
// Smooths the edges of a display image. The method is that of Timothy Lottes, "FXAA" (NVIDIA white
// paper, 2009): where the luma of a pixel differs enough from that of its neighbours, the direction of
// the edge is found, then both ends of the straight piece of it. The distance to the nearer end tells
// which share of the pixel the surface on the other side would cover if the edge were not a staircase.
// All other pixels keep their bits. Unlike there, colours are mixed as linear light, and no texture
// unit interpolates, so that the image does not depend on how precisely a device does so.
#version 460
#extension GL_GOOGLE_include_directive : require
#extension GL_EXT_samplerless_texture_functions : require
#include "lib/tone_map.glsl"
#include "shared/edge_filter.h"

layout(local_size_x = EDGE_FILTER_GROUP) in;
layout(push_constant, scalar) uniform Push
{
    EdgeFilterParams params;
};
layout(binding = EDGE_FILTER_INPUT) uniform texture2D inputImage;
layout(binding = EDGE_FILTER_OUTPUT, rgba8) uniform writeonly image2D outputImage;

// An edge is where luma differs by this share of the largest luma around, and by this much.
const float LEAST_CONTRAST = 0.125;
const float LEAST_DIFFERENCE = 0.04;
// The distance up to which the ends of an edge are searched, in pixels.
const int REACH = 12;
// The largest share of its neighbour that a pixel gets because it differs from all its neighbours, as
// pixels of surfaces do that are thinner than a pixel.
const float MOST_THIN = 0.75;

vec3 colourAt(ivec2 at)
{
    return texelFetch(inputImage, clamp(at, ivec2(0), ivec2(params.size) - 1), 0).rgb;
}

// Luma of ITU-R BT.601, of encoded values.
float lumaOf(vec3 encoded)
{
    return dot(encoded, vec3(0.299, 0.587, 0.114));
}

// The lumas of a pixel and of its neighbours at the left (x) and at the right (z).
vec3 lumasOf(ivec2 at, vec3 colour)
{
    return vec3(lumaOf(colourAt(at - ivec2(1, 0))), lumaOf(colour),
                lumaOf(colourAt(at + ivec2(1, 0))));
}

// Follows an edge between a pixel and its neighbour `across` in steps of one pixel. It continues while
// the mean luma of the two sides differs from `mean` by less than `change`. Returns the number of steps
// to the first pixel that is no longer part of the edge. `difference` receives by how much the mean
// luma at that pixel differs from `mean`.
int followEdge(ivec2 at, ivec2 along, ivec2 across, float mean, float change, out float difference)
{
    int steps = 0;
    do {
        at += along;
        ++steps;
        difference = 0.5 * (lumaOf(colourAt(at)) + lumaOf(colourAt(at + across))) - mean;
    } while (abs(difference) < change && steps < REACH);
    return steps;
}

// Returns the share that the neighbour `across` of a pixel has in it, if a straight edge between both
// explains the staircase around.
float shareAcross(ivec2 at, ivec2 across, float here, float there)
{
    const ivec2 along = abs(across.yx);
    const float mean = 0.5 * (here + there);
    const float change = 0.25 * abs(here - there);
    float before, after;
    const int back = followEdge(at, -along, across, mean, change, before);
    const int on = followEdge(at, along, across, mean, change, after);
    // The true edge crosses the line between this row of pixels and the neighbour's in the middle of
    // the straight piece. In one half of the piece the neighbour's surface reaches into this row, in
    // the other half this row's surface reaches into the neighbour's. The first half is the one at
    // whose end the mean luma turns to that of the neighbour. Only there does the pixel get a share.
    const float end = back < on ? before : after;
    const float nearer = float(min(back, on)) - 0.5;
    const float length = float(back + on) - 1.0;
    return (end < 0.0) != (here < mean) ? 0.5 - nearer / length : 0.0;
}

// Returns the filtered colour of a pixel that differs enough from its neighbours. The rows have the
// lumas of the nine pixels around.
vec3 filtered(ivec2 at, vec3 colour, vec3 above, vec3 here, vec3 below, float range)
{
    // Second differences across the rows and across the columns.
    const vec3 acrossRows = abs(above + below - 2.0 * here);
    const vec3 sides = vec3(above.x, here.x, below.x) + vec3(above.z, here.z, below.z);
    const vec3 acrossColumns = abs(sides - 2.0 * vec3(above.y, here.y, below.y));
    const vec3 weights = vec3(1.0, 2.0, 1.0);
    const bool horizontal = dot(acrossRows, weights) >= dot(acrossColumns, weights);
    const float first = horizontal ? above.y : here.x;
    const float second = horizontal ? below.y : here.z;
    const bool isFirst = abs(first - here.y) >= abs(second - here.y);
    const ivec2 across = (isFirst ? -1 : 1) * (horizontal ? ivec2(0, 1) : ivec2(1, 0));

    const float around = (2.0 * (above.y + below.y + here.x + here.z) + above.x + above.z + below.x +
                          below.z) / 12.0;
    const float thin = smoothstep(0.0, 1.0, abs(around - here.y) / range);
    const float share = max(shareAcross(at, across, here.y, isFirst ? first : second),
                            MOST_THIN * thin * thin);
    const vec3 light = mix(decodeSrgb(colour), decodeSrgb(colourAt(at + across)), share);
    return quantize(encodeSrgb(light), 255.0) / 255.0;
}

void main()
{
    ivec2 at = ivec2(gl_GlobalInvocationID.x, gl_WorkGroupID.y * EDGE_FILTER_ROWS);
    if (any(greaterThanEqual(at, ivec2(params.size))))
        return;
    const int end = min(at.y + int(EDGE_FILTER_ROWS), int(params.size.y));
    vec3 above = lumasOf(at - ivec2(0, 1), colourAt(at - ivec2(0, 1)));
    vec3 colour = colourAt(at);
    vec3 here = lumasOf(at, colour);
    do {
        const vec3 colourBelow = colourAt(at + ivec2(0, 1));
        const vec3 below = lumasOf(at + ivec2(0, 1), colourBelow);
        const float least = min(min(min(above.y, below.y), min(here.x, here.z)), here.y);
        const float most = max(max(max(above.y, below.y), max(here.x, here.z)), here.y);
        vec3 result = colour;
        if (most - least > max(LEAST_DIFFERENCE, LEAST_CONTRAST * most))
            result = filtered(at, colour, above, here, below, most - least);
        imageStore(outputImage, at, vec4(result, 1.0));
        above = here;
        here = below;
        colour = colourBelow;
        ++at.y;
    } while (at.y < end);
}
