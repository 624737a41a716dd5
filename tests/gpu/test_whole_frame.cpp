// SPDX-License-Identifier: Apache-2.0
// Tests whole frames of the program, from the scene description to radiance, against an independent
// path tracer (Lambertian surfaces and a dielectric) and against the double-precision reference of
// the same model (every material).
#include <cmath>
#include <iostream>
#include <iterator>
#include <numeric>
#include <span>

#include "data/path_traced.h"
#include "harness/gpu_fixture.h"
#include "harness/temporary_folder.h"
#include "render/camera.h"
#include "render/readback.h"
#include "truth/reference_scene.h"
#include "json/scene_json.h"

using namespace candelabra;
using namespace candelabra::app;

namespace
{

// Returns a scene description in JSON; `object` and `lights` are JSON fragments.
std::string sceneJson(const std::string& camera, const std::string& object,
                      const std::string& material, const std::string& lights)
{
    return R"({"camera": )" + camera + R"(, "object": )" + object + R"(, "material": )" + material +
           R"(, "lights": )" + lights +
           R"(, "resolution": [256, 256], "lights_visible_to_camera": false})";
}

constexpr const char* lambert = R"({"albedo": [0.8, 0.8, 0.8], "diffuse": true, "specular": false,
    "F0": [0, 0, 0], "alpha": 1, "metalness": 0})";
constexpr const char* ground = R"({"type": "plane", "point": [0, 0, 0], "normal": [0, 1, 0]})";
constexpr const char* ball = R"({"type": "sphere", "center": [0, 0, 0], "radius": 1})";

class WholeFrame : public test::GpuTest
{
protected:
    Scene load(const std::string& json)
    {
        return loadSceneJson(test::TemporaryFolder().write("scene.json", json));
    }
    Image draw(const Scene& scene, PixelSize size, CndSpecularMethod specular)
    {
        FrameOptions frame{
            .camera = selectCamera(scene, ""), .lightsVisible = false, .specular = specular};
        cndDefaultExposureSettings(&frame.exposure);
        // The pipelines of other methods would take longer than the frame.
        Renderer renderer(context(), scene, {.size = size, .specularMethods = 1u << specular});
        context().submitAndWait([&](VkCommandBuffer cmd) { renderer.record(cmd, 0, frame); });
        return readRadiance(context(), renderer);
    }
};

double meanRelativeError(const Image& image, std::span<const test::PathTracedPixel<1>> truth)
{
    double sum = 0;
    for (const auto& pixel : truth) {
        const double value = image.pixels[3 * (size_t(pixel.row) * image.width + pixel.column) + 1];
        sum += std::abs(value - pixel.luminance[0]) / pixel.luminance[0];
    }
    return sum / double(truth.size());
}

} // namespace

TEST_F(WholeFrame, LambertPlaneMatchesThePathTracer)
{
    const Scene above = load(sceneJson(
        R"({"position": [0, 2, 4], "look_at": [0, 0, 0], "up": [0, 1, 0],
            "vertical_fov_degrees": 45, "aspect": 1})",
        ground, lambert, R"([{"position": [0, 3, 0], "radius": 0.5, "radiance": [10, 10, 10]}])"));
    const double aboveError =
        meanRelativeError(draw(above, {256, 256}, CND_SPECULAR_KARIS), test::planeAbove);
    const Scene cut = load(sceneJson(
        R"({"position": [3.1, 4, 0], "look_at": [3.1, 0, 0], "up": [0, 0, -1],
            "vertical_fov_degrees": 56, "aspect": 1})",
        ground, lambert, R"([{"position": [0, -0.4, 0], "radius": 1, "radiance": [10, 10, 10]}])"));
    const double cutError =
        meanRelativeError(draw(cut, {256, 256}, CND_SPECULAR_KARIS), test::planeCrossing);
    std::cout << "mean relative error to the path tracer: above " << aboveError << ", cut by the "
              << "plane " << cutError << "\n";
    // The bound is 0.3% plus 0.8 times the reference's own rms noise (0.0278% and 0.446%).
    EXPECT_LE(aboveError, 0.003 + 0.8 * 0.000278);
    EXPECT_LE(cutError, 0.003 + 0.8 * 0.00446);
}

