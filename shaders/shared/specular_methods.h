// SPDX-License-Identifier: Apache-2.0
// The one list of specular methods for sphere lights: X(id, NAME, name on the command line). The
// ids are those of CndSpecularMethod and appear in recorded results, so they are stable. No method
// has the id 4: it was that of linearly transformed cosines, which are now a rival that only the
// benchmarks have (shaders/bench/ltc).
#ifndef CND_SHARED_SPECULAR_METHODS_H
#define CND_SHARED_SPECULAR_METHODS_H

#include "shared/prelude.h"

#define CND_SPECULAR_METHODS(X)                                                                    \
    X(0, NONE, "none")                                                                             \
    X(1, KARIS, "karis")                                                                           \
    X(2, POINT, "point")                                                                           \
    X(3, KX, "kx")                                                                                 \
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
