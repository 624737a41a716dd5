// SPDX-License-Identifier: Apache-2.0
// The facet of a light of any type.
#ifndef CND_LIB_VISIBILITY_LIGHT_FACET
#define CND_LIB_VISIBILITY_LIGHT_FACET

#include "lib/visibility/facet.glsl"
#include "lib/visibility/tube_facet.glsl"
#include "shared/lighting_data.h"

// toLight: from the receiver to the centre in metres; distant types: unit direction. boundingRadius and
// shape as kernels read them. A polygon is given by the smallest rectangle around it: toLight leads to
// the centre of the rectangle, shape has its half axes, and the caller removes from Facet::members what
// lies outside the polygon.
Facet lightFacet(uint count, uint type, vec3 toLight, float boundingRadius, LightShape shape,
                 mat3 viewFromWorld)
{
    if (type == LIGHT_SPHERE)
        return sphereFacet(count, toLight, boundingRadius, viewFromWorld);
    if (type == LIGHT_DISTANT_SPHERE)
        return distantSphereFacet(count, toLight, boundingRadius, viewFromWorld);
    if (type == LIGHT_DIRECTIONAL)
        return directionalFacet(toLight, viewFromWorld);
    if (type == LIGHT_TUBE)
        return tubeFacet(count, toLight, shape.axisU, shape.radius);
    if (type == LIGHT_DISC)
        return discFacet(count, toLight, shape.axisU, shape.radius, viewFromWorld);
    if (type == LIGHT_RECTANGLE || type == LIGHT_POLYGON)
        return rectangleFacet(count, toLight, shape.axisU, shape.axisV);
    return pointFacet(toLight, viewFromWorld);
}

#endif
