// SPDX-License-Identifier: Apache-2.0
// pointCount: how many points a light has that a receiver may see, 64 or 32. Hosts' shaders have no
// specialisation constant for it.
#ifndef CND_SHADING_POINT_COUNT
#define CND_SHADING_POINT_COUNT

#include "shared/occluder_data.h"

#ifdef LIGHT_FAMILY_ALL
#define pointCount shadowView.points
#else
layout(constant_id = SPEC_VISIBILITY_POINTS) const uint pointCount = 64u;
#endif

#endif
