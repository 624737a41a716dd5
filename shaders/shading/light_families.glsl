// SPDX-License-Identifier: Apache-2.0
// The family of lights that a shader is compiled for (shared/light_type_list.h), and how its lights are
// evaluated. The build defines LIGHT_FAMILY_<name>. Shaders of hosts (lib/forward.glsl) define
// LIGHT_FAMILY_ALL and evaluate every light, spheres by SPECULAR_CONIC.
#ifndef CND_SHADING_LIGHT_FAMILIES
#define CND_SHADING_LIGHT_FAMILIES

#include "shared/light_type_list.h"

// EVALUATIONS(X) lists the ways in which the lights of the family are evaluated: X(WAY, found, SUM,
// response). `found` is the member of Found that holds such lights, and of Sums (light_walk.glsl), and
// `response` the function that returns the response to a light of unit emission (eval_*.glsl). All
// lights have the way GENERAL. Spheres, and lights with outlines, have ABOVE for those wholly above the
// horizon; the closed form of spheres has NEAR for those near it.
#define CLOSED_SPHERE_EVALUATIONS(X)                                                               \
    X(NEAR, near, SUM_GENERAL, sphereNear)                                                         \
    X(ABOVE, above, SUM_ABOVE, sphereAbove)
#define TWO_EVALUATIONS(X, aboveResponse, generalResponse)                                         \
    X(ABOVE, above, SUM_ABOVE, aboveResponse)                                                      \
    X(GENERAL, general, SUM_GENERAL, generalResponse)
#if defined(LIGHT_FAMILY_ALL)
#define LIGHT_FAMILY FAMILY_COUNT
#define EVALUATIONS(X) CLOSED_SPHERE_EVALUATIONS(X)
#elif defined(LIGHT_FAMILY_PUNCTUAL)
#define LIGHT_FAMILY FAMILY_PUNCTUAL
#define EVALUATIONS(X) X(GENERAL, general, SUM_GENERAL, punctualResponse)
#elif defined(LIGHT_FAMILY_CONIC)
#define LIGHT_FAMILY FAMILY_CONIC
#define EVALUATIONS(X)                                                                             \
    CLOSED_SPHERE_EVALUATIONS(X)                                                                   \
    X(GENERAL, general, SUM_GENERAL, sphereAcross)
#elif defined(LIGHT_FAMILY_SPHERE)
#define LIGHT_FAMILY FAMILY_SPHERE
#define EVALUATIONS(X) TWO_EVALUATIONS(X, cheapSphereAbove, cheapSphereAcross)
#elif defined(LIGHT_FAMILY_TUBE)
#define LIGHT_FAMILY FAMILY_TUBE
#define EVALUATIONS(X) TWO_EVALUATIONS(X, tubeAbove, tubeResponse)
#elif defined(LIGHT_FAMILY_RECTANGLE)
#define LIGHT_FAMILY FAMILY_RECTANGLE
#define EVALUATIONS(X) TWO_EVALUATIONS(X, rectangleAbove, rectangleResponse)
#elif defined(LIGHT_FAMILY_DISC)
#define LIGHT_FAMILY FAMILY_DISC
#define EVALUATIONS(X) TWO_EVALUATIONS(X, discAbove, discResponse)
#elif defined(LIGHT_FAMILY_POLYGON)
#define LIGHT_FAMILY FAMILY_POLYGON
#define EVALUATIONS(X) TWO_EVALUATIONS(X, polygonAbove, polygonResponse)
#endif

// Whether the shader evaluates all families.
const bool HAS_ALL_FAMILIES = LIGHT_FAMILY == FAMILY_COUNT;
// The function of the way GENERAL of each family. For spheres it is that of the closed form.
#define GENERAL_RESPONSES(X)                                                                       \
    X(PUNCTUAL, punctualResponse)                                                                  \
    X(SPHERE, sphereAcross)                                                                        \
    X(TUBE, tubeResponse)                                                                          \
    X(RECTANGLE, rectangleResponse)                                                                \
    X(DISC, discResponse)                                                                          \
    X(POLYGON, polygonResponse)

// Whether the family has spheres, near or distant, which are evaluated by the closed form or by any
// other method, and whether it has lights that are evaluated by their outlines.
const bool HAS_CLOSED_SPHERES = LIGHT_FAMILY == FAMILY_CONIC || HAS_ALL_FAMILIES;
const bool HAS_SPHERES = LIGHT_FAMILY == FAMILY_SPHERE || HAS_CLOSED_SPHERES;
const bool HAS_OUTLINES = LIGHT_FAMILY != FAMILY_PUNCTUAL && LIGHT_FAMILY != FAMILY_SPHERE &&
                          LIGHT_FAMILY != FAMILY_CONIC;

#endif
