// SPDX-License-Identifier: Apache-2.0
// Test-only: the points of a light that a sheet of triangles hides from a receiver (lib/visibility).
#version 460
#extension GL_GOOGLE_include_directive : require
#include "shared/probes.h"
#include "shared/visibility_probe.h"

layout(local_size_x = PROBE_GROUP) in;
layout(push_constant, scalar) uniform Push
{
    ProbeParams params;
};
layout(scalar, binding = PROBE_INPUT) readonly buffer Input
{
    VisibilityProbeInput inputs[];
};
layout(scalar, binding = PROBE_OUTPUT) writeonly buffer Output
{
    VisibilityProbeOutput outputs[];
};
layout(scalar, binding = VISIBILITY_PROBE_TABLE) readonly buffer Table
{
    uvec2 table[];
};
layout(constant_id = VISIBILITY_PROBE_POINTS) const uint pointCount = 64u;

uvec2 pointTable(uint i)
{
    return table[i];
}

#include "lib/visibility/box_tests.glsl"
#include "lib/visibility/light_facet.glsl"
#include "lib/visibility/triangle_points.glsl"
#include "lib/visibility/visible_shares.glsl"

// Returns vertex k of a triangle of the sheet, minus the receiver's position.
vec3 sheetVertex(uint pair, uint triangle, uint k)
{
    const uint cell = triangle >> 1u;
    // The corners 0, 1, 3 and 0, 3, 2 of the cell.
    const uint corner = k == 0u ? 0u : (triangle & 1u) == 0u ? 2u * k - 1u : 4u - k;
    const uint column = cell % SHEET_CELLS + (corner & 1u);
    const uint row = cell / SHEET_CELLS + (corner >> 1u);
    return inputs[pair].vertices[row * (SHEET_CELLS + 1u) + column] - inputs[pair].localPosition;
}

struct Walk {
    Facet facet;
    LightCoordinates local;
    float ownDistance;
};

uvec2 pointsHiddenBy(Walk w, uint pair, uint triangle, uvec2 lit)
{
    uint turns = 0u;
    return trianglePoints(pointCount, w.facet.shape, w.facet.front, w.local, inputs[pair].localFromView,
                          sheetVertex(pair, triangle, 0u), sheetVertex(pair, triangle, 1u),
                          sheetVertex(pair, triangle, 2u), w.ownDistance, lit, turns);
}

// Tests the box of the sheet: which points it may hide, and whether it is in the cone of those that
// the sheet hides.
void testBox(Walk w, uint pair, inout VisibilityProbeOutput result)
{
    vec3 low = sheetVertex(pair, 0u, 0u), high = low;
    for (uint i = 0u; i < SHEET_VERTICES; ++i) {
        const vec3 vertex = inputs[pair].vertices[i] - inputs[pair].localPosition;
        low = min(low, vertex);
        high = max(high, vertex);
    }
    const FacetVectors vectors = facetVectors(w.facet, inputs[pair].localFromView);
    const vec3 slack = vec3(BOX_SLACK * (1.0 + norm1(inputs[pair].localPosition)) +
                            roundingOf(vectors, w.local) * norm1(max(abs(low), abs(high))));
    result.inBox = boxPoints(pointCount, w.facet.shape, w.facet.front, w.local, low - slack,
                             high + slack);
    const FacetCone cone = facetCone(
        w.facet, vectors,
        isEmpty(result.hidden) ? ALL_POINTS : pointBounds(pointCount, w.facet.shape, result.hidden));
    result.touchesCone = coneTouches(cone, low - slack, high + slack) ? 1u : 0u;
}

void main()
{
    const uint i = gl_GlobalInvocationID.x;
    if (i >= params.count)
        return;
    Walk w;
    // View space is the world.
    w.facet = lightFacet(pointCount, inputs[i].type, inputs[i].toLight, inputs[i].boundingRadius,
                         inputs[i].shape, mat3(1.0));
    const LightCoordinates view = lightCoordinates(w.facet);
    w.local = inSpaceOf(view, inputs[i].viewFromLocal);
    w.ownDistance =
        ownSurfaceDistance(inputs[i].depthError, inputs[i].position, inputs[i].surfaceError,
                           inputs[i].viewFromLocal, inputs[i].localPosition);
    VisibilityProbeOutput result;
    result.members = w.facet.members;
    uvec2 lit = w.facet.members;
    for (uint k = 0u; k < 2u * SHEET_CELLS * SHEET_CELLS; ++k)
        lit &= ~pointsHiddenBy(w, i, k, lit);
    result.hidden = w.facet.members & ~lit;
    testBox(w, i, result);
    ShadingPoint p;
    p.position = inputs[i].position;
    p.n = inputs[i].n;
    p.v = inputs[i].v;
    p.alpha = inputs[i].alpha;
    deriveTerms(p);
    result.shares = visibleShares(w.facet, pointCount, lit, p);
    result.largest = abs(view.u) + abs(view.v) + abs(view.z) + abs(w.facet.centre) +
                     abs(w.facet.halfU) + abs(w.facet.halfV);
    outputs[i] = result;
}
