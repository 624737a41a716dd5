// SPDX-License-Identifier: Apache-2.0
// Facets: flat pieces that stand for light sources where shadows are found. A receiver tests whether
// it sees certain points of the facet (facet_points.glsl). Everything is relative to the receiver, in
// view space.
#ifndef CND_LIB_VISIBILITY_FACET
#define CND_LIB_VISIBILITY_FACET

#include "lib/math.glsl"
#include "lib/visibility/facet_points.glsl"

// The side of the emitter towards the receiver, which occluders must be in front of. On the way to the
// point (u, v) of the facet it lies at the share 1 / (1 + kappa g) of the way, with
//   g = sqrt(1 - v^2 - (max(0, |u| - (1 - roundEnd)) / roundEnd)^2).
struct FrontSurface {
    float inverseDistance; // 1 over the unit of the facet's vectors, 1/m; 0: the facet is at infinity
    float kappa;           // 0: the emitter is flat
    float roundEnd;        // length of a tube's round end over half the length of the facet; spheres: 1
};

// Occluders that reach the emitter up to this share of its distance do not count: the drawn surface of
// the emitter itself, or a ceiling in which a panel lies flush.
const float FRONT_SLACK = 2.44140625e-4; // 2^-12

// Occluders count up to a share of the way to a point of the facet. Returns 1 over that share.
float frontFactor(FrontSurface front, vec2 uv)
{
    const float beyond = max(0.0, abs(uv.x) - (1.0 - front.roundEnd)) / front.roundEnd;
    const float g = sqrt(max(0.0, 1.0 - uv.y * uv.y - beyond * beyond));
    return 1.0 + FRONT_SLACK + front.kappa * g;
}

// The points of the facet are centre + u halfU + v halfV, with (u, v) from facet_points.glsl. The
// vectors are scaled so that none of their products overflows: in units of 1 / front.inverseDistance
// metres, or in any unit if the facet is at infinity.
struct Facet {
    vec3 centre;
    vec3 halfU;
    vec3 halfV;
    FrontSurface front;
    uint shape;    // FACET_DISC, FACET_SQUARE or FACET_POINT
    uvec2 members; // the points that belong to the emitter; none: all of the light is visible
};

// Facets have half axes of at least this length times their distance, so that their coordinates stay
// within the range of float32.
const float MIN_FACET_SIZE = 6.103515625e-5; // 2^-14
// A facet that is seen at a lower sine of the elevation is sheared along its normal, because its light
// coordinates would not be precise. Its points move by at most twice this share of the sum of its half
// axes, to the side of its plane that the receiver is on: otherwise a wall that it lies flush in would
// hide them. (Some points of large facets nearby move to the other side.) It is seen at half of this
// sine or more. Facets of receivers on both sides of the plane differ, but light there is almost 0.
const float MIN_FACET_SLOPE = 0.015625; // 2^-6
// Bound of the distance of a flat light's points from its centre, over its bounding radius: a shear
// moves them by at most 2 sqrt(2) MIN_FACET_SLOPE times that, at a right angle to its plane.
const float SHEARED_RADIUS = 1.0 + 4.0 * MIN_FACET_SLOPE * MIN_FACET_SLOPE;
// From this squared sine of its angular radius on, a sphere is lit as if the receiver were inside.
const float MAX_FACET_SINE2 = 0.9999;

// Sets s and t so that s, t and the unit vector a are perpendicular to each other: the world's axes x
// and z, reflected by the mirror that exchanges y and -a. (Frisvad 2012, "Building an Orthonormal Basis
// from a 3D Unit Vector Without Normalization", has this frame in other words.) Points thus keep their
// places in the world when the camera turns. The frame has no seam, except where a is -y.
void worldFrame(vec3 a, mat3 viewFromWorld, out vec3 s, out vec3 t)
{
    const vec3 h = a + viewFromWorld[1];
    const vec3 k = h * (2.0 / max(dot(h, h), 1e-12));
    s = viewFromWorld[0] - dot(h, viewFromWorld[0]) * k;
    t = viewFromWorld[2] - dot(h, viewFromWorld[2]) * k;
}

// Returns the shear of a facet (MIN_FACET_SLOPE): the point at w from the centre moves along n by this
// times dot(w, toCentre). n: unit normal; toCentre: unit vector.
float shearOf(vec3 n, vec3 toCentre)
{
    const float sine = dot(n, toCentre);
    return abs(sine) < MIN_FACET_SLOPE ? sine - (sine < 0.0 ? -MIN_FACET_SLOPE : MIN_FACET_SLOPE) : 0.0;
}

