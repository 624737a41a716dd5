// SPDX-License-Identifier: Apache-2.0
// Rays through pixel centres in view space, and the depth of what they hit. Planes and balls are stored
// with the same bits on every device (engine/DECISIONS.md, 45), so all arithmetic here is `precise` and
// made of the functions of portable_math.glsl.
#ifndef CND_GBUFFER_RAYS
#define CND_GBUFFER_RAYS

#include "lib/portable_math.glsl"
#include "shared/raster.h"

layout(scalar, binding = RAY_FRAME) uniform Frame
{
    RasterFrame frame;
};

struct Ray {
    vec3 origin;
    vec3 direction; // unit
};

// Returns the pixel centre in normalised device coordinates; the difference is exact.
vec2 pixelNdc(vec2 fragCoord)
{
    precise const vec2 ndc = (2.0 * fragCoord - frame.size) * frame.inverseSize;
    return ndc;
}

// Returns terms[0] + ndc.x terms[1] + ndc.y terms[2].
vec3 affineInNdc(vec3 terms[3], vec2 ndc)
{
    precise const vec3 sum = terms[0] + ndc.x * terms[1] + ndc.y * terms[2];
    return sum;
}

Ray pixelRay(vec2 ndc)
{
    return Ray(affineInNdc(frame.rayOrigin, ndc),
               portableNormalize(affineInNdc(frame.rayDirection, ndc)));
}

// Returns the depth of the far end, to which depth is cleared.
float farDepth()
{
    return 1.0 - frame.nearDepth;
}

// Returns origin + t direction.
vec3 pointAt(vec3 origin, vec3 direction, float t)
{
    precise const vec3 point = origin + t * direction;
    return point;
}

float depthOf(vec3 positionView)
{
    const mat4 m = frame.clipFromView;
    precise const vec4 clip =
        m[0] * positionView.x + m[1] * positionView.y + m[2] * positionView.z + m[3];
    precise const float depth = clip.z * portableReciprocal(clip.w);
    return depth;
}

// Intersection of a ray with a sphere. The squared distance from the axis is computed from the
// perpendicular vector, and the near root as power / (sum of two positive terms): neither cancels for
// small far spheres nor for a camera close to a large one (Haines et al. 2019, "Precision improvements
// for ray/sphere intersection").
struct SphereHit {
    bool hit;
    float near, far; // distances along the ray; in perspective a negative one is behind the camera
    vec3 normal; // at distance `near`, pointing outwards; as long as the radius
};

// `power` = |center - rayOrigin[0]|^2 - radius^2, for the ray through the middle of the screen. It is a
// parameter because the caller may know it in higher precision.
SphereHit intersectSphere(Ray ray, vec3 center, float radius, float power)
{
    precise const vec3 toCenter = center - ray.origin;
    precise const float along = portableDot(toCenter, ray.direction);
    precise const vec3 across = toCenter - along * ray.direction;
    precise const float distanceToAxis = portableSqrt(portableDot(across, across));
    precise const float square = (radius - distanceToAxis) * (radius + distanceToAxis);
    precise const float halfChord = portableSqrt(max(square, 0.0));
    // The power of this ray's origin; in perspective all rays share one origin.
    precise const vec3 shift = ray.origin - frame.rayOrigin[0];
    precise const vec3 toMean = 2.0 * (center - frame.rayOrigin[0]) - shift;
    precise const float rayPower = power - portableDot(toMean, shift);
    precise const float far = along + halfChord;
    precise const float nearInFront = rayPower * portableReciprocal(far);
    precise const float nearBehind = along - halfChord;
    precise const vec3 normal = -across - halfChord * ray.direction;
    return SphereHit(distanceToAxis <= radius, along > 0.0 ? nearInFront : nearBehind, far, normal);
}

#endif
