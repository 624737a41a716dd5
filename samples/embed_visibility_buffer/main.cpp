// SPDX-License-Identifier: Apache-2.0
// A renderer with a visibility buffer: its raster pass writes only which object and which triangle
// a pixel shows. Candelabra's kernels find the surface through a GLSL function of the host
// (CND_GBUFFER_CUSTOM, surface.glsl), which fetches the vertices and interpolates between them. The
// sample writes embed_visibility_buffer.ppm (or the file named as argument), compares it with the
// light on a plain G-buffer of the same scene, and exits with 1 if they differ.
#include <algorithm>
#include <cmath>
#include <cstdio>
#include <string>
#include <vector>

#include <candelabra/compiler.hpp>
#include <candelabra/glm.hpp>
#include <glm/gtc/matrix_transform.hpp>
#include <glm/gtc/type_ptr.hpp>

#include "picture.h"
#include "scene.h"

constexpr const char* sceneSource =
#include "scene_glsl.inc"
    ;
constexpr const char* surfaceSource =
#include "surface_glsl.inc"
    ;

static std::vector<CndLight> lamps()
{
    std::vector<CndLight> out(16,
                              {.type = CND_LIGHT_SPHERE, .radius = 0.06f, .influenceRadius = 3});
    for (size_t i = 0; i < out.size(); ++i) {
        const float angle = 2.39996f * float(i), far = 0.75f * std::sqrt(float(i) + 0.5f);
        const glm::vec3 colour = i % 2 ? glm::vec3(1, 0.6f, 0.3f) : glm::vec3(0.4f, 0.6f, 1);
        candelabra::assign(out[i].position,
                           glm::vec3(far * std::cos(angle), 0.9f, far * std::sin(angle)));
        candelabra::assign(out[i].emission, 3000.0f * colour); // cd/m^2
    }
    return out;
}

// Draws with `drawSurfaces`, lights what it has drawn, and returns the radiance.
static std::vector<float> lit(Host& host, const Scene& scene, const CndLightingDesc& desc,
                              void (*drawSurfaces)(const Host&, const Scene&))
{
    auto lighting = *candelabra::Lighting::create(deviceOf(host), desc);
    auto view = *lighting.createView({.maxWidth = host.width, .maxHeight = host.height});
    lighting.setLights(lamps(), {0, 0, 0}).value();

    const VkCommandBuffer cmd = beginFrame(&host);
    drawSurfaces(host, scene);
    CndLightingFrame frame{.width = host.width,
                           .height = host.height,
                           .camera = host.camera,
                           .clearDepth = 0,
                           .depth = host.depth.view,
                           .radiance = host.radiance.view};
    if (desc.gbufferLayout == CND_GBUFFER_CUSTOM) {
        frame.hostSet = scene.set; // the kernels find surfaces through it
    } else {
        frame.normalRoughness = host.normalRoughness.view;
        frame.albedo = host.albedo.view;
        frame.specular = host.specular.view;
    }
    view.record(cmd, frame).value();
    endFrame(&host);
    std::vector<float> radiance(size_t(host.width) * host.height * 4);
    readPixels(&host, &host.radiance, storageWrite, radiance.data(),
               radiance.size() * sizeof(float));
    return radiance;
}

static bool isRight(const std::vector<float>& found, const std::vector<float>& expected)
{
    double largest = 0, brightest = 0;
    size_t lights = 0;
    for (size_t i = 0; i < found.size(); ++i) {
        largest = std::max(largest, std::abs(double(found[i]) - double(expected[i])));
        brightest = std::max(brightest, double(expected[i]));
        lights += expected[i] > 1;
    }
    std::printf(
        "%zu values above 1 cd/m^2; the largest difference from a plain G-buffer is %.1e of "
        "the brightest\n",
        lights, largest / brightest);
    return lights > 50000 && largest < 1e-3 * brightest;
}

int main(int argc, char** argv)
{
    Host host = createHost(320, 200);
    host.camera = candelabra::camera(
        glm::rotate(glm::translate(glm::dmat4(1), {0, 0, -5}), glm::radians(35.0), {1, 0, 0}),
        glm::make_mat4(host.camera.clipFromView));
    const Scene scene = createScene(host);
    const std::string source = std::string("#define SCENE_SET 1\n") + sceneSource + surfaceSource;
    const auto kernels =
        *candelabra::CompiledKernels::create({.functions = CND_HOST_READ_SURFACE_BIT,
                                              .source = source.c_str(),
                                              .sourceName = "surface.glsl",
                                              .lightTypes = 1u << CND_LIGHT_SPHERE});
    const std::vector<float> visibility = lit(host, scene,
                                              {.framesInFlight = 1,
                                               .gbufferLayout = CND_GBUFFER_CUSTOM,
                                               .hostKernels = kernels.hostKernels(scene.setLayout)},
                                              drawIds);
    const std::vector<float> plain = lit(host, scene, {.framesInFlight = 1}, drawGBuffer);
    writePicture(argc > 1 ? argv[1] : "embed_visibility_buffer.ppm", &host, visibility.data(), 60);
    const bool right = isRight(visibility, plain);
    destroyScene(host, scene);
    destroyHost(&host);
    std::puts(right ? "right" : "WRONG");
    return right ? 0 : 1;
}
