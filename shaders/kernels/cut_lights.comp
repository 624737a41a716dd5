// SPDX-License-Identifier: Apache-2.0
// Computes the radii of influence for the illuminance at which the frame cuts its lights. Every lane
// computes the next state of the history for itself.
#version 460
#extension GL_GOOGLE_include_directive : require
#include "lib/influence.glsl"
#include "shared/lighting_data.h"

layout(local_size_x = CUT_LIGHTS_GROUP) in;
layout(push_constant, scalar) uniform Push
{
    CutLightsParams params;
};
layout(scalar, binding = CUT_LIGHTS_DATA) buffer Data
{
    InfluenceData data;
};
layout(scalar, binding = CUT_LIGHTS_CORE) buffer Core
{
    vec4 core[];
};
layout(scalar, binding = CUT_LIGHTS_SHAPES) readonly buffer Shapes
{
    LightShape shapes[];
};
layout(scalar, binding = CUT_LIGHTS_COUNTERS) writeonly buffer Counters
{
    LightingCounters counters;
};

// Squared radius of lights that no pixel shows. 0 would mean that there is no light, and 0 / 0 is NaN.
const float NOWHERE = 1e-30;

// Returns the next state. The cut falls at once to the highest one that the frame's samples allow. It
// rises by one step per frame to the highest one that the samples of a whole period have allowed.
InfluenceState stepFrom(InfluenceState before)
{
    const InfluenceFrame f = data.frame;
    const uint allowed = data.allowed;
    InfluenceState now = InfluenceState(f.owner, influenceFrame(f, before), f.size, 1u, allowed,
                                        allowed, allowed);
    if (now.frame == 0u)
        return now;
    const bool sameSize = before.size == f.size;
    const bool periodBegins = !sameSize || before.seen == f.spacing * f.spacing;
    now.target = min(sameSize && periodBegins ? before.lowest : before.target, allowed);
    now.cut = min(before.cut + 1u, now.target);
    if (!periodBegins) {
        now.seen = before.seen + 1u;
        now.lowest = min(before.lowest, allowed);
    }
    return now;
}

void main()
{
    const uint i = gl_GlobalInvocationID.x;
    if (i >= params.lightCount)
        return;
    const InfluenceState state = stepFrom(data.states[data.frame.previous]);
    const float lux =
        state.cut != 0u ? influenceThreshold(state.cut) / data.frame.exposure : 0.0;
    if (i == 0u) {
        data.states[1u - data.frame.previous] = state;
        counters.cutBelow = lux;
    }
    const uint light = params.firstLight + i;
    const uint at = light * LIGHT_CORE_STRIDE + 1u;
    const vec4 emission = core[at];
    if (emission.w <= 0.0) // not a light (device_lights), or a light of other layers than the frame's
        return;
    const float intensity =
        peakIntensity(params.type, emission.xyz, core[at - 1u].w, shapes[light]);
    const float uncut2 = UNBOUNDED * UNBOUNDED;
    core[at].w = state.cut != 0u ? clamp(intensity / lux, NOWHERE, uncut2) : uncut2;
}
