// SPDX-License-Identifier: Apache-2.0
// The one list of light types. Ids are stable: they are CndLightType and appear in scene files.
#ifndef CND_SHARED_LIGHT_TYPES_H
#define CND_SHARED_LIGHT_TYPES_H

#include "shared/prelude.h"

#define CND_LIGHT_TYPES(X)                                                                         \
    X(0, POINT)                                                                                    \
    X(1, SPHERE)                                                                                   \
    X(2, SPOT)                                                                                     \
    X(3, DIRECTIONAL)                                                                              \
    X(4, DISTANT_SPHERE)                                                                           \
    X(5, TUBE)                                                                                     \
    X(6, RECTANGLE)                                                                                \
    X(7, DISC)

GPU_BEGIN
#define X(id, NAME) const uint LIGHT_##NAME = id;
CND_LIGHT_TYPES(X)
#undef X
GPU_END

#endif
