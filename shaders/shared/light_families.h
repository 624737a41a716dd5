// SPDX-License-Identifier: Apache-2.0
// The one list of families. A family is a set of light types, or of a light type with some specular
// methods, whose evaluation shares code. The kernels that evaluate lights are compiled once per
// family: drivers inline everything before they drop the code that specialisation makes
// unreachable, and took seconds per pipeline for one module with all lights. shaders/CMakeLists.txt
// also reads this list, one family per line. Hosts name families in CndKernelCode::name
// ("shade_tiles:CONIC"), so the names are stable.
#ifndef CND_SHARED_LIGHT_FAMILIES_H
#define CND_SHARED_LIGHT_FAMILIES_H

#include "shared/prelude.h"

// X(index, NAME, iterations). `iterations` is an upper bound of the loop iterations that the
// evaluation of one light takes, without those of SPECULAR_SAMPLED. The outline of a tube has 16
// edges and is walked for the diffuse lobe and for two specular lobes; a disc has a series of 9
// terms.
#define CND_LIGHT_FAMILIES(X)                                                                      \
    X(0, PUNCTUAL, 24)                                                                             \
    X(1, CONIC, 0)                                                                                 \
    X(2, SPHERE, 0)                                                                                \
    X(3, TUBE, 64)                                                                                 \
    X(4, RECTANGLE, 24)                                                                            \
    X(5, DISC, 24)

GPU_BEGIN
// CONIC: spheres, near and distant, with SPECULAR_CONIC and SPECULAR_CONIC_FULL. SPHERE: spheres
// with the other methods.
#define X(index, NAME, iterations) const uint FAMILY_##NAME = index;
CND_LIGHT_FAMILIES(X)
#undef X
#define X(index, NAME, iterations) +1u
const uint FAMILY_COUNT = 0u CND_LIGHT_FAMILIES(X);
#undef X
GPU_END

#endif
