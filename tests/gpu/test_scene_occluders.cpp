// SPDX-License-Identifier: Apache-2.0
// Tests that the renderer makes occluders of the same surfaces as the truth, from their meshes,
// planes and balls, with their layers.
#include <cmath>
#include <iostream>
#include <numeric>

#include <glm/gtc/matrix_transform.hpp>

#include "generate/generators.h"
#include "generate/shapes.h"
#include "harness/gpu_fixture.h"
#include "measure/frame/frames.h"
#include "reference/render.h"
#include "render/readback.h"
#include "render/renderer.h"
#include "truth/reference_scene.h"

using namespace candelabra;
using namespace candelabra::app;

namespace
{

constexpr PixelSize imageSize{64, 40};

CndLight sphereLight(const glm::vec3& at, float radius)
{
    CndLight out{};
    out.type = CND_LIGHT_SPHERE;
    for (int i = 0; i < 3; ++i) {
        out.position[i] = at[i];
        out.emission[i] = 10 / (radius * radius);
    }
    out.radius = radius;
    out.influenceRadius = INFINITY;
    return out;
}

// A plane with things above it that shadow it and each other.
Scene thingsOnAPlane()
{
    Scene scene;
    scene.lobes = CND_LOBES_SUM;
    Material matt{.baseColor = glm::vec3(0.7f),
                  .dielectricF0 = glm::vec3(0),
                  .specularWeight = 0,
                  .doubleSided = true};
    scene.materials.push_back(matt);
    matt.alphaMode = AlphaMode::Mask;
    scene.materials.push_back(matt);
    matt.alphaMode = AlphaMode::Blend;
    scene.materials.push_back(matt);
    scene.meshes = {makeBox(), makeGround(1)};
    const auto place = [&](uint32_t mesh, uint32_t material, const glm::dvec3& at,
                           const glm::dmat4& linear) {
        scene.instances.push_back({mesh, material, glm::translate(glm::dmat4(1), at) * linear});
    };
    const glm::dmat4 one(1);
    place(0, 0, {-1.6, 0.4, 0}, glm::scale(one, {0.4, 0.8, 1.1}));
    place(0, 0, {-0.6, 0.3, -0.5}, glm::scale(glm::rotate(one, 0.5, {0, 1, 0}), {0.5, 0.6, 0.5}));
    place(1, 1, {1.4, 0.7, 0.4}, one); // masked, and there
    place(1, 2, {0.3, 0.7, 1.4}, one); // blended, and seen as if opaque
    // What the second column is makes no difference to a square at y = 0.
    glm::dmat4 flat(1);
    flat[1] = glm::dvec4(1, 4e-5, 0, 0);
    place(1, 0, {-1.2, 1.1, 1}, flat);
    scene.analyticObjects = {
        {},
        {.type = AnalyticObject::Type::Ball, .point = {0.4, 0.45, -0.2}, .radius = 0.4},
        {.type = AnalyticObject::Type::Ball,
         .point = {1.5, 0.4, -1},
         .radius = 0.3,
         .occluderLayer = 3}};
    scene.lights = {sphereLight({1, 2.5f, 1}, 0.2f), sphereLight({-2, 2, -1}, 0.1f),
                    sphereLight({0, -1, 0}, 0.3f)}; // the last below the plane
    scene.lights[0].unshadowedBy = 1u << 3;
    const glm::dvec3 eye(0.5, 2.2, 4.5);
    scene.cameras.push_back(
        {.position = eye, .forward = glm::normalize(glm::dvec3(0, 0.3, 0) - eye)});
    return scene;
}

class SceneOccluders : public test::GpuTest
{
protected:
    Image draw(const Scene& scene, uint32_t shadows) const
    {
        FrameOptions frame{.camera = scene.cameras[0],
                           .lightsVisible = false,
                           .levels = false,
                           .shadows = shadows};
        cndDefaultExposureSettings(&frame.exposure);
        Renderer renderer(
            context(), scene,
            {.size = imageSize, .specularMethods = 1u << frame.specular, .shadows = shadows});
        context().submitAndWait([&](VkCommandBuffer cmd) { renderer.record(cmd, 0, frame); });
        return readRadiance(context(), renderer);
    }
    static std::vector<glm::dvec3> truth(const Scene& scene, bool shadows)
    {
        std::vector<uint32_t> rows(imageSize.height);
        std::iota(rows.begin(), rows.end(), 0u);
        return reference::renderTruth(
                   toReference(scene, scene.cameras[0], double(imageSize.width) / imageSize.height,
                               false),
                   imageSize.width, imageSize.height, rows, {.relative = 1e-3, .shadows = shadows})
            .pixels;
    }
};

// The mean of the errors of all pixels, as a share of their mean.
double meanError(const Image& image, const std::vector<glm::dvec3>& truth)
{
    double error = 0, sum = 0;
    for (size_t i = 0; i < truth.size(); ++i) {
        error += std::abs(double(image.pixels[3 * i]) - truth[i].x);
        sum += truth[i].x;
    }
    return error / sum;
}

} // namespace

TEST_F(SceneOccluders, AreWhatCastsShadowsInTheTruth)
{
    const Scene scene = thingsOnAPlane();
    const Image shadowed = draw(scene, 64), unshadowed = draw(scene, 0);
    const std::vector<glm::dvec3> exact = truth(scene, true);
    const double error = meanError(shadowed, exact);
    std::cout << "mean error " << error << ", of the unshadowed picture "
              << meanError(unshadowed, exact) << "\n";
    EXPECT_LT(meanError(unshadowed, truth(scene, false)), 1e-3);
    EXPECT_GT(meanError(unshadowed, exact), 0.1);
    EXPECT_LT(error, 3e-3);
}

TEST_F(SceneOccluders, UnshadowedLightsHaveNoShadows)
{
    Scene scene = thingsOnAPlane();
    for (CndLight& light : scene.lights)
        light.unshadowed = VK_TRUE;
    EXPECT_LT(meanError(draw(scene, 32), truth(scene, false)), 1e-3);
}

// In rooms many of the lights in reach are proven to be behind walls. That changes no pixel: brute
// force has no lists and no proofs.
TEST_F(SceneOccluders, WallsRemoveLightsAndNoPixelChanges)
{
    const Scene scene = generateRooms({.lights = 300, .overlaps = 20});
    for (const Camera& camera : scene.cameras) {
        FrameOptions frame{
            .camera = camera, .lightsVisible = false, .levels = false, .shadows = 32};
        cndDefaultExposureSettings(&frame.exposure);
        Renderer renderer(context(), scene, {.size = imageSize, .shadows = 32});
        const CndLightingStats stats = countPairs(context(), renderer, frame);
        const Image listed = readRadiance(context(), renderer);
        EXPECT_GT(stats.wonProofs, stats.triedProofs / 4);
        EXPECT_GT(stats.hiddenEntries, stats.listEntries / 20);
        std::cout << stats.wonProofs << " of " << stats.triedProofs << " proofs won, "
                  << stats.hiddenEntries << " of " << stats.listEntries
                  << " lights hidden in lists\n";
        frame.culling = CND_CULLING_BRUTE;
        context().submitAndWait([&](VkCommandBuffer cmd) { renderer.record(cmd, 0, frame); });
        const Image brute = readRadiance(context(), renderer);
        size_t differ = 0;
        for (size_t i = 0; i < listed.pixels.size(); ++i)
            differ += std::abs(listed.pixels[i] - brute.pixels[i]) >
                      (device().lanesAreCpuVector ? 0 : 1e-5f * std::abs(brute.pixels[i]));
        EXPECT_EQ(differ, 0u);
    }
}
