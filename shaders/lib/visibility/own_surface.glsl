// SPDX-License-Identifier: Apache-2.0
// How near a triangle's plane must be to count as the receiver's own surface.
#ifndef CND_LIB_VISIBILITY_OWN_SURFACE
#define CND_LIB_VISIBILITY_OWN_SURFACE

// Bound of the rounding of light coordinates and of instances' transforms in float32.
const float PLANE_SLACK = 4.76837158203125e-7; // 2^-21

// Returns the distance in metres up to which a triangle's plane counts as the receiver's own
// surface. Such a triangle does not shadow the receiver. depthError: half a step of the depth
// format, as a distance along the view ray. position: of the receiver in view space; localPosition:
// in the space of the instance. surfaceError: of the instance. viewFromLocal: linear part of its
// transform.
float ownSurfaceDistance(float depthError, vec3 position, float surfaceError, mat3 viewFromLocal,
                         vec3 localPosition)
{
    const vec3 fromOrigin = abs(localPosition);
    const float rounding = length(viewFromLocal[0]) * fromOrigin.x +
                           length(viewFromLocal[1]) * fromOrigin.y +
                           length(viewFromLocal[2]) * fromOrigin.z;
    return depthError + length(position) * 3.814697265625e-6 /* 2^-18 */ + surfaceError +
           rounding * PLANE_SLACK;
}

#endif
