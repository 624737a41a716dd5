// SPDX-License-Identifier: Apache-2.0
// Evaluates one light as shade_brute.comp does, with separate lobes.
#include "shading/light_walk.glsl"
#include "shared/bench.h"

vec3 evaluateClassified(Receiver r, uint light)
{
    Sums sums = noLight();
    shadeBlock(sums, r, light, 1u, false);
    return total(sums);
}

// Returns the way in which the light is evaluated (EVALUATE_*).
uint wayOf(Receiver r, uint light)
{
    const Found found = findLights(r, light, 1u, false);
    const uint closer = found.near.x != 0u ? EVALUATE_NEAR
        : found.general.x != 0u           ? EVALUATE_GENERAL
                                          : EVALUATE_NONE;
    return found.above.x != 0u ? EVALUATE_ABOVE : closer;
}

// Sets up a material whose response has the channels of BenchResponse: the albedo term in x; with F0 =
// F90 = 1 term A in y; with F90 = 1 alone term B in z.
void separateLobes(inout ShadingPoint p)
{
    p.albedo = vec3(1.0, 0.0, 0.0);
    p.F0 = vec3(0.0, 1.0, 0.0);
    p.F90 = vec3(0.0, 1.0, 1.0);
}
