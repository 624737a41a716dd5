// SPDX-License-Identifier: Apache-2.0
// Writes the instances of occluders relative to the camera: their transforms to and from view space.
#version 460
#extension GL_GOOGLE_include_directive : require
#include "lib/camera_relative.glsl"
#include "shared/occluder_data.h"

layout(local_size_x = PREPARE_OCCLUDERS_GROUP) in;
layout(push_constant, scalar) uniform Push
{
    PrepareOccludersParams params;
};
layout(scalar, binding = PREPARE_OCCLUDERS_RECORDS) readonly buffer Records
{
    OccluderRecord records[];
};
layout(scalar, binding = PREPARE_OCCLUDERS_INSTANCES) writeonly buffer Instances
{
    OccluderInstance instances[];
};

// Returns the inverse. Columns of unit length keep the products within the range of float.
mat3 inverseOf(mat3 m)
{
    const vec3 lengths = vec3(length(m[0]), length(m[1]), length(m[2]));
    const vec3 a = m[0] / lengths.x, b = m[1] / lengths.y, c = m[2] / lengths.z;
    const vec3 bc = cross(b, c);
    const float determinant = dot(a, bc);
    return transpose(mat3(bc / (determinant * lengths.x), cross(c, a) / (determinant * lengths.y),
                          cross(a, b) / (determinant * lengths.z)));
}

void main()
{
    const uint group = gl_WorkGroupID.y * gl_NumWorkGroups.x + gl_WorkGroupID.x;
    const uint i = group * PREPARE_OCCLUDERS_GROUP + gl_LocalInvocationIndex;
    if (i >= params.count)
        return;
    const OccluderRecord r = records[i];
    const vec3 position = cameraRelative(r.positionHi, r.positionLo, params.cameraHi, params.cameraLo);
    const mat3 localFromWorld = inverseOf(r.worldFromLocal);
    instances[i] = OccluderInstance(
        params.viewFromWorld * r.worldFromLocal, params.viewFromWorld * position,
        localFromWorld * transpose(params.viewFromWorld), -(localFromWorld * position),
        r.firstNode, r.firstTriangle, r.flags, r.surfaceError);
}
