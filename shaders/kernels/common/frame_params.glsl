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

#endif
