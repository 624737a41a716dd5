// SPDX-License-Identifier: Apache-2.0
// Copies the records of edited lights, which the host has staged in any order, to their places. So a
// frame needs one command for all edits, however many there are and wherever they belong.
#version 460
#extension GL_GOOGLE_include_directive : require
#include "shared/light_edits.h"
#include "shared/lighting_data.h"

layout(local_size_x = LIGHT_EDITS_GROUP) in;
layout(push_constant, scalar) uniform Push
{
    LightEditsParams params;
};
layout(scalar, binding = LIGHT_EDITS_STAGED) readonly buffer Staged
{
    uvec4 staged[];
};
layout(scalar, binding = LIGHT_EDITS_PLACES) readonly buffer Places
{
    uint places[];
};
layout(scalar, binding = LIGHT_EDITS_RECORDS) writeonly buffer Records
{
    uvec4 records[];
};

void main()
{
    const uint group = gl_WorkGroupID.y * gl_NumWorkGroups.x + gl_WorkGroupID.x;
    const uint i = group * LIGHT_EDITS_GROUP + gl_LocalInvocationIndex;
    const uint record = i / LIGHT_EDITS_LANES, part = i % LIGHT_EDITS_LANES;
    if (record < params.count)
        records[(params.firstRecord + places[record]) * LIGHT_EDITS_LANES + part] = staged[i];
}
