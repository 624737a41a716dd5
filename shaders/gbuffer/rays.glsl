// SPDX-License-Identifier: Apache-2.0
// Rays through pixel centres in view space, and the depth of what they hit.
#ifndef CND_GBUFFER_RAYS
#define CND_GBUFFER_RAYS

#include "shared/raster.h"

layout(scalar, binding = RAY_FRAME) uniform Frame
{
    RasterFrame frame;
};

struct Ray {
    vec3 origin;
    vec3 direction; // unit
};

// Returns the pixel centre in normalised device coordinates; the numerator is exact.
vec2 pixelNdc(vec2 fragCoord)
{
    return (2.0 * fragCoord - frame.size) / frame.size;
}

Ray pixelRay(vec2 ndc)
{
    Ray ray;
    ray.origin = frame.rayOrigin[0] + ndc.x * frame.rayOrigin[1] + ndc.y * frame.rayOrigin[2];
    ray.direction = normalize(frame.rayDirection[0] + ndc.x * frame.rayDirection[1] +
                              ndc.y * frame.rayDirection[2]);
    return ray;
}

// Returns the depth of the far end, to which depth is cleared.
float farDepth()
{
    return 1.0 - frame.nearDepth;
}

float depthOf(vec3 positionView)
{
    const vec4 clip = frame.clipFromView * vec4(positionView, 1.0);
    return clip.z / clip.w;
}

// Intersection of a ray with a sphere. The squared distance from the axis is computed from the
// perpendicular vector, and the near root as power / (sum of two positive terms): neither cancels for
// small far spheres nor for a camera close to a large one (Haines et al. 2019, "Precision improvements
// for ray/sphere intersection").
struct SphereHit {
    bool hit;
    float near, far; // distances along the ray; in perspective a negative one is behind the camera
    vec3 normal; // at distance `near`, pointing outwards
};

// `power` = |center - rayOrigin[0]|^2 - radius^2, for the ray through the middle of the screen. It is a
// parameter because the caller may know it in higher precision.
SphereHit intersectSphere(Ray ray, vec3 center, float radius, float power)
{
    const vec3 toCenter = center - ray.origin;
    const float along = dot(toCenter, ray.direction);
    const vec3 across = toCenter - along * ray.direction;
    const float distanceToAxis = length(across);
    const float halfChord = sqrt(max((radius - distanceToAxis) * (radius + distanceToAxis), 0.0));
    // The power of this ray's origin; in perspective all rays share one origin.
    const vec3 shift = ray.origin - frame.rayOrigin[0];
    const float rayPower = power - dot(2.0 * (center - frame.rayOrigin[0]) - shift, shift);
    SphereHit s;
    s.hit = distanceToAxis <= radius;
    s.far = along + halfChord;
    s.near = along > 0.0 ? rayPower / s.far : along - halfChord;
    s.normal = normalize(-across - halfChord * ray.direction);
    return s;
}

#endif
