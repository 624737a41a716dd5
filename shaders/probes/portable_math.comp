// SPDX-License-Identifier: Apache-2.0
// Test-only: reciprocals and roots that have the same bits on every device.
#version 460
#extension GL_GOOGLE_include_directive : require
#include "shared/probes.h"
#include "lib/portable_math.glsl"

layout(local_size_x = PROBE_GROUP) in;
layout(push_constant, scalar) uniform Push
{
    ProbeParams params;
};
layout(scalar, binding = PROBE_INPUT) readonly buffer Input
{
    float inputs[];
};
layout(scalar, binding = PROBE_OUTPUT) writeonly buffer Output
{
    PortableProbeOutput outputs[];
};

void main()
{
    const uint i = gl_GlobalInvocationID.x;
    if (i >= params.count)
        return;
    const float x = inputs[i];
    outputs[i] = PortableProbeOutput(portableReciprocal(x), portableInverseSqrt(x), portableSqrt(x));
}
