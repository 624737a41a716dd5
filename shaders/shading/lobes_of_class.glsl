// SPDX-License-Identifier: Apache-2.0
// Which lobes the shaded surfaces may have. The class of their tile is a specialisation constant.
#ifndef CND_SHADING_LOBES_OF_CLASS
#define CND_SHADING_LOBES_OF_CLASS

#include "shared/lighting.h"
#include "shading/light_families.glsl"

#ifdef LIGHT_FAMILY_ALL
const uint tileClass = CLASS_ANY;
#else
layout(constant_id = SPEC_TILE_CLASS) const uint tileClass = CLASS_ANY;
#endif
// CLASS_DIFFUSE has no specular lobe because it is shaded with SPECULAR_NONE.
const bool HAS_DIFFUSE = tileClass != CLASS_SPECULAR;

#endif
