// SPDX-License-Identifier: Apache-2.0
// The one list of families: light types, under some specular methods, whose evaluation shares code.
// The kernels that evaluate lights are compiled once per family, because drivers inline everything
// before they drop what specialisation rules out: one module for all lights took them seconds per
// pipeline. shaders/CMakeLists.txt reads this list too, one family per line; hosts name families in
// CndKernelCode::name ("shade_tiles:CONIC"), so names are stable.
#ifndef CND_SHARED_LIGHT_FAMILIES_H
#define CND_SHARED_LIGHT_FAMILIES_H

#include "shared/prelude.h"

// X(index, NAME, iterations): `iterations` is an upper bound of those that loops inside the
// evaluation of one light take, samples not counted. Outlines of tubes have 16 edges and are walked
// for the diffuse lobe and two specular ones; discs have a series of 9 terms.
#define CND_LIGHT_FAMILIES(X)                                                                      \
    X(0, PUNCTUAL, 24)                                                                             \
    X(1, CONIC, 0)                                                                                 \
    X(2, SPHERE, 0)                                                                                \
    X(3, TUBE, 64)                                                                                 \
    X(4, RECTANGLE, 24)                                                                            \
    X(5, DISC, 24)

GPU_BEGIN
// CONIC: spheres, near and distant, by SPECULAR_CONIC and SPECULAR_CONIC_FULL; SPHERE: by the
// others.
#define X(index, NAME, iterations) const uint FAMILY_##NAME = index;
CND_LIGHT_FAMILIES(X)
#undef X
#define X(index, NAME, iterations) +1u
const uint FAMILY_COUNT = 0u CND_LIGHT_FAMILIES(X);
#undef X
GPU_END

#endif
