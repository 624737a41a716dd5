// SPDX-License-Identifier: Apache-2.0
// Diffuse lighting by a rectangle light: its exact form factor.
#ifndef CND_LIB_LIGHTS_RECTANGLE
#define CND_LIB_LIGHTS_RECTANGLE

#include "lib/contour.glsl"

// Tells whether the point sees a side that emits. axisU and axisV go from the centre to the middles of
// two edges; the rectangle faces the direction of their cross product.
bool facesRectangle(vec3 toCentre, vec3 axisU, vec3 axisV, bool twoSided)
{
    return twoSided || dot(cross(axisU, axisV), toCentre) < 0.0;
}

// Returns the form factor F = E / (pi L), 0..1. `toCentre`: the centre relative to the point. It is 0
// at points of the rectangle's plane outside the rectangle. At points of the rectangle itself it is
// finite, but its value depends on rounding.
float rectangleFormFactor(vec3 n, vec3 toCentre, vec3 axisU, vec3 axisV, bool twoSided)
{
    const float f = parallelogramFormFactor(n, toCentre, axisU, axisV);
    return facesRectangle(toCentre, axisU, axisV, twoSided) ? f : 0.0;
}

#endif
