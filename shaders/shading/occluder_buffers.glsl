// SPDX-License-Identifier: Apache-2.0
// The bindings of what walks through occluders.
#ifndef CND_SHADING_OCCLUDER_BUFFERS
#define CND_SHADING_OCCLUDER_BUFFERS

#extension GL_EXT_samplerless_texture_functions : require
#include "shading/shadow_view.glsl"
#include "shading/software_drivers.glsl"

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

#ifdef LIGHT_FAMILY_ALL

OccluderInstance occluderInstance(uint at)
{
    return occluderInstances[at];
}
OccluderNode occluderNode(uint at)
{
    return occluderNodes[at];
}
OccluderTriangle occluderTriangle(uint at)
{
    return occluderTriangles[at];
}

#else

layout(binding = SHADOW_INSTANCE_TEXELS) uniform textureBuffer instanceTexels;
layout(binding = SHADOW_NODE_TEXELS) uniform textureBuffer nodeTexels;
layout(binding = SHADOW_TRIANGLE_TEXELS) uniform textureBuffer triangleTexels;

OccluderInstance occluderInstance(uint at)
{
    if (!forCpu)
        return occluderInstances[at];
    const int texel = int(7u * at);
    vec4 t[7];
    for (int i = 0; i < 7; ++i)
        t[i] = texelFetch(instanceTexels, texel + i);
    return OccluderInstance(
        mat3(t[0].xyz, vec3(t[0].w, t[1].xy), vec3(t[1].zw, t[2].x)), t[2].yzw,
        mat3(t[3].xyz, vec3(t[3].w, t[4].xy), vec3(t[4].zw, t[5].x)), t[5].yzw,
        floatBitsToUint(t[6].x), floatBitsToUint(t[6].y), floatBitsToUint(t[6].z), t[6].w);
}

OccluderNode occluderNode(uint at)
{
    if (!forCpu)
        return occluderNodes[at];
    const vec4 low = texelFetch(nodeTexels, int(2u * at));
    const vec4 high = texelFetch(nodeTexels, int(2u * at + 1u));
    return OccluderNode(low.xyz, floatBitsToUint(low.w), high.xyz, floatBitsToUint(high.w));
}

// A triangle has nine words. The first one is word 9 at % 4 of a texel.
OccluderTriangle occluderTriangle(uint at)
{
    if (!forCpu)
        return occluderTriangles[at];
    const uint word = 9u * at;
    vec4 t[3];
    for (int i = 0; i < 3; ++i)
        t[i] = texelFetch(triangleTexels, int(word / 4u) + i);
    if ((word & 1u) != 0u) {
        t[0] = vec4(t[0].yzw, t[1].x);
        t[1] = vec4(t[1].yzw, t[2].x);
        t[2].xyz = t[2].yzw;
    }
    if ((word & 2u) != 0u) {
        t[0] = vec4(t[0].zw, t[1].xy);
        t[1] = vec4(t[1].zw, t[2].xy);
        t[2].x = t[2].z;
    }
    return OccluderTriangle(vec3[3](t[0].xyz, vec3(t[0].w, t[1].xy), vec3(t[1].zw, t[2].x)));
}

#endif
#endif
