// SPDX-License-Identifier: Apache-2.0
// The material at a point of a surface, and the reflectances that the G-buffer stores of it.
#ifndef CND_GBUFFER_MATERIAL
#define CND_GBUFFER_MATERIAL

struct MaterialSample {
    vec3 baseColor;
    float metalness;
    float perceptualRoughness;
    vec3 dielectricF0;
    float diffuseWeight;
    float specularWeight;
    vec3 emission; // cd/m^2
};

// These two are `precise`, so that they are the same bits on every device and in every stage.

vec3 diffuseAlbedo(MaterialSample m)
{
    precise const vec3 albedo = m.baseColor * ((1.0 - m.metalness) * m.diffuseWeight);
    return albedo;
}

// Returns F0.
vec3 normalReflectance(MaterialSample m)
{
    precise const vec3 F0 = m.dielectricF0 * (1.0 - m.metalness) + m.baseColor * m.metalness;
    return F0;
}

#endif
