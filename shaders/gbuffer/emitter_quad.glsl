// SPDX-License-Identifier: Apache-2.0
// The quad that covers the projection of a visible area light. It is perpendicular to the line of sight
// to the bounding sphere, as large as the tangent cone, at unit distance (only directions matter). Seen
// from inside that sphere or from very close it is the whole screen.
#ifndef CND_GBUFFER_EMITTER_QUAD
#define CND_GBUFFER_EMITTER_QUAD

#include "gbuffer/rays.glsl"

// View space.
struct EmitterQuad {
    vec3 middle;
    vec3 u, v; // unit, along its sides
    float halfSide;
    bool fillsScreen;
};

// Angular rounding error of the quad and of pixel rays, with a safety factor of about 50.
const float QUAD_MARGIN = 1e-5;
// Rasterisation moves every corner to a grid of at least 2^4 steps per pixel, by half a step along x
// and y. So an edge of the quad moves by less than this share of a pixel.
const float QUAD_GRID = 1.0 / 16.0;

bool isDistantEmitter(uint shape)
{
    return (TYPES_WITH_POSITION >> shape & 1u) == 0u;
}

// Returns the radius of a sphere around the centre that holds the light: half the longer diagonal of
// the rectangle of its axes, which need not be exactly perpendicular, and its radius.
// (cndEmitterBoundingRadius takes the axes to be perpendicular.)
float emitterBoundingRadius(uint shape, vec3 axisU, vec3 axisV, float radius)
{
    const vec3 u = (TYPES_WITH_AXIS_U >> shape & 1u) != 0u ? axisU : vec3(0.0);
    const vec3 v = (TYPES_WITH_AXIS_V >> shape & 1u) != 0u ? axisV : vec3(0.0);
    const float ownRadius = (TYPES_WITH_RADIUS >> shape & 1u) != 0u ? radius : 0.0;
    return max(length(u + v), length(u - v)) + ownRadius;
}

// Returns the longer side of a pixel: at unit distance, or in metres if the view is orthographic.
float pixelSide(bool perspective)
{
    const vec3 alongX = perspective ? frame.rayDirection[1] : frame.rayOrigin[1];
    const vec3 alongY = perspective ? frame.rayDirection[2] : frame.rayOrigin[2];
    const vec2 sides = 2.0 * vec2(length(alongX), length(alongY)) / frame.size; // ndc is 2 wide
    const float depth = perspective ? dot(frame.rayDirection[0], frame.forward) : 1.0;
    return max(sides.x, sides.y) / depth;
}

// `position` as in EmitterRecord. Returns it in view space.
vec3 emitterCenter(uint shape, vec3 position)
{
    const vec3 rotated = frame.viewFromWorld * position;
    return isDistantEmitter(shape) ? rotated : frame.emitterOrigin + rotated;
}

EmitterQuad emitterQuad(uint shape, vec3 center, float boundingRadius)
{
    const bool distant = isDistantEmitter(shape);
    const bool perspective = frame.perspective > 0.5;
    const vec3 toCenter = distant ? center : center - frame.rayOrigin[0]; // seen from the eye
    const float distanceToCenter = length(toCenter);
    const float sinCone = boundingRadius / distanceToCenter;
    const vec3 axis = perspective ? toCenter / distanceToCenter : frame.forward;
    // Duff et al. 2017, "Building an orthonormal basis, revisited".
    const float s = axis.z >= 0.0 ? 1.0 : -1.0;
    const float a = -1.0 / (s + axis.z);
    const float b = axis.x * axis.y * a;

    const float tanCone = sinCone / sqrt(max(1.0 - sinCone * sinCone, 1e-6));
    // A step of the grid is longer at the edge of the quad, which is seen at an angle.
    const float moved =
        QUAD_GRID * pixelSide(perspective) * (perspective ? 1.0 + tanCone * tanCone : 1.0);

    EmitterQuad quad;
    quad.middle = perspective ? frame.rayOrigin[0] + axis : center;
    quad.u = vec3(1.0 + s * axis.x * axis.x * a, s * b, -s * axis.x);
    quad.v = vec3(b, s + axis.y * axis.y * a, -axis.y);
    quad.halfSide = moved + (perspective ? tanCone * (1.0 + QUAD_MARGIN) + QUAD_MARGIN
                                         : boundingRadius +
                                               QUAD_MARGIN * (boundingRadius + distanceToCenter));
    // Larger quads than tan(cone) = 7 lose precision. In orthographic views all rays look at one point
    // of the sky.
    quad.fillsScreen = perspective ? !(sinCone < 0.99) : distant;
    return quad;
}

// Returns a corner in view space; x and y of `corner` are 1 or -1.
vec3 quadCorner(EmitterQuad quad, vec2 corner)
{
    return quad.middle + quad.halfSide * (corner.x * quad.u + corner.y * quad.v);
}

#endif
