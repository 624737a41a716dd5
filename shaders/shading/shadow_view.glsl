// SPDX-License-Identifier: Apache-2.0
// The parameters of shadows in a frame.
#ifndef CND_SHADING_SHADOW_VIEW
#define CND_SHADING_SHADOW_VIEW

#include "shared/occluder_data.h"

// The descriptor set of hosts' shaders has another number.
#ifndef OCCLUDER_SET
#define OCCLUDER_SET 0
#endif
#if defined(FORWARD_SET) && defined(CANDELABRA_VISIBLE_POINTS)
#define SHADOW_VIEW_BINDING SHADOW_VIEW_OF_RAYS
#else
#define SHADOW_VIEW_BINDING SHADOW_VIEW
#endif
layout(scalar, set = OCCLUDER_SET, binding = SHADOW_VIEW_BINDING) uniform CandelabraShadows
{
    ShadowView shadowView;
};

#endif
