// SPDX-License-Identifier: Apache-2.0
// The benchmarks at a small size: their kernels run without validation messages, and their results
// are consistent.
#include <cmath>

#include "generate/random.h"
#include "harness/full_tests.h"
#include "harness/gpu_fixture.h"
#include "harness/json_keys.h"
#include "measure/accuracy/image_level.h"
#include "measure/accuracy/kernel_level.h"
#include "measure/stability/stability.h"
#include "render/setting_names.h"
#include "scene/light_types.h"
#include "shading/light_family.h"

using namespace candelabra;
using namespace candelabra::app;

namespace
{

class Bench : public test::GpuTest
{
};

const KernelPoint& pointOf(const KernelLevel& level, const MeasuredMethod& method)
{
    for (const KernelPoint& p : level.points)
        if (p.method == method)
            return p;
    throw std::runtime_error("no such method");
}

} // namespace

TEST_F(Bench, KernelLevelMeasuresErrorAndTime)
{
    KernelLevelSettings settings{.lightTypes = {CND_LIGHT_RECTANGLE}, .groups = 60};
    settings.timing = {.lanes = 4096, .fewLights = 4, .manyLights = 12, .rounds = 2};
    Progress progress(1, false);
    const KernelLevel level = measureKernelLevel(context(), settings, progress);
    EXPECT_EQ(level.unconvergedTruths, 0u);
    ASSERT_EQ(level.points.size(), 4u); // karis, conic, sampled and ltc
    for (const KernelPoint& p : level.points) {
        const std::string name = methodName(p.method);
        const ErrorStatistics& all = p.error.mirror.all;
        std::cout << "rectangle " << name << ": mean error " << 100 * all.mean
                  << "% of the peak, form factor within " << p.error.diffuse.all.max << "\n";
        EXPECT_EQ(p.error.invalid, 0u) << name;
        EXPECT_EQ(p.error.leak, 0) << name;
        EXPECT_GT(all.count, 500u) << name;
        EXPECT_LE(all.mean, all.max) << name;
        EXPECT_LE(p.error.diffuse.all.max, 1e-5) << name;
        for (const KernelPoint::Case& c : p.cases)
            EXPECT_TRUE(std::isfinite(c.both.medianNs)) << name;
    }
    const auto mean = [&](const MeasuredMethod& method) {
        return pointOf(level, method).error.mirror.all.mean;
    };
    EXPECT_LT(mean(Rival::Ltc), mean(CND_SPECULAR_KARIS));
    EXPECT_LT(mean(CND_SPECULAR_CONIC), mean(Rival::Ltc));
    const auto json = nlohmann::json::parse(kernelJson(settings, level).dump());
    EXPECT_EQ(json["points"].size(), 4u);
    EXPECT_EQ(test::keyFaults(json, "bench-accuracy-kernels"), "");
    EXPECT_NE(textOf(kernelTables(level)).find("rectangle ltc"), std::string::npos);
}

TEST_F(Bench, SweepsAreReproducibleAndValid)
{
    const Evaluation karis{.lightType = CND_LIGHT_SPHERE, .method = CND_SPECULAR_KARIS};
    Sweep sweep(context(), karis, 5);
    for (uint32_t slice = 0; slice < sweepSliceCount; ++slice) {
        const SweepCount count = sweep.count(slice, 0, 20000, [](uint64_t) {});
        EXPECT_EQ(count.tried, 20000u);
        EXPECT_EQ(count.invalid(), 0u)
            << sliceText(slice) << ": " << (count.bad.empty() ? "" : describeRecord(count.bad[0]));
    }
    const auto a = sweep.record(gpu::SWEEP_ANYTHING, 0, 100),
               b = sweep.record(gpu::SWEEP_ANYTHING, 0, 100);
    double largest = 0;
    for (size_t i = 0; i < a.size(); ++i) {
        EXPECT_EQ(a[i].response, b[i].response);
        EXPECT_EQ(a[i].index, i);
        largest = std::max(largest, double(a[i].response.y));
    }
    EXPECT_GT(largest, 0);
}

