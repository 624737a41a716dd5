// SPDX-License-Identifier: Apache-2.0
// A host that reads the FULL layout with a function of its own (CND_GBUFFER_CUSTOM), through images
// in its descriptor set.
#pragma once

#include "gpu/kernel.h"

namespace candelabra::test
{

inline constexpr const char* surfaceSource = R"(
layout(set = 1, binding = 0) uniform utexture2D hostNormals;
layout(set = 1, binding = 1) uniform utexture2D hostAlbedo;
layout(set = 1, binding = 2) uniform utexture2D hostSpecular;
CndSurface candelabraReadSurface(ivec2 pixel)
{
    return cndUnpackGBufferFull(texelFetch(hostNormals, pixel, 0).xy,
                                texelFetch(hostAlbedo, pixel, 0).xy,
                                texelFetch(hostSpecular, pixel, 0).xy);
}
)";

// Creates one descriptor set with LightingTest::Images.
template <typename Images>
gpu::Bindings surfaceSet(const gpu::Device& device, const Images& images)
{
    constexpr VkDescriptorType image = VK_DESCRIPTOR_TYPE_SAMPLED_IMAGE;
    gpu::Bindings out(device, "host G-buffer", {{0, image, 1}, {1, image, 1}, {2, image, 1}},
                      VK_SHADER_STAGE_COMPUTE_BIT, 1);
    out.write(0, {gpu::Binding::sampled(0, images.normalRoughness.view.get()),
                  gpu::Binding::sampled(1, images.albedo.view.get()),
                  gpu::Binding::sampled(2, images.specular.view.get())});
    return out;
}

} // namespace candelabra::test
