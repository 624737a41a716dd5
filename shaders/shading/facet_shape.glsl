// SPDX-License-Identifier: Apache-2.0
// The lights as shadows see them. The includer provides lightShapes[].
#ifndef CND_SHADING_FACET_SHAPE
#define CND_SHADING_FACET_SHAPE

#include "lib/light_shape.glsl"
#include "shared/occluder_data.h"

// What stands for a light where shadows are found (lightFacet).
struct FacetShape {
    vec3 centre;      // relative to the light's, in view space, m
    LightShape shape; // flags: as in LightRecord
    uvec2 members;    // the points that belong to the light
};

// polygon_facets has written the facet of a polygon between its corners.
FacetShape polygonFacetShape(LightShape polygon)
{
    const uint at = firstCornerShape(polygon);
    FacetShape f;
    f.centre =
        vec3(lightShapes[at].radius, lightShapes[at + 1u].radius, lightShapes[at + 2u].radius);
    f.shape.axisU =
        vec3(lightShapes[at + 3u].radius, lightShapes[at + 4u].radius, lightShapes[at + 5u].radius);
    f.shape.axisV = vec3(lightShapes[at + 6u].radius, uintBitsToFloat(lightShapes[at + 3u].flags),
                         uintBitsToFloat(lightShapes[at + 4u].flags));
    f.shape.radius = 0.0;
    f.members = uvec2(lightShapes[at + 1u].flags, lightShapes[at + 2u].flags);
    f.shape.flags = lightShapes[at].flags;
    return f;
}

FacetShape facetShape(uint light, uint type)
{
    const LightShape shape = lightShapes[light];
    if (type == LIGHT_POLYGON)
        return polygonFacetShape(shape);
    return FacetShape(vec3(0.0), shape, uvec2(0xFFFFFFFFu));
}

// Returns the occluder layers that do not shadow a light with these flags, as in
// OccluderRecord::flags.
uint ignoredLayers(uint flags)
{
    const uint layers = flags >> LIGHT_UNSHADOWED_BY_SHIFT & ((1u << OCCLUDER_LAYER_COUNT) - 1u);
    return layers << OCCLUDER_LAYERS_SHIFT;
}

#endif