// The closed form at grazing angles, compared without using the formulas of our reference.
TEST_F(WholeFrame, ConicMatchesThePathTracer)
{
    const Scene scene = load(sceneJson(
        R"({"position": [0, 0.5, 3], "look_at": [0, 0, 0.6476849452607727], "up": [0, 1, 0],
            "vertical_fov_degrees": 20, "aspect": 1})",
        ground, R"({"albedo": [0.2, 0.3, 0.5], "F0": [0.04, 0.04, 0.04], "alpha": 0.1,
            "metalness": 0})",
        R"([{"position": [0.5, 1.2, -3], "radius": 0.4, "radiance": [10, 10, 10]}])"));
    const Image image = draw(scene, {256, 256}, CND_SPECULAR_CONIC);
    double sum = 0, squares = 0;
    for (const auto& pixel : test::dielectricGrazing)
        for (uint32_t c = 0; c < 3; ++c) {
            const size_t at = 3 * (size_t(pixel.row) * image.width + pixel.column) + c;
            const double error = image.pixels[at] / pixel.luminance[c] - 1;
            sum += std::abs(error);
            squares += error * error;
        }
    const double count = 3 * double(std::size(test::dielectricGrazing));
    std::cout << "conic to the path tracer: mean relative error " << sum / count << ", relMSE "
              << squares / count << " (the path tracer's noise: 0.0052 rms, 2.7e-5)\n";
    // Measured 0.0041 and 6.0e-5.
    EXPECT_LE(sum / count, 0.0052);
    EXPECT_LE(squares / count, 8e-5);
}

namespace
{

constexpr const char* materialCamera = R"({"position": [0.3, 1.6, 3.2], "look_at": [0, 0, 0],
    "up": [0, 1, 0], "vertical_fov_degrees": 40, "aspect": 1})";
// Lights above, crossing and below the horizon of the ground.
constexpr const char* materialLights = R"([
    {"position": [1.5, 2, 1], "radius": 0.4, "radiance": [20, 10, 5]},
    {"position": [-2, 0.3, -1], "radius": 0.6, "radiance": [3, 12, 30]},
    {"position": [2.5, -1.2, 0], "radius": 0.7, "radiance": [10, 10, 10]}])";
// From rough to smooth and from metal to dielectric; the last one has numbers that no format of the
// G-buffer stores exactly.
constexpr const char* materials[] = {
    R"({"albedo": [0.75, 0.5, 0.25], "diffuse": true, "specular": true,
        "F0": [0.0625, 0.0625, 0.0625], "alpha": 0.25, "metalness": 0})",
    R"({"albedo": [0, 0, 0], "diffuse": false, "specular": true, "F0": [1, 0.75, 0.25],
        "alpha": 0.04, "metalness": 1})",
    R"({"albedo": [0.5, 0.5, 0.5], "diffuse": true, "specular": true,
        "F0": [0.0625, 0.0625, 0.0625], "alpha": 0.01, "metalness": 0})",
    R"({"albedo": [0.3, 0.3, 0.3], "diffuse": true, "specular": true, "F0": [0.7, 0.3, 0.013],
        "alpha": 0.1, "metalness": 0})"};

} // namespace

// The closed form in whole frames, which users get by default, against integration in double
// precision; every material on plane and ball.
TEST_F(WholeFrame, ConicIsCloseToTheTruth)
{
    constexpr uint32_t side = 48;
    std::vector<uint32_t> rows(side);
    std::iota(rows.begin(), rows.end(), 0u);
    for (const char* object : {ground, ball})
        for (const char* material : materials) {
            const Scene scene = load(sceneJson(materialCamera, object, material, materialLights));
            const reference::TruthRows truth = reference::renderTruth(
                toReference(scene, scene.cameras[0], 1, false), side, side, rows, {});
            EXPECT_EQ(truth.unconverged, 0u);
            const Image image = draw(scene, {side, side}, CND_SPECULAR_CONIC);
            double peak = 0, worst = 0, sum = 0, total = 0;
            for (size_t i = 0; i < truth.pixels.size(); ++i)
                for (int c = 0; c < 3; ++c) {
                    const double value = image.pixels[3 * i + size_t(c)];
                    const double error = std::abs(value - truth.pixels[i][c]);
                    ASSERT_TRUE(std::isfinite(error)) << i;
                    worst = std::max(worst, error);
                    sum += error;
                    peak = std::max(peak, truth.pixels[i][c]);
                    total += truth.pixels[i][c];
                }
            ASSERT_GT(peak, 0);
            std::cout << "conic to the truth: error " << sum / total << " of the light, largest "
                      << worst / peak << " of the peak\n";
            // Measured 0.0003..0.0041 and 0.0005..0.034; both are largest for the rough dielectric
            // ball. The largest error of the last material, 0.050, is in blue, whose F0 of 0.013
            // leaves nearly everything to Fresnel's rise at grazing angles.
            const double bound = material == materials[3] ? 0.055 : 0.04;
            EXPECT_LE(sum / total, 0.005) << object << material;
            EXPECT_LE(worst / peak, bound) << object << material;
        }
}

