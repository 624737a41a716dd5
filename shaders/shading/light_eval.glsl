// SPDX-License-Identifier: Apache-2.0
// The outgoing luminance of one shaded point under one light. The includer provides lightCentre(),
// lightEmission(), lightShapes[] and, with CANDELABRA_VISIBILITY, lightIds[]. The host then provides
// the shadow term.
#ifndef CND_SHADING_LIGHT_EVAL
#define CND_SHADING_LIGHT_EVAL

#include "shading/light.glsl"

// Each family of lights has a file. The file of the family that the shader is compiled for defines
// GENERAL_RESPONSE, the function that returns the response to a light of unit emission.
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
#if defined(LIGHT_FAMILY_POLYGON) || defined(LIGHT_FAMILY_ALL)
#include "shading/eval_polygon.glsl"
#endif

// The functions of GENERAL_RESPONSE for shaders with all families. The other ways in which spheres are
// evaluated are not in this list.
#define GENERAL_RESPONSES(X)                                                                       \
    X(PUNCTUAL, punctualResponse)                                                                  \
    X(SPHERE, sphereAcross)                                                                        \
    X(TUBE, tubeResponse)                                                                          \
    X(RECTANGLE, rectangleResponse)                                                                \
    X(DISC, discResponse)                                                                          \
    X(POLYGON, polygonResponse)

// Defines a function that returns the outgoing luminance by one way of evaluation. Each way has a
// function of its own: drivers inline a function at every call before they drop the code that
// specialisation makes unreachable, and one function for all ways took minutes to compile.
#define EVALUATION(name, response)                                                                 \
    vec3 name(Receiver r, uint index)                                                              \
    {                                                                                              \
        keepLight(index);                                                                          \
        Light light = readLight(r, index);                                                         \
        float d2 = length2(light.toLight);                                                         \
        const vec3 toUnitEmission = response(r, light);                                            \
        if (KEEPS_RECEIVERS) {                                                                     \
            r = readAgain(r);                                                                      \
            light = readLight(r, lightAgain(index));                                               \
            d2 = length2(light.toLight);                                                           \
        }                                                                                          \
        return emissionTowards(r, light, d2) * toUnitEmission;                                     \
    }

#ifdef LIGHT_FAMILY_CONIC
EVALUATION(evaluateNear, sphereNear)
#endif
#ifdef ABOVE_RESPONSE
EVALUATION(evaluateAbove, ABOVE_RESPONSE)
#endif
#ifdef LIGHT_FAMILY_ALL
#define X(FAMILY, response) EVALUATION(evaluate_##FAMILY, response)
GENERAL_RESPONSES(X)
#undef X
#else
EVALUATION(evaluateGeneral, GENERAL_RESPONSE)
#endif

#endif
