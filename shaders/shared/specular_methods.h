// SPDX-License-Identifier: Apache-2.0
// The one list of specular methods for sphere lights: X(id, NAME, name on the command line). The
// ids are those of CndSpecularMethod, in which 0 stands for the first method of a module.
#ifndef CND_SHARED_SPECULAR_METHODS_H
#define CND_SHARED_SPECULAR_METHODS_H

#include "shared/prelude.h"

#define CND_SPECULAR_METHODS(X)                                                                    \
    X(1, NONE, "none")                                                                             \
    X(2, KARIS, "karis")                                                                           \
    X(3, POINT, "point")                                                                           \
    X(4, KX, "kx")                                                                                 \
    X(5, CONIC, "conic")                                                                           \
    X(6, CONIC_FULL, "conic-full")                                                                 \
    X(7, SAMPLED, "sampled")

GPU_BEGIN
#define X(id, NAME, name) const uint SPECULAR_##NAME = id;
CND_SPECULAR_METHODS(X)
#undef X
// Mask of 1 << id with all methods.
#define X(id, NAME, name) | 1u << id
const uint ALL_SPECULAR_METHODS = 0u CND_SPECULAR_METHODS(X);
#undef X
GPU_END

#endif
