// SPDX-License-Identifier: Apache-2.0
// Compares the specular methods of sphere lights on the GPU in float32 with the same formulas in
// double precision (tools/formula).
#include <cmath>
#include <map>
#include <sstream>

#include "formula/formula.h"
#include "gpu/conic_probe.h"
#include "render/setting_names.h"
#include "shared/bench.h"

namespace candelabra::test
{
namespace
{

class Conic : public ConicProbeTest
{
protected:
    Conic() { random_.seed(54321); }

    // Places half of the lights near the mirror direction and half near the horizon.
    gpu::ConicProbeInput randomInput(double minNoV)
    {
        const double perceptualRoughness = uniform(0.0448, 1);
        const double alpha = perceptualRoughness * perceptualRoughness;
        const double s = std::pow(10.0, uniform(-4, 0));
        const glm::dvec3 v = direction(uniform(minNoV, 1));
        const glm::dvec3 mirror(-v.x, -v.y, v.z);
        glm::dvec3 l =
            mirror + (s + 2 * alpha) * std::tan(uniform(0, 1.4)) * direction(uniform(-1, 1));
        if (random_() % 2)
            l = direction(std::clamp(s * uniform(-1.02, 3), -1.0, 1.0));
        const double distance = std::pow(10.0, uniform(-2, 3));
        return {.v = glm::vec3(v),
                .toLight = glm::vec3(glm::normalize(l) * distance),
                .radius = float(s * distance),
                .alpha = float(alpha)};
    }
};

formula::Response inDouble(const gpu::ConicProbeInput& in,
                           CndSpecularMethod method = CND_SPECULAR_CONIC)
{
    return formula::respond(
        {.method = method},
        {.n = {0, 0, 1}, .v = glm::dvec3(in.v), .perceptualRoughness = std::sqrt(double(in.alpha))},
        {.centre = glm::dvec3(in.toLight), .boundingRadius = in.radius});
}

// Returns the response to the same light in the mirror direction.
double peakOf(gpu::ConicProbeInput in)
{
    in.toLight = glm::length(in.toLight) * glm::normalize(glm::vec3(-in.v.x, -in.v.y, in.v.z));
    return inDouble(in).a;
}

bool sound(glm::vec2 response)
{
    return std::isfinite(response.x) && std::isfinite(response.y) && response.y >= 0 &&
           response.x >= 0 && response.x <= 1 && response.y <= 1;
}

std::string describe(const gpu::ConicProbeInput& in)
{
    std::ostringstream text;
    text.precision(9);
    text << "alpha " << in.alpha << " radius " << in.radius << " v " << in.v.x << " " << in.v.y
         << " " << in.v.z << " toLight " << in.toLight.x << " " << in.toLight.y << " "
         << in.toLight.z;
    return text.str();
}

double difference(const formula::Response& expected, const gpu::ConicProbeOutput& output)
{
    return std::max(std::abs(expected.a - double(output.response.x)),
                    std::abs(expected.b - double(output.response.y)));
}

} // namespace

// The error that float32 adds, relative to the response to the same light in the mirror direction.
// Rounding of the inputs (6e-8) alone moves a narrow lobe by that amount relative to alpha.
TEST_F(Conic, MatchesDouble)
{
    std::vector<gpu::ConicProbeInput> inputs;
    for (int i = 0; i < 400000; ++i)
        inputs.push_back(randomInput(0.03));
    const auto outputs = evaluate(inputs);
    const auto fullOutputs = evaluate(inputs, CND_SPECULAR_CONIC_FULL);
    const auto kxOutputs = evaluate(inputs, CND_SPECULAR_KX);
    struct Slice {
        const char* name;
        double meanBound, largestBound;
        double sum = 0, worst = 0;
        size_t count = 0, worstAt = 0;
    };
    // Bounds by EVALUATE_*; below the horizon both are 0. The largest measured errors are 4e-4,
    // 3e-4 and 2e-3. The mean of clipped lobes is 1e-6 on llvmpipe. It is 7e-6 on SwiftShader, with
    // any form of the logarithm; Vulkan allows divisions and roots to be off by a few ULP.
    const double clippedMean = device().lanesAreCpuVector ? 3e-6 : 1e-5;
    std::map<uint32_t, Slice> slices = {{gpu::EVALUATE_NONE, {"below", 0, 0}},
                                        {gpu::EVALUATE_ABOVE, {"above", 1e-6, 2e-3}},
                                        {gpu::EVALUATE_NEAR, {"near", 1e-6, 2e-3}},
                                        {gpu::EVALUATE_GENERAL, {"clipped", clippedMean, 1e-2}}};
    double worstKx = 0;
    size_t moved = 0; // number of lights that rounding moves across a border between classes
    for (size_t i = 0; i < inputs.size(); ++i) {
        const formula::Response expected = inDouble(inputs[i]);
        const double peak = peakOf(inputs[i]);
        moved += outputs[i].way != expected.way;
        const double error =
            std::max(difference(expected, outputs[i]),
                     difference(inDouble(inputs[i], CND_SPECULAR_CONIC_FULL), fullOutputs[i])) /
            peak;
        Slice& slice = slices.at(expected.way);
        slice.sum += error;
        ++slice.count;
        if (!(error <= slice.worst)) {
            slice.worst = error;
            slice.worstAt = i;
        }
        const formula::Response kx = inDouble(inputs[i], CND_SPECULAR_KX);
        worstKx = std::max(worstKx, difference(kx, kxOutputs[i]) / (kx.a + 1e-3 * peak));
    }
    for (const auto& [way, slice] : slices) {
        std::cout << slice.name << ": " << slice.count
                  << " lights, float32 - double over the peak: "
                  << "mean " << slice.sum / double(slice.count) << " largest " << slice.worst
                  << " (" << describe(inputs[slice.worstAt]) << ")\n";
        EXPECT_LE(slice.sum, slice.meanBound * double(slice.count)) << slice.name;
        EXPECT_LE(slice.worst, slice.largestBound) << slice.name;
    }
    std::cout << "kx: largest " << worstKx << "; " << moved << " lights changed class\n";
    EXPECT_LE(worstKx, 3e-3);
    EXPECT_LE(moved, inputs.size() / 10000);
}

// Random, grazing and degenerate inputs: v = n, l = n, l = mirror, tangent lights, receivers
// inside, tiny and huge lights.
TEST_F(Conic, NeverNanNegativeOrAboveOne)
{
    std::vector<gpu::ConicProbeInput> inputs;
    for (int i = 0; i < 600000; ++i)
        inputs.push_back(randomInput(i % 4 ? 0.0 : -0.1));
    const std::vector<glm::vec3> directions = {
        {0, 0, 1},        {0, 0, -1},        {1, 0, 0},      {1, 0, 1e-3f},  {0.6f, 0, 0.8f},
        {-0.6f, 0, 0.8f}, {0, 0.6f, 0.8f},   {1, 0, -1e-4f}, {1e-20f, 0, 1}, {-1, 0, 0.02f},
        {1, 0, 0.02f},    {1e-4f, 0, 1},     {-1e-4f, 0, 1}, {0, 1, 1e-6f},  {0, -1, -0.5f},
        {-1, 0, 0},       {0.01f, 0.01f, -1}};
    std::vector<float> sines = {0, 1e-7f, 1e-3f, 0.02f, 0.5f, 0.8f, 1 - 1e-6f, 1, 1 + 1e-6f, 100};
    for (const glm::vec3& v : directions)
        for (const glm::vec3& l : directions)
            for (const float distance : {0.0f, 1e-20f, 1e-6f, 1.0f, 1e7f, 1e18f})
                for (const float s : sines)
                    for (const float alpha : {0.0f, 1e-6f, 0.002f, 0.05f, 0.1f, 0.5f, 1.0f})
                        inputs.push_back({.v = v,
                                          .toLight = l * distance,
                                          .radius = s * std::max(distance, 1e-6f),
                                          .alpha = alpha});
    // Lights whose centre is -1, 0, 1 or 2 radii above the horizon, exactly or nearly.
    for (int i = 0; i < 300000; ++i) {
        gpu::ConicProbeInput in = randomInput(0);
        const float edges[] = {-1, 0, 1, 2, -0.999999f, 1e-7f, 0.9999999f, 1.0000001f};
        in.toLight.z = edges[i % 8] * in.radius;
        inputs.push_back(in);
    }
    for (const auto& [name, method] : app::specularChoices) {
        // Nothing bounds Karis' response, and samples are random.
        if (method == CND_SPECULAR_NONE || method == CND_SPECULAR_KARIS ||
            method == CND_SPECULAR_SAMPLED)
            continue;
        const auto outputs = evaluate(inputs, method);
        for (size_t i = 0; i < inputs.size(); ++i)
            ASSERT_TRUE(sound(outputs[i].response))
                << i << " method " << name << " way " << outputs[i].way << ": "
                << outputs[i].response.x << " " << outputs[i].response.y << "; "
                << describe(inputs[i]);
    }
    std::cout << inputs.size() << " configurations: none NaN, infinite, negative or above 1\n";
}

// The smaller the light, the closer it is to a point light; only float32 limits its size from
// below.
TEST_F(Conic, SmallSpheresArePointLights)
{
    constexpr int perSize = 20000;
    const std::vector<double> sines = {1e-4, 1e-5, 1e-6, 1.9e-7, 1e-7, 1e-8};
    std::vector<gpu::ConicProbeInput> inputs;
    for (const double s : sines)
        for (int i = 0; i < perSize; ++i) {
            gpu::ConicProbeInput in = randomInput(0.05);
            in.alpha = float(std::pow(uniform(0.2, 1), 2));
            const glm::dvec3 mirror(-in.v.x, -in.v.y, in.v.z);
            const glm::dvec3 l = i % 2 ? direction(uniform(0.05, 1))
                                       : mirror + double(in.alpha) * direction(uniform(0, 1));
            in.toLight = glm::vec3(glm::normalize(l));
            in.radius = float(s);
            inputs.push_back(in);
        }
    const auto outputs = evaluate(inputs);
    for (size_t size = 0; size < sines.size(); ++size) {
        double worstToPoint = 0, worstToFormula = 0;
        size_t worstAt = 0;
        for (size_t i = size * perSize; i < (size + 1) * perSize; ++i) {
            const double point = inDouble(inputs[i], CND_SPECULAR_POINT).a;
            const double toPoint = std::abs(outputs[i].response.x / point - 1);
            if (!(toPoint <= worstToPoint)) {
                worstToPoint = toPoint;
                worstAt = i;
            }
            worstToFormula = std::max(worstToFormula,
                                      std::abs(outputs[i].response.x / inDouble(inputs[i]).a - 1));
        }
        std::cout << "s " << sines[size] << ": largest relative difference to the point light "
                  << worstToPoint << ", to the same formula in double " << worstToFormula << "\n";
        EXPECT_LE(worstToPoint, 1e-3) << describe(inputs[worstAt]);
        EXPECT_LE(worstToFormula, 1e-3);
    }
}

} // namespace candelabra::test
