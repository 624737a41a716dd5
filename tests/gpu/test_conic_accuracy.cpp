// SPDX-License-Identifier: Apache-2.0
// The error of the slope-conic specular term on the GPU, in float32, against quadrature: percent of
// the largest true response among the light directions of a group (one roughness, view and light
// size).
#include <algorithm>
#include <cmath>
#include <cstdlib>
#include <random>

#include "gpu/conic_probe.h"
#include "harness/constants.h"
#include "harness/full_tests.h"
#include "reference/truth.h"

namespace candelabra::test
{
namespace
{

struct Record {
    gpu::ConicProbeInput input;
    int group;
    bool above;
    double a, b; // the true response
};

// Each group has 26 directions around the mirror direction with a heavy tail of scale s + 2 alpha,
// 14 directions over everything visible, and 49 along the plane of incidence. Directions in which
// the whole light is below the horizon are left out.
std::vector<Record> drawRecords(int groups)
{
    std::mt19937 random(2024);
    const auto uniform = [&] { return double(random()) / 4294967296.0; };
    std::vector<Record> records;
    for (int group = 0; group < groups; ++group) {
        const double roughness = 0.045 + 0.955 * (group % 50 + uniform()) / 50;
        const double alpha = roughness * roughness;
        const double half = std::pow(10.0, -1 + uniform() * (std::log10(80.0) + 1)) * pi / 180;
        const double s = std::sin(half);
        const double view = uniform() * 88.85 * pi / 180;
        const glm::dvec3 v(std::sin(view), 0, std::cos(view));
        const glm::dvec3 mirror(-v.x, 0, v.z), inPlane(v.z, 0, v.x), across(0, 1, 0);
        const auto add = [&](glm::dvec3 l) {
            l = glm::normalize(l);
            if (l.z > -s)
                records.push_back({{.v = glm::vec3(v),
                                    .toLight = glm::vec3(l),
                                    .radius = float(s),
                                    .alpha = float(alpha)},
                                   group,
                                   l.z >= s,
                                   0,
                                   0});
        };
        for (int i = 0; i < 26;) {
            const double angle = i ? (s + 2 * alpha) * std::tan(0.98 * pi / 2 * uniform()) : 0;
            const double azimuth = 2 * pi * uniform();
            if (angle > 3)
                continue;
            ++i;
            add(mirror * std::cos(angle) +
                std::sin(angle) * (std::cos(azimuth) * inPlane + std::sin(azimuth) * across));
        }
        for (int i = 0; i < 14; ++i) {
            const double z = -s + (1 + s) * uniform(), azimuth = 2 * pi * uniform();
            const double r = std::sqrt(std::max(0.0, 1 - z * z));
            add({r * std::cos(azimuth), r * std::sin(azimuth), z});
        }
        for (int i = 0; i < 49; ++i) {
            const double elevation = -half + (pi + 2 * half) * (i + 0.5) / 49;
            add({std::cos(elevation), 0, std::sin(elevation)});
        }
    }
    return records;
}

struct Errors {
    std::vector<double> percent;

    double mean() const
    {
        double sum = 0;
        for (const double e : percent)
            sum += e;
        return sum / double(percent.size());
    }
    double quantile(double q)
    {
        const auto at = percent.begin() + long(q * double(percent.size() - 1));
        std::nth_element(percent.begin(), at, percent.end());
        return *at;
    }
    void print(const char* name)
    {
        std::cout << name << ": mean " << mean() << " p99 " << quantile(0.99) << " largest "
                  << quantile(1) << " (" << percent.size() << ")\n";
    }
};

} // namespace

class ConicAccuracy : public ConicProbeTest
{
};

TEST_F(ConicAccuracy, AgainstQuadrature)
{
    const int groups = fullTests() ? 1500 : 300;
    std::vector<Record> records = drawRecords(groups);
    std::vector<gpu::ConicProbeInput> inputs;
    std::vector<double> peak(size_t(groups), 0), dielectricPeak(size_t(groups), 0);
    const auto dielectric = [](double a, double b) { return 0.04 * (a - b) + b; };
    for (Record& r : records) {
        const float roughness = std::sqrt(r.input.alpha); // the shader squares this value again
        const reference::LightResponse truth = reference::truthOfCap(
            {glm::dvec3(0), glm::dvec3(0, 0, 1), glm::normalize(glm::dvec3(r.input.v))},
            double(roughness * roughness),
            {glm::normalize(glm::dvec3(r.input.toLight)),
             double(r.input.radius) * double(r.input.radius)},
            1e-5);
        r.a = truth.a;
        r.b = truth.b;
        double& p = peak[size_t(r.group)];
        p = std::max(p, r.a);
        double& d = dielectricPeak[size_t(r.group)];
        d = std::max(d, dielectric(r.a, r.b));
        inputs.push_back(r.input);
    }
    const auto outputs = evaluate(inputs);
    const auto fullOutputs = evaluate(inputs, CND_SPECULAR_CONIC_FULL);
    const auto kxOutputs = evaluate(inputs, CND_SPECULAR_KX);
    Errors all, above, fullAbove, dielectricAll, kx;
    for (size_t i = 0; i < records.size(); ++i) {
        const Record& r = records[i];
        const double unit = 100 / peak[size_t(r.group)];
        const glm::vec2 conic = outputs[i].response;
        const double error = std::abs(conic.x - r.a) * unit;
        all.percent.push_back(error);
        kx.percent.push_back(std::abs(kxOutputs[i].response.x - r.a) * unit);
        dielectricAll.percent.push_back(
            std::abs(dielectric(conic.x, conic.y) - dielectric(r.a, r.b)) * 100 /
            dielectricPeak[size_t(r.group)]);
        if (r.above) {
            above.percent.push_back(error);
            fullAbove.percent.push_back(std::abs(fullOutputs[i].response.x - r.a) * unit);
        }
    }
    all.print("conic");
    above.print("conic, light above the horizon");
    dielectricAll.print("conic, F0 = 0.04");
    fullAbove.print("conic-full, light above the horizon");
    kx.print("kx");
    EXPECT_LE(all.mean(), 0.08);
    EXPECT_LE(all.quantile(0.99), 1.6);
    EXPECT_LE(all.quantile(1), 5);
    EXPECT_LE(above.mean(), 0.03);
    EXPECT_LE(above.quantile(0.99), 0.6);
    EXPECT_LE(dielectricAll.quantile(0.99), 2.8);
    EXPECT_LE(fullAbove.mean(), 0.02);
    EXPECT_LE(fullAbove.quantile(0.99), 0.4);
    EXPECT_LE(kx.mean(), 6);
}

} // namespace candelabra::test
