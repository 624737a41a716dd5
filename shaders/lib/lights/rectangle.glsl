// SPDX-License-Identifier: Apache-2.0
// Diffuse of a rectangle light: its exact form factor.
#ifndef CND_LIB_LIGHTS_RECTANGLE
#define CND_LIB_LIGHTS_RECTANGLE

#include "lib/contour.glsl"

// Whether the point sees the side that emits. axisU and axisV go from the centre to the middle of two
// edges; the rectangle faces their cross product.
bool facesRectangle(vec3 toCentre, vec3 axisU, vec3 axisV, bool twoSided)
{
    return twoSided || dot(cross(axisU, axisV), toCentre) < 0.0;
}

// Form factor F = E / (pi L), 0..1; centre relative to the point. In the plane of the rectangle it is
// 0 outside the rectangle; on its surface it is finite, and whatever rounding says.
float rectangleFormFactor(vec3 n, vec3 toCentre, vec3 axisU, vec3 axisV, bool twoSided)
{
    const float f = parallelogramFormFactor(n, toCentre, axisU, axisV);
    return facesRectangle(toCentre, axisU, axisV, twoSided) ? f : 0.0;
}

#endif