// Joined lobes and energy compensation must equal the double-precision reference.
TEST_F(WholeFrame, JoinedLobesMatchTheDoubleReference)
{
    constexpr uint32_t side = 24;
    for (const char* material : materials)
        for (const bool compensated : {false, true}) {
            Scene scene = load(sceneJson(materialCamera, ball, material, materialLights));
            scene.lobes = CND_LOBES_CONSERVING;
            scene.energyCompensation = compensated;
            const Image image = draw(scene, {side, side}, CND_SPECULAR_KARIS);
            const reference::Image expected = reference::render(
                toReference(scene, scene.cameras[0], 1, false), side, side, CND_SPECULAR_KARIS);
            double peak = 0, worst = 0;
            for (const glm::dvec3& pixel : expected.pixels)
                peak = std::max({peak, pixel.x, pixel.y, pixel.z});
            for (size_t i = 0; i < expected.pixels.size(); ++i)
                for (int c = 0; c < 3; ++c) {
                    const double truth = expected.pixels[i][c];
                    const double error = std::abs(image.pixels[3 * i + size_t(c)] - truth);
                    worst = std::max(worst, error / (truth + 1e-3 * peak));
                }
            ASSERT_GT(peak, 0);
            std::cout << "joined lobes, largest relative error to double: " << worst << "\n";
            // The error comes from the table of directional albedos; measured 5e-4.
            EXPECT_LE(worst, 1.2e-3) << material << compensated;
        }
}

TEST_F(WholeFrame, EveryMaterialMatchesTheDoubleReference)
{
    for (const char* object : {ground, ball})
        for (const char* material : materials) {
            const Scene scene = load(sceneJson(materialCamera, object, material, materialLights));
            const Image image = draw(scene, {128, 128}, CND_SPECULAR_KARIS);
            const reference::Image expected = reference::render(
                toReference(scene, scene.cameras[0], 1, false), 128, 128, CND_SPECULAR_KARIS);
            double peak = 0, worst = 0;
            for (const glm::dvec3& pixel : expected.pixels)
                peak = std::max({peak, pixel.x, pixel.y, pixel.z});
            size_t worstPixel = 0;
            for (size_t i = 0; i < expected.pixels.size(); ++i)
                for (int c = 0; c < 3; ++c) {
                    const double value = image.pixels[3 * i + size_t(c)];
                    const double truth = expected.pixels[i][c];
                    // Relative where lit; relative to a thousandth of the peak where dark.
                    const double error = std::abs(value - truth) / (truth + 1e-3 * peak);
                    if (!(error <= worst)) {
                        worst = error;
                        worstPixel = i;
                    }
                }
            ASSERT_GT(peak, 0);
            std::cout << "largest relative error to double: " << worst << "\n";
            // Roughness is stored with an error of 1.5e-5, which counts four times at the peak;
            // positions contribute 2e-7 / alpha.
            EXPECT_LE(worst, 2e-3)
                << object << material << " pixel " << worstPixel % 128 << "," << worstPixel / 128;
        }
}

// Colours that no format stores exactly cost less than the rounding of floats in shading: a
// Lambertian plane of albedo 0.3 under a light that it sees completely, where the form factor is
// exact.
TEST_F(WholeFrame, AlbedoIsStoredToTheLastDigits)
{
    const Scene scene = load(sceneJson(
        R"({"position": [0, 2, 4], "look_at": [0, 0, 0], "up": [0, 1, 0],
            "vertical_fov_degrees": 45, "aspect": 1})",
        ground, R"({"albedo": [0.3, 0.7, 0.013], "diffuse": true, "specular": false,
            "F0": [0, 0, 0], "alpha": 1, "metalness": 0})",
        R"([{"position": [0, 3, 0], "radius": 0.5, "radiance": [10, 10, 10]}])"));
    constexpr uint32_t side = 64;
    const Image image = draw(scene, {side, side}, CND_SPECULAR_KARIS);
    const reference::Image expected = reference::render(
        toReference(scene, scene.cameras[0], 1, false), side, side, CND_SPECULAR_KARIS);
    double worst = 0, sum = 0;
    size_t lit = 0;
    for (size_t i = 0; i < expected.pixels.size(); ++i)
        for (int c = 0; c < 3; ++c) {
            if (expected.pixels[i][c] == 0)
                continue;
            const double error = image.pixels[3 * i + size_t(c)] / expected.pixels[i][c] - 1;
            worst = std::max(worst, std::abs(error));
            sum += error;
            ++lit;
        }
    ASSERT_GT(lit, side * side);
    std::cout << "albedo 0.3, 0.7, 0.013: mean relative error " << sum / double(lit) << ", largest "
              << worst << "\n";
    // Half floats cost 6.5e-4, 4.2e-4 and 5.5e-4 where a device truncates.
    EXPECT_LE(std::abs(sum / double(lit)), 2e-6);
    EXPECT_LE(worst, 1e-5);
}
