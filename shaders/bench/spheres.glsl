// SPDX-License-Identifier: Apache-2.0
// Reads the spheres of influence as the engine's kernels read lights.
#include "shading/software_drivers.glsl"
#include "shared/baselines.h"

layout(binding = BASELINE_SPHERE_TEXELS) uniform textureBuffer sphereTexels;
layout(scalar, binding = BASELINE_SPHERES) readonly buffer Spheres
{
    vec4 spheres[];
};

vec4 sphereOf(uint light)
{
    return READ(spheres, sphereTexels, light);
}
