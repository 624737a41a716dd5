// SPDX-License-Identifier: Apache-2.0
// Reads the hot light data. The includer defines LIGHT_STREAM_CORE and LIGHT_STREAM_CORE_WORDS, the
// binding ids. Texel buffers are about five times cheaper than storage buffers on lavapipe; devices
// whose texel buffers are too small for the light count read the same bytes as storage.
#extension GL_EXT_samplerless_texture_functions : require

layout(constant_id = SPEC_LIGHTS_AS_TEXELS) const uint lightsAsTexels = 1u;
layout(binding = LIGHT_STREAM_CORE) uniform textureBuffer lightTexels;
layout(scalar, binding = LIGHT_STREAM_CORE_WORDS) readonly buffer LightWords
{
    vec4 lightWords[];
};

// Centre in view space and emitter radius.
vec4 lightCentre(uint light)
{
    const uint at = light * LIGHT_CORE_STRIDE;
    return lightsAsTexels != 0u ? texelFetch(lightTexels, int(at)) : lightWords[at];
}

// Emission and squared influence radius.
vec4 lightEmission(uint light)
{
    const uint at = light * LIGHT_CORE_STRIDE + 1u;
    return lightsAsTexels != 0u ? texelFetch(lightTexels, int(at)) : lightWords[at];
}
