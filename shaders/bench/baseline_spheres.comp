// SPDX-License-Identifier: Apache-2.0
// Writes the spheres of influence to a compact buffer, so that culling reads one texel per light.
#version 460
#extension GL_GOOGLE_include_directive : require
#include "shared/baselines.h"

layout(local_size_x = BASELINE_GROUP) in;
layout(push_constant, scalar) uniform Push
{
    BaselineSpheresParams params;
};
layout(scalar, binding = BASELINE_SPHERES_CORE) readonly buffer Core
{
    vec4 core[];
};
layout(scalar, binding = BASELINE_SPHERES_OUTPUT) writeonly buffer Spheres
{
    vec4 spheres[];
};

void main()
{
    const uint light = gl_GlobalInvocationID.x;
    if (light >= params.lightCount)
        return;
    const float r2 = core[light * LIGHT_CORE_STRIDE + 1u].w;
    // Enlarged a little, because the tests round.
    const vec3 centre = core[light * LIGHT_CORE_STRIDE].xyz;
    const vec3 far = abs(centre);
    const float margin = 4e-6 * max(far.x, max(far.y, far.z));
    spheres[light] = vec4(centre, sqrt(r2) * 1.00001 + margin);
}
