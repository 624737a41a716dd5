// SPDX-License-Identifier: Apache-2.0
// The one list of light types with the fields that each type uses, and the one list of families. A
// family is a set of light types, or of a light type with some specular methods, whose evaluation
// shares code.
#ifndef CND_SHARED_LIGHT_TYPE_LIST_H
#define CND_SHARED_LIGHT_TYPE_LIST_H

#include "shared/prelude.h"

// The kernels that evaluate lights are compiled once per family: drivers inline everything before
// they drop the code that specialisation makes unreachable, and took seconds per pipeline for one
// module with all lights. shaders/CMakeLists.txt also reads this list, one family per line. Hosts
// name families in CndKernelCode::name ("shade_tiles:CONIC"), so the names are stable.
//
// X(index, NAME, iterations). `iterations` is an upper bound of the loop iterations that the
// evaluation of one light takes, without those of SPECULAR_SAMPLED. It counts the arcs of the
// light's outline and their pieces (lib/outline/): 4 edges of a rectangle, up to 14 of a polygon,
// and 2 sides and up to 16 arcs of a tube across the horizon, with 3 pieces each. The rim of a disc
// has 6 pieces that may be halved three times, and its form factor a series of 12 terms. A light
// near the horizon is walked twice. The range of heights of a disc takes 8 turns of Newton's
// method.
#define CND_LIGHT_FAMILIES(X)                                                                      \
    X(0, PUNCTUAL, 24)                                                                             \
    X(1, CONIC, 0)                                                                                 \
    X(2, SPHERE, 0)                                                                                \
    X(3, TUBE, 160)                                                                                \
    X(4, RECTANGLE, 48)                                                                            \
    X(5, DISC, 216)                                                                                \
    X(6, POLYGON, 128)

// X(id, NAME, family, fields of CndLight that the type uses). The ids are those of CndLightType, so
// they are stable. Types that are shaded by the specular methods of spheres are in the family
// SPHERE here. A type without a position is distant: it has no influence radius, and its lights are
// seen in the same direction from everywhere.
#define CND_LIGHT_TYPES(X)                                                                         \
    X(0, POINT, PUNCTUAL, LIGHT_HAS_POSITION)                                                      \
    X(1, SPHERE, SPHERE, LIGHT_HAS_POSITION | LIGHT_HAS_RADIUS)                                    \
    X(2, SPOT, PUNCTUAL, LIGHT_HAS_POSITION | LIGHT_HAS_DIRECTION | LIGHT_HAS_CONE)                \
    X(3, DIRECTIONAL, PUNCTUAL, LIGHT_HAS_DIRECTION)                                               \
    X(4, DISTANT_SPHERE, SPHERE, LIGHT_HAS_DIRECTION | LIGHT_HAS_RADIUS)                           \
    X(5, TUBE, TUBE, LIGHT_HAS_POSITION | LIGHT_HAS_RADIUS | LIGHT_HAS_AXIS_U)                     \
    X(6, RECTANGLE, RECTANGLE,                                                                     \
      LIGHT_HAS_POSITION | LIGHT_HAS_AXIS_U | LIGHT_HAS_AXIS_V | LIGHT_HAS_SIDES)                  \
    X(7, DISC, DISC,                                                                               \
      LIGHT_HAS_POSITION | LIGHT_HAS_RADIUS | LIGHT_HAS_DIRECTION | LIGHT_HAS_SIDES)               \
    X(8, POLYGON, POLYGON,                                                                         \
      LIGHT_HAS_POSITION | LIGHT_HAS_AXIS_U | LIGHT_HAS_AXIS_V | LIGHT_HAS_SIDES |                 \
          LIGHT_HAS_CORNERS)

GPU_BEGIN

// CONIC: spheres, near and distant, with SPECULAR_CONIC and SPECULAR_CONIC_FULL. SPHERE: spheres
// with the other methods.
#define X(index, NAME, iterations) const uint FAMILY_##NAME = index;
CND_LIGHT_FAMILIES(X)
#undef X
#define X(index, NAME, iterations) +1u
const uint FAMILY_COUNT = 0u CND_LIGHT_FAMILIES(X);
#undef X

// The values of CndLightFieldBits.
const uint LIGHT_HAS_POSITION = 1u;
const uint LIGHT_HAS_RADIUS = 2u;
const uint LIGHT_HAS_DIRECTION = 4u;
const uint LIGHT_HAS_CONE = 8u;
const uint LIGHT_HAS_AXIS_U = 16u;
const uint LIGHT_HAS_AXIS_V = 32u;
const uint LIGHT_HAS_SIDES = 64u;    // twoSided
const uint LIGHT_HAS_CORNERS = 128u; // polygon

#define X(id, NAME, family, fields) const uint LIGHT_##NAME = id;
CND_LIGHT_TYPES(X)
#undef X
#define X(id, NAME, family, fields) +1u
const uint LIGHT_TYPE_COUNT = 0u CND_LIGHT_TYPES(X);
#undef X

const uint MAX_CORNERS = 8u; // CND_MAX_CORNERS

// Masks of 1 << type, which hold the types that use a field. They are constant expressions, so they
// may be combined with specialisation constants.
#define X(id, NAME, family, fields) | (((fields)&FIELD) != 0u ? 1u << id : 0u)
#define FIELD LIGHT_HAS_POSITION
const uint TYPES_WITH_POSITION = 0u CND_LIGHT_TYPES(X);
#undef FIELD
#define FIELD LIGHT_HAS_RADIUS
const uint TYPES_WITH_RADIUS = 0u CND_LIGHT_TYPES(X);
#undef FIELD
#define FIELD LIGHT_HAS_DIRECTION
const uint TYPES_WITH_DIRECTION = 0u CND_LIGHT_TYPES(X);
#undef FIELD
#define FIELD LIGHT_HAS_CONE
const uint TYPES_WITH_CONE = 0u CND_LIGHT_TYPES(X);
#undef FIELD
#define FIELD LIGHT_HAS_AXIS_U
const uint TYPES_WITH_AXIS_U = 0u CND_LIGHT_TYPES(X);
#undef FIELD
#define FIELD LIGHT_HAS_AXIS_V
const uint TYPES_WITH_AXIS_V = 0u CND_LIGHT_TYPES(X);
#undef FIELD
#define FIELD LIGHT_HAS_SIDES
const uint TYPES_WITH_SIDES = 0u CND_LIGHT_TYPES(X);
#undef FIELD
#define FIELD LIGHT_HAS_CORNERS
const uint TYPES_WITH_CORNERS = 0u CND_LIGHT_TYPES(X);
#undef FIELD
#undef X
// Types whose lights have a size.
#define X(id, NAME, family, fields) | (FAMILY_##family != FAMILY_PUNCTUAL ? 1u << id : 0u)
const uint AREA_LIGHT_TYPES = 0u CND_LIGHT_TYPES(X);
#undef X

GPU_END

#endif
