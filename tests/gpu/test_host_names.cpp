// SPDX-License-Identifier: Apache-2.0
// Functions of a host may have any name that the engine's own GLSL has
// (shaders/host_shaders.cmake).
#include <fstream>
#include <regex>
#include <set>
#include <sstream>

#include "candelabra/compiler.hpp"
#include "gpu/host_surface.h"
#include "gpu/lighting_harness.h"
#include "harness/paths.h"

namespace candelabra::test
{
namespace
{

constexpr const char* halfShadow = R"(
float candelabraVisibility(CndShadowQuery q)
{
    return q.light % 2u == 0u ? 1.0 : 0.25;
}
)";

// Appends a file of shaders/ and before it what it includes, with include guards of its own, so
// that all its names are declared where the text stands.
void append(const std::string& name, std::string& text, std::set<std::string>& done)
{
    if (name == "shared/prelude.h" || !done.insert(name).second)
        return;
    std::ifstream file(sourcePath("shaders/" + name));
    EXPECT_TRUE(file) << name;
    std::ostringstream own;
    for (std::string line; std::getline(file, line);) {
        if (line.starts_with("#include \""))
            append(line.substr(10, line.rfind('"') - 10), text, done);
        else if (!line.starts_with("#extension"))
            own << std::regex_replace(line, std::regex("\\bCND_"), "HOST_") << '\n';
    }
    text += own.str();
}

// Returns a host's source with all names of these parts of shaders/lib and shaders/shared, and with
// names of the kernels and of shaders/shading. It reads the FULL layout with functions of its own.
std::string sourceWithOurNames()
{
    std::string text = "#define GPU_BEGIN\n#define GPU_END\n#define GPU_SIZE(Type, bytes)\n"
                       "#define FORWARD_SET 1\n";
    std::set<std::string> done;
    for (const char* file :
         {"lib/gbuffer.glsl", "lib/outline/shading.glsl", "lib/specular/conic_shading.glsl",
          "lib/specular/sampled.glsl", "lib/lights/sphere_cap.glsl", "lib/light_tree_walk.glsl",
          "lib/cluster_test.glsl", "lib/projection.glsl", "lib/shadow_query.glsl", "shared/frame.h",
          "shared/host_gbuffer_data.h"})
        append(file, text, done);
    return text + R"(
layout(set = 1, binding = 0) uniform utexture2D packedNormalImage;
layout(set = 1, binding = 1) uniform utexture2D packedAlbedoImage;
layout(set = 1, binding = 2) uniform utexture2D packedSpecularImage;
const uint gbufferLayout = 77u, tileClass = 78u;
struct Receiver { float params; };
struct Light { uint index; };
struct Sums { vec3 above; };
uint lightType, frameParams, lightIds, params, counters, tiles, lights, main_;
vec3 hostNormal(vec4 texel) { return 0.5 * texel.xyz; }
vec3 unitNormal(vec3 n) { return 2.0 * n; }
Receiver makeReceiver(Light light) { return Receiver(float(light.index)); }
Sums shadeBlock(Sums sums) { return sums; }
Surface readSurface(ivec2 pixel)
{
    Surface s = unpackGBufferFull(texelFetch(packedNormalImage, pixel, 0).xy,
                                  texelFetch(packedAlbedoImage, pixel, 0).xy,
                                  texelFetch(packedSpecularImage, pixel, 0).xy);
    s.normal = unitNormal(hostNormal(vec4(s.normal, 0.0)));
    return s;
}
CndSurface candelabraReadSurface(ivec2 pixel)
{
    const Surface s = readSurface(pixel);
    return CndSurface(s.normal, s.albedo, s.F0, s.specularWeight, s.perceptualRoughness);
}
)";
}

TEST_F(LightingTest, HostsMayUseTheNamesOfOurShaders)
{
    const CpuGBuffer g = randomGBuffer(48, 40, 5);
    const std::vector<CndLight> lights = randomSpheres(g, 40, 7);
    const Images read = uploadImages(g);
    const gpu::Bindings host = surfaceSet(device(), read);
    std::vector<LightingResult> results;
    for (const std::string& reading : {sourceWithOurNames(), std::string(surfaceSource)}) {
        const std::string source = reading + halfShadow;
        auto kernels = CompiledKernels::create(
            {.functions = CND_HOST_VISIBILITY_BIT | CND_HOST_READ_SURFACE_BIT,
             .source = source.c_str(),
             .lightTypes = 1u << CND_LIGHT_SPHERE,
             .specularMethods = 1u << RunOptions{}.specular});
        ASSERT_TRUE(kernels) << kernels.error().message;
        results.push_back(run(g, lights,
                              RunOptions{.layout = CND_GBUFFER_CUSTOM,
                                         .hostKernels = kernels.value().hostKernels(host.layout()),
                                         .hostSet = host.set(0)}));
    }
    EXPECT_TRUE(sameBits(results[0], results[1]));
    EXPECT_FALSE(sameBits(results[0], run(g, lights, {}))); // which has no shadow term
}

} // namespace
} // namespace candelabra::test
