// SPDX-License-Identifier: Apache-2.0
// The meaning of a LightShape's members for the types that use them in a special way.
#ifndef CND_LIB_LIGHT_SHAPE
#define CND_LIB_LIGHT_SHAPE

#include "lib/math.glsl"
#include "shared/lighting_data.h"

bool isTwoSided(LightShape shape)
{
    return (shape.flags & LIGHT_TWO_SIDED) != 0u;
}

// Returns the factor that multiplies the intensity of a spot light in a unit direction: the square of
// (cos(theta) - cos(outer)) / (cos(inner) - cos(outer)), KHR_lights_punctual, "Inner and Outer Cone
// Angles". theta is the angle between axis and direction. Their distance c has c^2 = 2 - 2 cos(theta),
// and unlike the cosine it keeps its digits in narrow cones.
float coneAttenuation(LightShape spot, vec3 direction)
{
    const vec3 chord = direction - spot.axisU;
    const float t = saturate((spot.axisV.x - dot(chord, chord)) * spot.axisV.y);
    return t * t;
}

uint cornerCount(LightShape polygon)
{
    return uint(polygon.radius);
}

uint firstCornerShape(LightShape polygon)
{
    return polygon.flags & ~LIGHT_TWO_SIDED;
}

// Returns one of the CORNER_SHAPES shapes that hold the corners of a polygon with these axes.
LightShape shapeOfCorners(PolygonRecord polygon, uint which, vec3 axisU, vec3 axisV)
{
    const vec2 first = polygon.corners[2u * which], second = polygon.corners[2u * which + 1u];
    return LightShape(first.x * axisU + first.y * axisV, 0.0, second.x * axisU + second.y * axisV, 0u);
}

// Returns the shape of a light of this type, in the coordinates of its record.
LightShape shapeOfRecord(LightRecord record, uint type)
{
    const uint withRadiusInAxisV = TYPES_WITH_RADIUS & TYPES_WITH_AXIS_U & ~TYPES_WITH_AXIS_V;
    const bool inAxisV = (withRadiusInAxisV >> type & 1u) != 0u;
    return LightShape(record.axisU, inAxisV ? record.axisV.x : record.boundingRadius, record.axisV,
                      record.flags);
}

// Returns the shape after a rotation.
LightShape rotatedShape(LightShape shape, uint type, mat3 rotation)
{
    shape.axisU = rotation * shape.axisU;
    if ((TYPES_WITH_CONE >> type & 1u) == 0u)
        shape.axisV = rotation * shape.axisV;
    return shape;
}

#endif
