// SPDX-License-Identifier: Apache-2.0
// Tests reciprocals and roots that promise the same bits on every device (lib/portable_math.glsl)
// against double precision.
#include <bit>
#include <cmath>
#include <cstdio>

#include "candelabra_probes.h"
#include "gpu/probe.h"
#include "io/hash.h"

namespace candelabra::test
{
namespace
{

// Returns the error of `value` in ULP: in steps of the floats around `exact`, which is positive.
double ulp(float value, double exact)
{
    return std::abs(double(value) - exact) / std::ldexp(1, std::ilogb(exact) - 23);
}

struct WorstErrors {
    double reciprocal = 0, inverseSqrt = 0, root = 0;

    void add(float input, const gpu::PortableProbeOutput& o)
    {
        const double x = double(input), exactRoot = std::sqrt(x);
        reciprocal = std::max(reciprocal, ulp(o.reciprocal, 1 / x));
        inverseSqrt = std::max(inverseSqrt, ulp(o.inverseSqrt, 1 / exactRoot));
        root = std::max(root, ulp(o.root, exactRoot));
    }
    // The bounds that portable_math.glsl states.
    void expectBounds() const
    {
        std::printf("worst error in ULP: reciprocal %.4f, inverse root %.4f, root %.4f\n",
                    reciprocal, inverseSqrt, root);
        EXPECT_LE(reciprocal, 0.51);
        EXPECT_LT(inverseSqrt, 1);
        EXPECT_LE(root, 0.75);
    }
};

} // namespace

class PortableMath : public ProbeTest
{
protected:
    std::vector<gpu::PortableProbeOutput> evaluate(const std::vector<float>& inputs)
    {
        return runProbe<gpu::PortableProbeOutput>(spirv::portable_math_comp, inputs);
    }
};

// Every float from 1 to 4: powers of four only move the exponents of the results.
TEST_F(PortableMath, EveryMantissaIsWithinTheBoundsAndHasTheSameBitsOnEveryDevice)
{
    constexpr uint32_t first = std::bit_cast<uint32_t>(1.f), last = std::bit_cast<uint32_t>(4.f);
    constexpr uint32_t batch = 1 << 21;
    WorstErrors worst;
    app::Hash bits;
    for (uint32_t begin = first; begin < last; begin += batch) {
        std::vector<float> inputs(batch);
        for (uint32_t i = 0; i < batch; ++i)
            inputs[i] = std::bit_cast<float>(begin + i);
        const auto outputs = evaluate(inputs);
        for (uint32_t i = 0; i < batch; ++i) {
            worst.add(inputs[i], outputs[i]);
            bits.add(outputs[i].reciprocal);
            bits.add(outputs[i].inverseSqrt);
            bits.add(outputs[i].root);
        }
    }
    worst.expectBounds();
    EXPECT_EQ(bits.value(), 18007558146866730129ull);
}

// The whole domain; the results of powers of two are exact, and those of negative numbers negative.
TEST_F(PortableMath, HoldsFromTwoToTheMinusHundredToTwoToTheHundred)
{
    std::vector<float> inputs;
    for (int exponent = -100; exponent < 100; ++exponent)
        for (uint32_t mantissa = 0; mantissa < 1 << 23; mantissa += 8191)
            inputs.push_back(std::ldexp(1 + std::ldexp(float(mantissa), -23), exponent));
    const auto outputs = evaluate(inputs);
    std::vector<float> negative(inputs);
    for (float& x : negative)
        x = -x;
    const auto ofNegative = evaluate(negative);
    WorstErrors worst;
    for (size_t i = 0; i < inputs.size(); ++i) {
        worst.add(inputs[i], outputs[i]);
        ASSERT_EQ(ofNegative[i].reciprocal, -outputs[i].reciprocal);
        int exponent = 0;
        if (std::frexp(inputs[i], &exponent) == 0.5f) {
            ASSERT_EQ(outputs[i].reciprocal, 1 / inputs[i]);
        }
    }
    worst.expectBounds();
    EXPECT_EQ(evaluate({0.f})[0].root, 0.f);
}

} // namespace candelabra::test
