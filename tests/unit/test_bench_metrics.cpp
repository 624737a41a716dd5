// SPDX-License-Identifier: Apache-2.0
// Tests the benchmark's sample sets and statistics with responses whose errors are known.
#include <cmath>
#include <limits>

#include <gtest/gtest.h>

#include "measure/accuracy/kernel_error.h"

namespace candelabra::app
{
namespace
{

// Returns the truth itself as a method's responses.
std::vector<gpu::BenchResponse> perfect(const SampleSet& set)
{
    std::vector<gpu::BenchResponse> out;
    for (const LightSample& s : set.samples)
        out.push_back({float(s.truth.f), float(s.truth.a), float(s.truth.b)});
    return out;
}

SampleSet sphereSet()
{
    SampleSet set = makeSamples(CND_LIGHT_SPHERE, 12, 7);
    integrateTruth(set, 1e-4, [](size_t) {});
    return set;
}

} // namespace

TEST(BenchMetrics, SamplesFollowTheSeedAndTheRanges)
{
    for (const uint32_t type : areaLightTypes()) {
        const SampleSet a = makeSamples(type, 40, 3), b = makeSamples(type, 40, 3);
        const SampleSet other = makeSamples(type, 40, 4);
        ASSERT_EQ(a.samples.size(), 40 * samplesPerGroup);
        size_t below = 0;
        for (size_t i = 0; i < a.samples.size(); ++i) {
            EXPECT_EQ(a.lights[i].position[0], b.lights[i].position[0]);
            EXPECT_GE(a.receivers[i].perceptualRoughness, 0.045f);
            EXPECT_LE(a.receivers[i].perceptualRoughness, 1.0f);
            EXPECT_GE(a.receivers[i].v.z, std::cos(88.85 * 3.14159265 / 180) - 1e-6);
            below += a.samples[i].horizon == Horizon::Below;
        }
        EXPECT_NE(a.lights[5].position[0], other.lights[5].position[0]);
        EXPECT_LT(below, a.samples.size() / 2);
    }
}

TEST(BenchMetrics, TruthHasNoErrorAgainstItself)
{
    const SampleSet set = sphereSet();
    const KernelError e = kernelError(set, perfect(set));
    std::cout << "truth rounded to float: largest error " << e.mirror.all.max << "\n";
    EXPECT_LE(e.mirror.all.max, 1e-7);
    EXPECT_LE(e.dielectric.all.max, 1e-7);
    EXPECT_LE(e.diffuse.all.max, 1e-7);
    EXPECT_EQ(e.invalid, 0u);
    EXPECT_EQ(e.leak, 0);
    EXPECT_EQ(e.mirror.all.count, e.mirror.above.count + e.mirror.crossing.count);
    EXPECT_GT(e.mirror.crossing.count, 20u);
}

// An error of 10% everywhere is at most 10% of the peak, exactly 10% at the peak, and 10% of the
// scan.
TEST(BenchMetrics, KnownErrorsAreReported)
{
    const SampleSet set = sphereSet();
    auto responses = perfect(set);
    for (gpu::BenchResponse& r : responses)
        r.a *= 1.1f;
    const KernelError e = kernelError(set, responses);
    EXPECT_NEAR(e.mirror.all.max, 0.1, 1e-6);
    EXPECT_NEAR(e.scanL1, 0.1, 1e-6);
    EXPECT_LT(e.mirror.all.mean, 0.1);
    EXPECT_GT(e.mirror.all.mean, 0.001);

    size_t below = 2;
    while (set.samples[below].horizon != Horizon::Below)
        ++below;
    responses[below].a = 1;
    responses[0].a = std::numeric_limits<float>::quiet_NaN();
    responses[1].b = -1e-9f;
    const KernelError bad = kernelError(set, responses);
    EXPECT_GT(bad.leak, 0);
    EXPECT_EQ(bad.invalid, 2u);
    EXPECT_TRUE(std::isfinite(bad.mirror.all.mean));
}

// A formula that is 10% too bright, and a result that is 1% below the formula.
TEST(BenchMetrics, ErrorsOfFormulaAndRoundingAreToldApart)
{
    const SampleSet set = sphereSet();
    auto responses = perfect(set);
    std::vector<formula::Response> inDouble;
    for (size_t i = 0; i < responses.size(); ++i) {
        const reference::LightResponse& t = set.samples[i].truth;
        inDouble.push_back({.f = t.f, .a = 1.1 * t.a, .b = t.b});
        responses[i].a = float(0.99 * 1.1 * t.a);
    }
    EXPECT_FALSE(kernelError(set, responses).parts);
    const ErrorParts parts = kernelError(set, responses, inDouble).parts.value();
    EXPECT_NEAR(parts.formula.mirror.max, 0.1, 1e-6);
    EXPECT_NEAR(parts.float32.mirror.max, 0.011, 1e-6);
    EXPECT_EQ(parts.formula.diffuse.max, 0);
    EXPECT_LE(parts.float32.diffuse.max, 1e-7);
    EXPECT_EQ(parts.formula.mirror.count, kernelError(set, responses).mirror.all.count);
}

} // namespace candelabra::app