TEST_F(Bench, ResponsesToEveryTypeAreValidInTheSweep)
{
    for (uint32_t type = 0; type < CND_LIGHT_TYPE_COUNT; ++type) {
        const Evaluation evaluation{.lightType = type,
                                    .method = lighting::canonicalMethod(type, CND_SPECULAR_CONIC)};
        Sweep sweep(context(), evaluation, 6);
        for (uint32_t slice = 0; slice < sweepSliceCount; ++slice) {
            const SweepCount count = sweep.count(slice, 0, 4000, [](uint64_t) {});
            EXPECT_EQ(count.invalid(), 0u)
                << lightTypeName(type) << ", " << sliceText(slice) << ": "
                << (count.bad.empty() ? "" : describeRecord(count.bad[0]));
        }
    }
}

// The representative point is continuous; a jump would reveal a wrong classification.
TEST_F(Bench, RepresentativePointHasNoJumps)
{
    const auto checks = checkContinuity(
        context(), {.lightType = CND_LIGHT_SPHERE, .method = CND_SPECULAR_KARIS}, 20, 1);
    ASSERT_EQ(checks.size(), 5u);
    for (const ContinuityCheck& c : checks) {
        std::cout << "through " << c.through << ": largest jump " << c.jump << " of the peak\n";
        EXPECT_LE(c.jump, 1e-3) << c.worst;
    }
}

// Whole frames compared with their truth. The last two scenes have lights other than spheres.
TEST_F(Bench, FramesByTheClosedFormAreNearTheTruth)
{
    ImageLevelSettings settings{.methods = {CND_SPECULAR_KARIS, CND_SPECULAR_CONIC, Rival::Ltc},
                                .size = test::fullTests() ? PixelSize{48, 36} : PixelSize{32, 24},
                                .rounds = 1};
    if (!test::fullTests())
        settings.scenes = {"glossy floor cut by a light", "large light at grazing angles",
                           "tube, rectangle, disc and sun"};
    Progress progress(1, false);
    const std::vector<ImageScene> scenes = measureImages(context(), settings, progress);
    ASSERT_EQ(scenes.size(), test::fullTests() ? benchScenes().size() : 3u);
    const auto json = nlohmann::json::parse(imageJson(settings, scenes)["scenes"].dump());
    EXPECT_EQ(test::keyFaults(json, "bench-accuracy-scenes"), "");
    for (const ImageScene& scene : scenes) {
        const bool spheresAlone =
            scene.name != "tube, rectangle, disc and sun" && scene.name != "showcase";
        ASSERT_EQ(scene.points.size(), spheresAlone ? 3u : 2u);
        const ImageDifference &karis = scene.points[0].error, &conic = scene.points[1].error;
        std::cout << scene.name << ": closed form: lit relMSE " << conic.litRelMse
                  << ", mean relative error " << conic.litMeanRel << ", relMSE " << conic.relMse
                  << ", FLIP " << conic.flip << "; of the representative point " << karis.relMse
                  << ", " << karis.flip << "\n";
        EXPECT_EQ(scene.unconverged, 0u);
        EXPECT_EQ(conic.invalid + karis.invalid, 0u);
        EXPECT_LT(conic.relMse, karis.relMse);
        EXPECT_LT(conic.flip, karis.flip);
        EXPECT_GT(scene.points[1].time.lightingMs, 0);
        EXPECT_GT(scene.points[1].time.bruteForceMs, 0);
        // Transformed cosines evaluate spheres, and the bars are for scenes that have only spheres.
        if (spheresAlone) {
            const ImageDifference& ltc = scene.points[2].error;
            std::cout << "  transformed cosines: " << ltc.relMse << ", " << ltc.flip << ", energy "
                      << ltc.energy << "\n";
            EXPECT_EQ(ltc.invalid, 0u);
            EXPECT_LT(conic.relMse, ltc.relMse);
            EXPECT_LE(std::abs(ltc.energy), 0.35);
            EXPECT_GT(scene.points[2].time.bruteForceMs, 0);
            const bool cut = scene.name == "glossy floor cut by a light";
            const bool grazing = scene.name == "large light at grazing angles";
            EXPECT_LE(conic.litRelMse, cut ? 2.5e-4 : 1e-4) << scene.name;
            EXPECT_LE(conic.litMeanRel, cut || grazing ? 0.006 : 0.005) << scene.name;
        }
    }
}

