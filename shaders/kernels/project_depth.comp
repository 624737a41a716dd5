// SPDX-License-Identifier: Apache-2.0
// Computes the depth of the frame's projection from linear depths or positions.
#version 460
#extension GL_GOOGLE_include_directive : require
#extension GL_EXT_samplerless_texture_functions : require
#include "shared/lighting_data.h"
#include "shared/project_depth.h"
#include "kernels/common/stored_depth.glsl"

layout(local_size_x = PROJECT_DEPTH_GROUP, local_size_y = PROJECT_DEPTH_GROUP) in;
layout(push_constant, scalar) uniform Push
{
    ProjectDepthParams params;
};
layout(binding = PROJECT_DEPTH_STORED) uniform texture2D storedImage;
layout(binding = PROJECT_DEPTH_OUTPUT, r32f) uniform writeonly image2D depthImage;

void main()
{
    const uvec2 pixel = gl_GlobalInvocationID.xy;
    if (any(greaterThanEqual(pixel, frameParams.size)))
        return;
    const float depth = visibleDepth(params.depth, texelFetch(storedImage, texelOf(pixel), 0));
    imageStore(depthImage, ivec2(pixel), vec4(depth));
}
