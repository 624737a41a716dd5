// SPDX-License-Identifier: Apache-2.0
// Reads the part of the light data that every loop needs. The includer defines the binding ids
// LIGHT_STREAM_CORE and LIGHT_STREAM_CORE_WORDS. The same bytes are bound as a storage buffer, which
// GPUs read, and as a texel buffer, which llvmpipe reads five times faster
// (engine/lights/light_limits.h).
#extension GL_EXT_samplerless_texture_functions : require

layout(constant_id = SPEC_LIGHTS_AS_TEXELS) const uint lightsAsTexels = 1u;
layout(binding = LIGHT_STREAM_CORE) uniform textureBuffer lightTexels;
layout(scalar, binding = LIGHT_STREAM_CORE_WORDS) readonly buffer LightWords
{
    vec4 lightWords[];
};

// Returns the centre in view space and the bounding radius of the emitter.
vec4 lightCentre(uint light)
{
    const uint at = light * LIGHT_CORE_STRIDE;
    return lightsAsTexels != 0u ? texelFetch(lightTexels, int(at)) : lightWords[at];
}

// Returns the emission and the squared influence radius.
vec4 lightEmission(uint light)
{
    const uint at = light * LIGHT_CORE_STRIDE + 1u;
    return lightsAsTexels != 0u ? texelFetch(lightTexels, int(at)) : lightWords[at];
}