// Linearly transformed cosines were once a method of the engine. Their errors are as small as then.
TEST_F(Bench, TransformedCosinesAreAsGoodAsTheyWere)
{
    struct Case {
        uint32_t type;
        double mean, dielectricMean; // percent of the peak
    };
    for (const Case& c : {Case{CND_LIGHT_SPHERE, 2.7, 5.0}, Case{CND_LIGHT_RECTANGLE, 2.7, 4.85},
                          Case{CND_LIGHT_POLYGON, 2.5, 4.57}}) {
        SampleSet set = makeSamples(c.type, 60, 1);
        integrateTruth(set, 1e-5, [](size_t) {});
        const LightEvaluator evaluator(context(), {.lightType = c.type, .method = Rival::Ltc});
        const KernelError error = kernelError(set, evaluator.evaluate(set.receivers, set.lights));
        const double mean = 100 * error.mirror.all.mean;
        const double dielectric = 100 * error.dielectric.all.mean;
        std::cout << lightTypeName(c.type) << ": mean error " << mean << "%, with F0 = 0.04 "
                  << dielectric << "%, form factor within " << error.diffuse.all.max << "\n";
        EXPECT_NEAR(mean, c.mean, 0.25 * c.mean);
        EXPECT_NEAR(dielectric, c.dielectricMean, 0.25 * c.dielectricMean);
        EXPECT_LE(error.diffuse.all.max, 1e-5);
        EXPECT_EQ(error.invalid, 0u);
    }
}

// Spheres that are below the horizon, by a hair or more, contribute exactly nothing with every
// method.
TEST_F(Bench, SpheresBelowTheHorizonGiveExactlyNothing)
{
    Random random(1, 7);
    std::vector<gpu::BenchReceiver> receivers;
    std::vector<CndLight> lights;
    for (int i = 0; i < 30000; ++i) {
        const double s = std::pow(10.0, double(random.uniform(-3, -0.01f)));
        const double below = std::pow(10.0, double(random.uniform(-6, 0)));
        const double z = -std::min(s + below, 1.0), r = std::sqrt(std::max(1 - z * z, 0.0));
        const double azimuth = 6.283185307 * double(random.uniform());
        const float NoV = random.uniform(0.02f, 1);
        receivers.push_back({.n = {0, 0, 1},
                             .v = {std::sqrt(1 - NoV * NoV), 0, NoV},
                             .perceptualRoughness = random.uniform(0, 1)});
        CndLight light{.radius = float(s)};
        const glm::vec3 to(r * std::cos(azimuth), r * std::sin(azimuth), z);
        for (int k = 0; k < 3; ++k) {
            light.position[k] = to[k];
            light.direction[k] = -to[k];
        }
        lights.push_back(light);
    }
    for (const CndLightType type : {CND_LIGHT_SPHERE, CND_LIGHT_DISTANT_SPHERE})
        for (const CndSpecularMethod method : methodsOf(type)) {
            for (CndLight& light : lights)
                light.type = type;
            const LightEvaluator evaluator(context(), {.lightType = type, .method = method});
            double largest = 0;
            for (const gpu::BenchResponse& response : evaluator.evaluate(receivers, lights))
                largest =
                    std::max({largest, double(response.f), double(response.a), double(response.b)});
            std::cout << lightTypeName(type) << " " << specularName(method) << ": largest "
                      << largest << "\n";
            EXPECT_EQ(largest, 0) << lightTypeName(type) << " " << specularName(method);
        }
}
