// SPDX-License-Identifier: Apache-2.0
// One light as shade_brute.comp treats it, and its lobes apart. After shading/light_walk.glsl.

vec3 evaluateClassified(Receiver r, uint light)
{
    Sums sums = noLight();
    shadeBlock(sums, r, light, 1u, false);
    return total(sums);
}

// Makes the channels of the response those of BenchResponse: albedo in x; F0 = F90 = 1 in y gives A,
// F90 = 1 alone in z gives B.
void separateLobes(inout ShadingPoint p)
{
    p.albedo = vec3(1.0, 0.0, 0.0);
    p.F0 = vec3(0.0, 1.0, 0.0);
    p.F90 = vec3(0.0, 1.0, 1.0);
}
