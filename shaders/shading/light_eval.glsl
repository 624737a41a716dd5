// SPDX-License-Identifier: Apache-2.0
// The outgoing luminance of one shaded point under one light. The includer provides lightShapes[].
#ifndef CND_SHADING_LIGHT_EVAL
#define CND_SHADING_LIGHT_EVAL

#include "shading/eval_disc.glsl"
#include "shading/eval_polygon.glsl"
#include "shading/eval_punctual.glsl"
#include "shading/eval_rectangle.glsl"
#include "shading/eval_sphere.glsl"
#include "shading/eval_tube.glsl"
#include "shading/light_families.glsl"

// With SHADOWS, evaluations also take the visible shares of both lobes (shared/occluder_data.h).
#ifdef SHADOWS
#include "shared/occluder_data.h"
#define VISIBLE_SHARES , uint shares
#define REFLECTED(p, response) reflectedPart(p, response, shares)
vec3 reflectedPart(ShadingPoint p, LightResponse response, uint shares)
{
    const vec2 visible = vec2(shares & 0xFFFFu, shares >> 16) * (1.0 / SHARE_UNIT);
    // Factors of the response would keep compilers from combining its constants as they do without
    // shadows, and the last bit of lights in full view would differ.
    p.albedo *= visible.x;
    p.F0 *= visible.y;
    p.F90 *= visible.y;
    return reflected(p, response);
}
#else
#define VISIBLE_SHARES
#define REFLECTED(p, response) reflected(p, response)
#endif

// Defines a function that returns the outgoing luminance by one way of evaluation. Each way has a
// function of its own: drivers inline a function at every call before they drop the code that
// specialisation makes unreachable, and one function for all ways took minutes to compile.
#define EVALUATION(name, response)                                                                 \
    vec3 name(Receiver r, uint index VISIBLE_SHARES)                                               \
    {                                                                                              \
        keepLight(index);                                                                          \
        Light light = readLight(r, index);                                                         \
        float d2 = length2(light.toLight);                                                         \
        const LightResponse toUnitEmission = response(r, light);                                   \
        if (KEEPS_RECEIVERS) {                                                                     \
            r = readAgain(r);                                                                      \
            light = readLight(r, lightAgain(index));                                               \
            d2 = length2(light.toLight);                                                           \
        }                                                                                          \
        return emissionTowards(r, light, d2) * REFLECTED(r.p, toUnitEmission);                     \
    }

#define X(WAY, found, SUM, response) EVALUATION(evaluate_##WAY, response)
EVALUATIONS(X)
#undef X
#ifdef LIGHT_FAMILY_ALL
#define X(FAMILY, response) EVALUATION(evaluate_##FAMILY, response)
GENERAL_RESPONSES(X)
#undef X
#endif

#endif
