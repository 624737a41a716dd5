// SPDX-License-Identifier: Apache-2.0
// The bindings of what walks through occluders.
#ifndef CND_SHADING_OCCLUDER_BUFFERS
#define CND_SHADING_OCCLUDER_BUFFERS

#extension GL_EXT_samplerless_texture_functions : require
#include "shading/shadow_view.glsl"

layout(scalar, set = OCCLUDER_SET, binding = SHADOW_INSTANCE_NODES) readonly buffer InstanceNodes
{
    OccluderNode instanceNodes[];
};
layout(scalar, set = OCCLUDER_SET, binding = SHADOW_INSTANCES) readonly buffer OccluderInstances
{
    OccluderInstance occluderInstances[];
};
layout(scalar, set = OCCLUDER_SET, binding = SHADOW_NODES) readonly buffer OccluderNodes
{
    OccluderNode occluderNodes[];
};
layout(scalar, set = OCCLUDER_SET, binding = SHADOW_TRIANGLES) readonly buffer OccluderTriangles
{
    OccluderTriangle occluderTriangles[];
};
layout(set = OCCLUDER_SET, binding = SHADOW_POINTS) uniform utextureBuffer pointTexels;

uvec2 pointTable(uint i)
{
    return texelFetch(pointTexels, int(i)).xy;
}

#endif
