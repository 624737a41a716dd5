// SPDX-License-Identifier: Apache-2.0
// Reads the spheres of influence as the engine's kernels read lights
// (kernels/common/light_stream.glsl). The includer defines the binding ids SPHERES and SPHERE_WORDS.
// It reads other arrays of vec4 in the same way, as lightsAsTexels says.
#extension GL_EXT_samplerless_texture_functions : require

layout(constant_id = SPEC_LIGHTS_AS_TEXELS) const uint lightsAsTexels = 1u;
layout(binding = SPHERES) uniform textureBuffer sphereTexels;
layout(scalar, binding = SPHERE_WORDS) readonly buffer SphereWords
{
    vec4 sphereWords[];
};

vec4 sphereOf(uint light)
{
    return lightsAsTexels != 0u ? texelFetch(sphereTexels, int(light)) : sphereWords[light];
}
