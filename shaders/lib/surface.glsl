// SPDX-License-Identifier: Apache-2.0
// The data of a surface that a G-buffer stores.
#ifndef CND_LIB_SURFACE
#define CND_LIB_SURFACE

struct Surface {
    vec3 normal;      // unit, view space
    vec3 albedo;      // diffuse, 0..1, already scaled by 1 - metalness
    vec3 F0;          // Fresnel reflectance at normal incidence, 0..1
    float specularWeight;      // Schlick's F90, 0..1; 0: no specular lobe
    float perceptualRoughness; // 0..1; alpha is its square
};

#endif
