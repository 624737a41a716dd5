// SPDX-License-Identifier: Apache-2.0
// The error of the responses by outline on the GPU, in float32, against quadrature, and its parts,
// those of the formula and of its rounding: percent of the highest true response among the light
// directions of a group (one roughness, view and light).
#include <cmath>

#include "harness/full_tests.h"
#include "harness/gpu_fixture.h"
#include "measure/accuracy/kernel_error.h"
#include "measure/accuracy/sample_set.h"
#include "measure/kernels/in_double.h"
#include "measure/kernels/light_kernels.h"
#include "scene/light_types.h"
#include "scene/polygons.h"

using namespace candelabra;
using namespace candelabra::app;

namespace
{

class OutlineAccuracy : public test::GpuTest
{
protected:
    // Also prints the errors and expects that all responses are finite and >= 0.
    KernelError errorOf(uint32_t type, uint32_t groups, LightScale scale)
    {
        SampleSet set = makeSamples(type, groups, 3, scale);
        integrateTruth(set, 1e-6, [](size_t) {});
        const Evaluation evaluation{.lightType = type, .method = CND_SPECULAR_CONIC};
        const LightEvaluator evaluator(context(), evaluation);
        const KernelError error =
            kernelError(set, evaluator.evaluate(set.receivers, set.lights),
                        respondInDouble(evaluation, set.receivers, set.lights));
        const ErrorStatistics &all = error.mirror.all, &dielectric = error.dielectric.all;
        std::cout << lightTypeName(type) << ", size " << scale.size << ", thickness "
                  << scale.thickness << ": mean " << 100 * all.mean << ", p99 " << 100 * all.p99
                  << ", largest " << 100 * all.max << "; F0 = 0.04: mean " << 100 * dielectric.mean
                  << ", p99 " << 100 * dielectric.p99 << ", largest " << 100 * dielectric.max
                  << "; formula: mean " << 100 * error.parts->formula.mirror.mean << ", largest "
                  << 100 * error.parts->formula.mirror.max << "; float32 adds: mean "
                  << 100 * error.parts->float32.mirror.mean << ", largest "
                  << 100 * error.parts->float32.mirror.max << ", diffuse "
                  << 100 * error.parts->float32.diffuse.max << "\n";
        EXPECT_EQ(error.invalid, 0u) << lightTypeName(type);
        return error;
    }
};

} // namespace

// The bounds are below the errors that the shaders have without the bands of lights near the
// horizon (lib/outline/bands.glsl): means of 0.065, 0.067, 0.076 and 0.071, dielectric p99
// of 4.2, 3.2, 2.7 and 2.5. Percent, on llvmpipe.
TEST_F(OutlineAccuracy, AgainstQuadrature)
{
    struct Case {
        uint32_t type;
        double mean, p99, dielectricP99; // upper bounds, percent
    };
    for (const Case& c :
         {Case{CND_LIGHT_TUBE, 0.05, 1.0, 2.8}, Case{CND_LIGHT_RECTANGLE, 0.06, 1.2, 3.0},
          Case{CND_LIGHT_DISC, 0.06, 1.3, 2.6}, Case{CND_LIGHT_POLYGON, 0.06, 1.2, 2.6}}) {
        const KernelError error = errorOf(c.type, test::fullTests() ? 500 : 60, {});
        EXPECT_LE(100 * error.mirror.all.mean, c.mean) << lightTypeName(c.type);
        EXPECT_LE(100 * error.mirror.all.p99, c.p99) << lightTypeName(c.type);
        EXPECT_LE(100 * error.dielectric.all.p99, c.dielectricP99) << lightTypeName(c.type);
        // Rounding is a small part of the error.
        EXPECT_LE(100 * error.parts->float32.mirror.mean, 0.002) << lightTypeName(c.type);
        EXPECT_LE(100 * error.parts->float32.mirror.max, 0.5) << lightTypeName(c.type);
    }
}

// Thin lights were too bright by up to 40% of the peak where they cross the horizon, and polygons
// by more than their peak. The bound is the largest error of wide tubes before the bands.
TEST_F(OutlineAccuracy, OfThinLightsIsThatOfWideOnes)
{
    for (const uint32_t type : {CND_LIGHT_TUBE, CND_LIGHT_RECTANGLE, CND_LIGHT_POLYGON})
        for (const double thickness : {1e-2, 1e-5}) {
            const KernelError error =
                errorOf(type, test::fullTests() ? 200 : 20, {.size = 1, .thickness = thickness});
            EXPECT_LE(100 * error.mirror.all.mean, 0.12) << lightTypeName(type) << thickness;
            EXPECT_LE(100 * error.mirror.all.p99, 1.5) << lightTypeName(type) << thickness;
            EXPECT_LE(100 * error.mirror.all.max, 9.0) << lightTypeName(type) << thickness;
        }
}

TEST_F(OutlineAccuracy, OfSmallLightsIsThatOfLargeOnes)
{
    for (const uint32_t type : {CND_LIGHT_TUBE, CND_LIGHT_RECTANGLE, CND_LIGHT_POLYGON}) {
        const KernelError error = errorOf(type, 20, {.size = 1e-5, .thickness = 1});
        EXPECT_LE(100 * error.mirror.all.max, 0.1) << lightTypeName(type);
    }
}

// A light around the normal has no azimuth towards which the plane of its bands could be tilted.
TEST_F(OutlineAccuracy, OfLargeLightsRightAboveIsSmall)
{
    for (const uint32_t type :
         {CND_LIGHT_TUBE, CND_LIGHT_RECTANGLE, CND_LIGHT_DISC, CND_LIGHT_POLYGON}) {
        SampleSet set{.lightType = type, .groups = 1, .receivers = {}, .lights = {}, .samples = {}};
        for (const float x : {0.0f, 1e-7f, 1e-3f, 0.3f}) {
            CndLight light{.type = type};
            light.position[0] = x;
            light.position[2] = 1;
            for (float& e : light.emission)
                e = 1;
            light.radius = type == CND_LIGHT_TUBE ? 0.3f : 6.0f;
            light.influenceRadius = INFINITY;
            light.direction[2] = -1;
            light.axisU[0] = 6;
            light.axisV[1] = -6;
            light.polygon = regularPolygon(8);
            set.lights.push_back(light);
            set.receivers.push_back(
                {.n = {0, 0, 1}, .v = {0.6f, 0, 0.8f}, .perceptualRoughness = 0.5f});
            set.samples.push_back({.group = 0, .scan = false, .horizon = horizonOf(light)});
        }
        integrateTruth(set, 1e-6, [](size_t) {});
        const LightEvaluator evaluator(context(),
                                       {.lightType = type, .method = {CND_SPECULAR_CONIC}});
        const KernelError error = kernelError(set, evaluator.evaluate(set.receivers, set.lights));
        EXPECT_EQ(error.invalid, 0u) << lightTypeName(type);
        EXPECT_LE(error.mirror.all.max, 0.03) << lightTypeName(type);
        EXPECT_LE(error.diffuse.all.max, 1e-4) << lightTypeName(type);
    }
}
