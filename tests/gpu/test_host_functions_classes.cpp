// SPDX-License-Identifier: Apache-2.0
// Classes of materials in kernels with functions of a host: a surface that it reads itself, and a
// shadow term.
#include "candelabra/compiler.hpp"
#include "gpu/kernel.h"
#include "gpu/pixel_difference.h"
#include "gpu/three_classes.h"

namespace candelabra::test
{
namespace
{

constexpr const char* source = R"(
layout(set = 1, binding = 0) uniform utexture2D hostNormals;
layout(set = 1, binding = 1) uniform texture2D hostAlbedo;
layout(set = 1, binding = 2) uniform texture2D hostSpecular;
Surface candelabraReadSurface(ivec2 pixel)
{
    return unpackGBufferFull(texelFetch(hostNormals, pixel, 0).xy, texelFetch(hostAlbedo, pixel, 0),
                             texelFetch(hostSpecular, pixel, 0));
}
float candelabraVisibility(ShadowQuery q)
{
    return q.light % 2u == 0u ? 1.0 : 0.25;
}
)";

} // namespace

TEST_F(LightingTest, ClassesOfSurfacesThatTheHostReadsLookTheSame)
{
    auto kernels = CompiledKernels::create(
        {.functions = CND_HOST_VISIBILITY_BIT | CND_HOST_READ_SURFACE_BIT,
         .source = source,
         .lightTypes = 1u << CND_LIGHT_SPHERE,
         .specularMethods = 1u << RunOptions{}.specular | 1u << CND_SPECULAR_NONE});
    ASSERT_TRUE(kernels) << kernels.error().message;
    const CpuGBuffer g = threeClasses(72, 48);
    const std::vector<CndLight> lights = randomSpheres(g, 40, 7);
    const Images read = uploadImages(g);
    constexpr VkDescriptorType image = VK_DESCRIPTOR_TYPE_SAMPLED_IMAGE;
    const gpu::Bindings host(device(), "host G-buffer",
                             {{0, image, 1}, {1, image, 1}, {2, image, 1}},
                             VK_SHADER_STAGE_COMPUTE_BIT, 1);
    host.write(0, {gpu::Binding::sampled(0, read.normalRoughness.view.get()),
                   gpu::Binding::sampled(1, read.albedo.view.get()),
                   gpu::Binding::sampled(2, read.specular.view.get())});
    RunOptions options{.layout = CND_GBUFFER_CUSTOM,
                       .hostKernels = kernels.value().hostKernels(host.layout()),
                       .hostSet = host.set(0)};
    const LightingResult together = run(g, lights, options);
    options.materialClasses = CND_MATERIAL_DIFFUSE_ONLY | CND_MATERIAL_SPECULAR_ONLY;
    const LightingResult apart = run(g, lights, options);
    EXPECT_LE(maxPixelDifference(apart.radiance, together.radiance), 1e-5);
    EXPECT_GT(apart.stats.diffuseTileCount, 8u);
    EXPECT_GT(apart.stats.specularTileCount, 8u);
    // Every second light is dimmed in all classes: the same as dimmed lights without functions.
    std::vector<CndLight> dimmed = lights;
    for (size_t i = 1; i < dimmed.size(); i += 2)
        for (float& e : dimmed[i].emission)
            e *= 0.25f;
    EXPECT_LE(maxRelativeDifference(apart.radiance, run(g, dimmed).radiance), 1e-4);
}

} // namespace candelabra::test