// Returns a facet without kappa. u, v: unit vectors along the half axes; lengths in metres. For a facet
// at infinity, everything is relative to the length of `centre`, and the caller sets inverseDistance.
Facet makeFacet(vec3 centre, vec3 u, float lengthU, vec3 v, float lengthV, uint shape, uvec2 members)
{
    const float distance = length(centre);
    const float scale = 1.0 / max(distance + max(lengthU, lengthV), 1e-30);
    const vec3 toCentre = centre / max(distance, 1e-30), n = cross(u, v);
    Facet f;
    f.halfU = u * (max(lengthU, distance * MIN_FACET_SIZE) * scale);
    f.halfV = v * (max(lengthV, distance * MIN_FACET_SIZE) * scale);
    const vec3 shear = shearOf(n, toCentre) * n;
    const float alongU = dot(f.halfU, toCentre), alongV = dot(f.halfV, toCentre);
    f.centre = centre * scale + min(abs(alongU) + abs(alongV), 0.5 * distance * scale) * shear;
    f.halfU += alongU * shear;
    f.halfV += alongV * shear;
    f.front = FrontSurface(scale, 0.0, 1.0);
    f.shape = shape;
    // Written so that NaN and a receiver in the centre of the light are false.
    const bool seen = abs(dot(cross(f.halfU, f.halfV), f.centre)) > 0.0;
    f.members = seen ? members : uvec2(0u);
    return f;
}

// The circle that a sphere covers; exact.
Facet sphereFacet(uint count, vec3 toLight, float radius, mat3 viewFromWorld)
{
    const float distance = max(length(toLight), 1e-30);
    const float sine = radius / distance;
    const float cos2 = 1.0 - sine * sine;
    vec3 s, t;
    worldFrame(toLight / distance, viewFromWorld, s, t);
    const float r = radius * sqrt(max(cos2, 0.0));
    const uvec2 members = cos2 > 1.0 - MAX_FACET_SINE2 ? allPoints(count, FACET_DISC) : uvec2(0u);
    Facet f = makeFacet(toLight * cos2, s, r, t, r, FACET_DISC, members);
    f.front.kappa = sine;
    return f;
}

// direction: unit; sine: of the angular radius.
Facet distantSphereFacet(uint count, vec3 direction, float sine, mat3 viewFromWorld)
{
    const float cos2 = 1.0 - sine * sine;
    vec3 s, t;
    worldFrame(direction, viewFromWorld, s, t);
    const float r = sine * inversesqrt(max(cos2, 1.0 - MAX_FACET_SINE2));
    const uvec2 members = cos2 > 1.0 - MAX_FACET_SINE2 ? allPoints(count, FACET_DISC) : uvec2(0u);
    Facet f = makeFacet(direction, s, r, t, r, FACET_DISC, members);
    f.front.inverseDistance = 0.0;
    return f;
}

// Returns the facet of a point or spot light, which has only the point in its middle.
Facet pointFacet(vec3 toLight, mat3 viewFromWorld)
{
    const float distance = max(length(toLight), 1e-30);
    vec3 s, t;
    worldFrame(toLight / distance, viewFromWorld, s, t);
    const float r = distance / 1024.0;
    return makeFacet(toLight, s, r, t, r, FACET_POINT, allPoints(0u, FACET_POINT));
}

Facet directionalFacet(vec3 direction, mat3 viewFromWorld)
{
    Facet f = pointFacet(direction, viewFromWorld);
    f.front.inverseDistance = 0.0;
    return f;
}

// normal: unit. The frame of -normal keeps the seam away from discs that face downwards.
Facet discFacet(uint count, vec3 toLight, vec3 normal, float radius, mat3 viewFromWorld)
{
    vec3 s, t;
    worldFrame(-normal, viewFromWorld, s, t);
    return makeFacet(toLight, s, radius, t, radius, FACET_DISC, allPoints(count, FACET_DISC));
}

// toLight: to the centre of the rectangle; axisU, axisV: its half axes in metres.
Facet rectangleFacet(uint count, vec3 toLight, vec3 axisU, vec3 axisV)
{
    const float lengthU = length(axisU), lengthV = length(axisV);
    return makeFacet(toLight, axisU / lengthU, lengthU, axisV / lengthV, lengthV, FACET_SQUARE,
                     allPoints(count, FACET_SQUARE));
}

#endif
