// SPDX-License-Identifier: Apache-2.0
// Positions of instances relative to the camera.
#ifndef CND_LIB_CAMERA_RELATIVE
#define CND_LIB_CAMERA_RELATIVE

// Returns the position hi + lo minus the camera's: the exact difference of the high parts (Knuth's
// TwoSum), plus the rounding error and the low parts.
vec3 cameraRelative(vec3 hi, vec3 lo, vec3 cameraHi, vec3 cameraLo)
{
    precise vec3 difference = hi - cameraHi;
    precise vec3 back = difference - hi;
    precise vec3 lost = (hi - (difference - back)) - (cameraHi + back);
    precise vec3 result = difference + (lost + (lo - cameraLo));
    return result;
}

#endif
