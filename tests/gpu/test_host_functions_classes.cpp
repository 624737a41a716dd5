// SPDX-License-Identifier: Apache-2.0
// Tests tiles without a specular lobe with kernels that contain functions of a host: one that reads
// surfaces, and a shadow term.
#include <string>

#include "candelabra/compiler.hpp"
#include "gpu/host_surface.h"
#include "gpu/pixel_difference.h"
#include "gpu/two_classes.h"

namespace candelabra::test
{
namespace
{

constexpr const char* halfShadowSource = R"(
float candelabraVisibility(CndShadowQuery q)
{
    return q.light % 2u == 0u ? 1.0 : 0.25;
}
)";

} // namespace

TEST_F(LightingTest, ClassesOfSurfacesThatTheHostReadsLookTheSame)
{
    const std::string source = std::string(surfaceSource) + halfShadowSource;
    auto kernels = CompiledKernels::create(
        {.functions = CND_HOST_VISIBILITY_BIT | CND_HOST_READ_SURFACE_BIT,
         .source = source.c_str(),
         .lightTypes = 1u << CND_LIGHT_SPHERE,
         .specularMethods = 1u << RunOptions{}.specular | 1u << CND_SPECULAR_NONE});
    ASSERT_TRUE(kernels) << kernels.error().message;
    const CpuGBuffer g = twoClasses(72, 48);
    const std::vector<CndLight> lights = randomSpheres(g, 40, 7);
    const Images read = uploadImages(g);
    const gpu::Bindings host = surfaceSet(device(), read);
    RunOptions options{.layout = CND_GBUFFER_CUSTOM,
                       .hostKernels = kernels.value().hostKernels(host.layout()),
                       .hostSet = host.set(0)};
    const LightingResult together = run(g, lights, options);
    options.diffuseOnlyTiles = true;
    const LightingResult apart = run(g, lights, options);
    EXPECT_LE(maxPixelDifference(apart.radiance, together.radiance), 1e-5);
    EXPECT_GT(apart.stats.diffuseTileCount, 8u);
    // Every second light is dimmed in all classes, which must equal dimmed lights without host
    // functions.
    std::vector<CndLight> dimmed = lights;
    for (size_t i = 1; i < dimmed.size(); i += 2)
        for (float& e : dimmed[i].emission)
            e *= 0.25f;
    EXPECT_LE(maxRelativeDifference(apart.radiance, run(g, dimmed).radiance), 1e-4);
}

} // namespace candelabra::test
