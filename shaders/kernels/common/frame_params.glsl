// SPDX-License-Identifier: Apache-2.0
// The uniform buffer with the parameters of the frame. The block's name has a prefix, because a host's
// source may have a block "Frame".
#ifndef CND_COMMON_FRAME_PARAMS
#define CND_COMMON_FRAME_PARAMS

#include "shared/frame.h"

layout(scalar, binding = FRAME_PARAMS) uniform CandelabraFrame
{
    FrameParams frameParams;
};

// Return the texel of a pixel of the frame: in the images of the host, and in the depth image.
ivec2 texelOf(uvec2 pixel)
{
    return ivec2(pixel + frameParams.firstTexel);
}

ivec2 depthTexelOf(uvec2 pixel)
{
    return ivec2(pixel + frameParams.firstDepthTexel);
}

#endif
