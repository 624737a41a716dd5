// SPDX-License-Identifier: Apache-2.0
// Outgoing luminance of one shaded point under one light. The includer provides lightCentre(),
// lightEmission(), lightShapes[] and ltcTexel(); with CANDELABRA_VISIBILITY also lightIds[], and the
// host the shadow term.
#ifndef CND_SHADING_LIGHT_EVAL
#define CND_SHADING_LIGHT_EVAL

#include "shading/light.glsl"

// A file for each family of lights. That of the family at hand defines GENERAL_RESPONSE, the function
// that gives the response to a light of unit emission.
#if defined(LIGHT_FAMILY_PUNCTUAL) || defined(LIGHT_FAMILY_ALL)
#include "shading/eval_punctual.glsl"
#endif
#ifdef HAS_SPHERES
#include "shading/eval_sphere.glsl"
#endif
#if defined(LIGHT_FAMILY_TUBE) || defined(LIGHT_FAMILY_ALL)
#include "shading/eval_tube.glsl"
#endif
#if defined(LIGHT_FAMILY_RECTANGLE) || defined(LIGHT_FAMILY_ALL)
#include "shading/eval_rectangle.glsl"
#endif
#if defined(LIGHT_FAMILY_DISC) || defined(LIGHT_FAMILY_ALL)
#include "shading/eval_disc.glsl"
#endif

// The same for all families in one shader. Spheres are evaluated in more than one way.
#define GENERAL_RESPONSES(X)                                                                       \
    X(PUNCTUAL, punctualResponse)                                                                  \
    X(SPHERE, sphereAcross)                                                                        \
    X(TUBE, tubeResponse)                                                                          \
    X(RECTANGLE, rectangleResponse)                                                                \
    X(DISC, discResponse)

// Outgoing luminance by evaluation. A function each: drivers inline all of it at every call before
// they drop what specialisation rules out, and one function for all took minutes to compile.
#define EVALUATION(name, response)                                                                 \
    vec3 name(Receiver r, uint index)                                                              \
    {                                                                                              \
        const Light light = readLight(r, index);                                                   \
        return light.emission * response(r, light);                                                \
    }

#ifdef LIGHT_FAMILY_CONIC
EVALUATION(evaluateAsPoint, sphereAsPoint)
EVALUATION(evaluateNear, sphereNear)
#endif
#ifdef HAS_SPHERES
EVALUATION(evaluateAbove, sphereAbove)
#endif
#ifdef LIGHT_FAMILY_ALL
#define X(FAMILY, response) EVALUATION(evaluate_##FAMILY, response)
GENERAL_RESPONSES(X)
#undef X
#else
EVALUATION(evaluateGeneral, GENERAL_RESPONSE)
#endif

#endif
