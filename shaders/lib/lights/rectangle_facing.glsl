// SPDX-License-Identifier: Apache-2.0
// Which side of a rectangle light a point sees.
#ifndef CND_LIB_LIGHTS_RECTANGLE_FACING
#define CND_LIB_LIGHTS_RECTANGLE_FACING

#include "lib/math.glsl"

// Tells whether the point sees a side that emits. axisU and axisV go from the centre to the middles of
// two edges; the rectangle faces the direction of their cross product.
bool facesRectangle(vec3 toCentre, vec3 axisU, vec3 axisV, bool twoSided)
{
    return twoSided || dot(cross(axisU, axisV), toCentre) < 0.0;
}

#endif
