// SPDX-License-Identifier: Apache-2.0
// Area lights: the shipping float32 shader functions against double-precision quadrature.
#include <algorithm>
#include <cmath>
#include <cstdlib>
#include <thread>

#include "candelabra_probes.h"
#include "gpu/probe.h"
#include "harness/constants.h"
#include "harness/full_tests.h"
#include "reference/truth.h"
#include "shared/area_probe.h"
#include "shared/light_type_list.h"

namespace candelabra::test
{
namespace
{

struct Percentiles {
    double mean = 0, median = 0, p99 = 0, largest = 0; // percent
    explicit Percentiles(std::vector<double> values)
    {
        std::sort(values.begin(), values.end());
        for (const double value : values)
            mean += 100 * value / double(values.size());
        median = 100 * values[values.size() / 2];
        p99 = 100 * values[values.size() * 99 / 100];
        largest = 100 * values.back();
    }
};
std::ostream& operator<<(std::ostream& out, const Percentiles& p)
{
    return out << p.mean << " / " << p.p99 << " / " << p.largest;
}

class AreaLights : public ProbeTest
{
protected:
    AreaLights() { random_.seed(2016); }
    std::vector<gpu::AreaProbeOutput> evaluate(const std::vector<gpu::AreaProbeInput>& inputs)
    {
        return runProbe<gpu::AreaProbeOutput>(spirv::area_lights_comp_conic, inputs);
    }

    double logUniform(double low, double high)
    {
        return std::exp(uniform(std::log(low), std::log(high)));
    }

    // Places a light at distance 1 in direction l and turns it with it; `u` and `w` are its axes
    // where l is +z.
    static gpu::AreaProbeInput placed(gpu::AreaProbeInput light, const glm::dvec3& l,
                                      const glm::dvec3& u, const glm::dvec3& w)
    {
        const glm::dvec3 x = glm::normalize(
            glm::cross(l, std::abs(l.x) < 0.5 ? glm::dvec3(1, 0, 0) : glm::dvec3(0, 1, 0)));
        const glm::dmat3 frame(x, glm::cross(l, x), l);
        light.toCentre = glm::vec3(l);
        light.axisU = glm::vec3(frame * u);
        light.axisV = glm::vec3(frame * w);
        return light;
    }

    struct Group {
        size_t first, count; // range of inputs
    };

    // Makes lights of one type in groups of one roughness, view and shape, each in several
    // directions.
    std::vector<gpu::AreaProbeInput> lights(uint32_t type, int groups, int directions,
                                            std::vector<Group>& out)
    {
        std::vector<gpu::AreaProbeInput> inputs;
        for (int g = 0; g < groups; ++g) {
            const double perceptualRoughness = 0.045 + 0.955 * (g + uniform(0, 1)) / groups;
            const double alpha = perceptualRoughness * perceptualRoughness;
            const double viewAngle = glm::radians(uniform(0, 88.85));
            gpu::AreaProbeInput light{};
            light.type = type;
            light.alpha = float(alpha);
            light.twoSided = 1;
            light.v = {std::sin(viewAngle), 0, std::cos(viewAngle)};
            const double size = std::tan(glm::radians(logUniform(0.1, 60)));
            const double size2 = size * logUniform(0.1, 1);
            // Turned about the direction, and tilted by at most 70 degrees.
            const double turn = uniform(0, 2 * pi), tilt = glm::radians(uniform(-70, 70));
            const glm::dvec3 right(std::cos(turn), std::sin(turn), 0);
            const glm::dvec3 up(-std::sin(turn) * std::cos(tilt), std::cos(turn) * std::cos(tilt),
                                std::sin(tilt));
            glm::dvec3 u = right * size, w = up * size2;
            light.radius = float(std::sin(glm::radians(logUniform(0.1, 80))));
            if (type == gpu::LIGHT_DISC) {
                u = glm::cross(right, up);
                light.radius = float(size);
            } else if (type == gpu::LIGHT_TUBE) {
                u = up * size;
                light.radius = float(std::min(size2, 0.6));
                if (std::abs(glm::dot(u, glm::dvec3(0, 0, 1))) > 0.3)
                    u *= 0.3 / std::abs(u.z); // keeps the tube away from the receiver
            }
            const glm::dvec3 mirror(-std::sin(viewAngle), 0, std::cos(viewAngle));
            const double halfAngle =
                type == gpu::LIGHT_SPHERE ? std::asin(double(light.radius)) : std::atan(size);
            const size_t first = inputs.size();
            for (int i = 0; i < directions; ++i) {
                // Seven directions repeat: two are around the mirror direction with a heavy tail,
                // one is anywhere above or somewhat below the horizon, and four are in the plane of
                // incidence.
                glm::dvec3 l = mirror;
                if (i > 0 && i % 7 < 2) {
                    const double reach = (halfAngle + 2 * alpha) * std::tan(uniform(0, 1.4));
                    l = glm::normalize(mirror + reach * direction(uniform(-1, 1)));
                } else if (i % 7 == 2) {
                    l = direction(uniform(-std::sin(std::min(halfAngle, 1.4)), 1));
                } else if (i > 0) {
                    const double angle = uniform(-halfAngle, pi + halfAngle);
                    l = {std::cos(angle), 0, std::sin(angle)};
                }
                inputs.push_back(placed(light, l, u, w));
            }
            out.push_back({first, inputs.size() - first});
        }
        return inputs;
    }

    static CndLight lightOf(const gpu::AreaProbeInput& in)
    {
        CndLight light{};
        light.type = in.type;
        light.radius = in.radius;
        light.influenceRadius = INFINITY;
        light.twoSided = in.twoSided;
        for (int i = 0; i < 3; ++i) {
            light.position[i] = in.toCentre[i];
            light.direction[i] = in.axisU[i];
            light.axisU[i] = in.axisU[i];
            light.axisV[i] = in.axisV[i];
        }
        return light;
    }

    static std::vector<reference::LightResponse>
    truth(const std::vector<gpu::AreaProbeInput>& inputs, bool specular, double tolerance)
    {
        std::vector<reference::LightResponse> expected(inputs.size());
        const auto part = [&](size_t first, size_t step) {
            for (size_t i = first; i < inputs.size(); i += step) {
                const gpu::AreaProbeInput& in = inputs[i];
                const float roughness = std::sqrt(in.alpha);
                const double alpha = specular ? double(roughness * roughness) : 0;
                const reference::SurfacePoint surface{glm::dvec3(0), glm::dvec3(0, 0, 1),
                                                      glm::normalize(glm::dvec3(in.v))};
                expected[i] =
                    reference::truthResponse(surface, alpha, lightOf(in), glm::dvec3(0), tolerance);
            }
        };
        std::jthread other(part, 1, 2);
        part(0, 2);
        return expected;
    }
};

} // namespace

TEST_F(AreaLights, SpecularErrorRelativeToThePeak)
{
    struct Case {
        uint32_t type;
        const char* name;
        // Upper bounds, percent.
        double conicMean, dielectricMean, representativeMean;
    };
    const int groups = fullTests() ? 500 : 150;
    const int directions = fullTests() ? 49 : 14;
    for (const Case& c : {Case{gpu::LIGHT_SPHERE, "sphere", 0.15, 0.25, 0},
                          Case{gpu::LIGHT_TUBE, "tube", 0.15, 0.25, 15},
                          Case{gpu::LIGHT_RECTANGLE, "rectangle", 0.15, 0.25, 15},
                          Case{gpu::LIGHT_DISC, "disc", 0.15, 0.25, 15}}) {
        std::vector<Group> ranges;
        const auto inputs = lights(c.type, groups, directions, ranges);
        const auto outputs = evaluate(inputs);
        const auto expected = truth(inputs, true, 1e-3);
        std::vector<double> conic, conicDielectric, representative, sampled;
        size_t worst = 0;
        for (const Group& group : ranges) {
            double peak = 0, peakDielectric = 0;
            const auto dielectric = [](double a, double b) { return 0.04 * (a - b) + b; };
            for (size_t i = group.first; i < group.first + group.count; ++i) {
                peak = std::max(peak, expected[i].a);
                peakDielectric = std::max(peakDielectric, dielectric(expected[i].a, expected[i].b));
            }
            for (size_t i = group.first; i < group.first + group.count; ++i) {
                const gpu::AreaProbeOutput& out = outputs[i];
                conic.push_back(std::abs(out.conic.x - expected[i].a) / peak);
                if (conic[i] > conic[worst])
                    worst = i;
                conicDielectric.push_back(std::abs(dielectric(out.conic.x, out.conic.y) -
                                                   dielectric(expected[i].a, expected[i].b)) /
                                          peakDielectric);
                representative.push_back(std::abs(out.representative.x - expected[i].a) / peak);
                sampled.push_back(std::abs(out.sampled.x - expected[i].a) / peak);
            }
        }
        const Percentiles errors(conic), cheap(representative);
        std::cout << c.name << ", percent of the peak, mean / p99 / largest: closed form " << errors
                  << ", with F0 = 0.04 " << Percentiles(conicDielectric) << ", ";
        if (c.representativeMean > 0)
            std::cout << "representative point " << cheap << ", ";
        std::cout << gpu::AREA_PROBE_SAMPLES << " samples, median " << Percentiles(sampled).median
                  << "; closed form worst at alpha " << inputs[worst].alpha << ", NoV "
                  << inputs[worst].v.z << "\n";
        EXPECT_LE(errors.mean, c.conicMean);
        EXPECT_LE(Percentiles(conicDielectric).mean, c.dielectricMean);
        EXPECT_LE(Percentiles(sampled).median, 1);
        if (c.representativeMean > 0) {
            EXPECT_LE(cheap.mean, c.representativeMean);
        }
    }
}

// Lights of any size from 1e-4 to 1e3 times the distance and any orientation, most of them cut by
// the horizon or near it. Errors are relative to the form factor, or to that of the same light seen
// face on, at most 1. The largest errors are of slivers that pass close to the receiver and reach
// far to both sides: their corners are in nearly opposite directions.
TEST_F(AreaLights, FormFactorsAreExact)
{
    struct Case {
        uint32_t type;
        const char* name;
        double largest; // upper bound
    };
    const int count = fullTests() ? 20000 : 1500;
    for (const Case& c :
         {Case{gpu::LIGHT_RECTANGLE, "rectangle", 2e-4}, Case{gpu::LIGHT_DISC, "disc", 1e-5},
          Case{gpu::LIGHT_TUBE, "tube", 1e-3}}) {
        std::vector<gpu::AreaProbeInput> inputs;
        std::vector<double> scales;
        for (int i = 0; i < count; ++i) {
            gpu::AreaProbeInput light{};
            light.type = c.type;
            light.twoSided = 1;
            light.v = {0, 0, 1};
            light.alpha = 0.5f;
            const double distance = logUniform(1e-2, 1e3);
            const double size = distance * logUniform(1e-4, 1e3);
            const double size2 = size * logUniform(1e-2, 1);
            const glm::dvec3 axis = direction(uniform(-1, 1));
            const glm::dvec3 other = glm::normalize(glm::cross(axis, direction(uniform(-1, 1))));
            const double reach = size / std::hypot(size, distance);
            const glm::dvec3 l =
                direction(i % 3 ? std::clamp(uniform(-1, 2) * reach, -1.0, 1.0) : uniform(-1, 1));
            light.toCentre = glm::vec3(l * distance);
            light.axisU = glm::vec3(axis * size);
            light.axisV = glm::vec3(other * size2);
            light.radius = float(size2);
            double area = 4 * size * size2;
            if (c.type == gpu::LIGHT_DISC) {
                light.axisU = glm::vec3(axis);
                light.radius = float(size);
                area = pi * size * size;
            } else if (c.type == gpu::LIGHT_TUBE) {
                // Only outside the tube. Inside it the value must only be finite and not negative,
                // which is tested below.
                const double along = std::clamp(glm::dot(l * distance, axis), -size, size);
                const double gap = glm::length(l * distance - along * axis);
                if (gap < 0.05 * distance)
                    continue; // the float32 input would not be precise enough
                light.radius = float(std::min(size2, 0.9 * gap));
                area = 4 * size * light.radius + pi * light.radius * light.radius;
            }
            const glm::dvec3 normal = c.type == gpu::LIGHT_DISC ? axis : glm::cross(axis, other);
            if (c.type != gpu::LIGHT_TUBE &&
                std::abs(glm::dot(normal, l)) * distance < 2e-6 * std::max(distance, size))
                continue; // in the light's plane, as far as float32 can tell: the light is unseen
            inputs.push_back(light);
            scales.push_back(std::min(1.0, area / (pi * (distance * distance + size * size))));
        }
        const auto outputs = evaluate(inputs);
        const auto expected = truth(inputs, false, 1e-7);
        std::vector<double> errors;
        size_t worst = 0;
        for (size_t i = 0; i < inputs.size(); ++i) {
            const double scale = std::max(scales[i], expected[i].f);
            errors.push_back(std::max(std::abs(outputs[i].formFactor - expected[i].f),
                                      std::abs(outputs[i].formFactorAlone - expected[i].f)) /
                             scale);
            if (!(errors[i] <= errors[worst]))
                worst = i;
        }
        const gpu::AreaProbeInput& in = inputs[worst];
        const Percentiles statistics(errors);
        std::cout << c.name
                  << " form factor, percent of its scale, mean / p99 / largest: " << statistics
                  << "\n";
        EXPECT_LE(errors[worst], c.largest)
            << outputs[worst].formFactor << " or " << outputs[worst].formFactorAlone << " for "
            << expected[worst].f << " (+- " << expected[worst].fError << "), scale "
            << scales[worst] << ", centre " << in.toCentre.x << " " << in.toCentre.y << " "
            << in.toCentre.z << ", U " << in.axisU.x << " " << in.axisU.y << " " << in.axisU.z
            << ", V " << in.axisV.x << " " << in.axisV.y << " " << in.axisV.z << ", radius "
            << in.radius;
    }
}

// Degenerate geometry: receivers in the plane of a light, on it, inside it, at its edge and on its
// axis; grazing views and lights and those below the horizon; sizes from 1e-14 to 1e10.
TEST_F(AreaLights, NeverNanNegativeInfiniteOrFromBelow)
{
    std::vector<gpu::AreaProbeInput> inputs;
    const std::vector<glm::vec3> special = {{0, 0, 1},        {0, 0, -1},    {1, 0, 0},
                                            {0, 1, 0},        {1, 0, 1e-4f}, {0.6f, 0, 0.8f},
                                            {-0.6f, 0, 0.8f}, {1e-20f, 0, 1}};
    const int random = fullTests() ? 1900000 : 250000;
    const auto pick = [&] {
        return random_() % 4 ? glm::vec3(direction(uniform(-1, 1))) : special[random_() % 8];
    };
    for (int i = 0; i < random; ++i) {
        gpu::AreaProbeInput light{};
        constexpr uint32_t shapes[] = {gpu::LIGHT_SPHERE, gpu::LIGHT_TUBE, gpu::LIGHT_RECTANGLE,
                                       gpu::LIGHT_DISC};
        light.type = shapes[i % 4];
        light.twoSided = uint32_t(random_() % 2);
        light.seed = uint32_t(random_());
        light.alpha = float(random_() % 8 ? std::pow(uniform(0.0447, 1), 2) : 0);
        light.v = pick();
        const double distance = random_() % 16 ? logUniform(1e-6, 1e6) : 0;
        const double size =
            random_() % 4 ? std::max(distance, 1e-6) * logUniform(1e-4, 1e4) : distance + 1e-6;
        const double size2 = random_() % 4 ? size * logUniform(1e-4, 1) : size;
        const glm::vec3 axis = pick();
        const glm::vec3 toCentre = pick() * float(distance);
        const glm::dvec3 unit = glm::normalize(glm::dvec3(axis));
        const glm::dvec3 across = glm::normalize(glm::cross(unit, glm::dvec3(0.36, 0.48, 0.8)));
        light.toCentre = toCentre;
        light.axisU = glm::vec3(light.type == gpu::LIGHT_DISC ? unit : unit * size);
        light.axisV = glm::vec3(across * size2);
        light.radius = float(light.type == gpu::LIGHT_DISC ? size : size2);
        inputs.push_back(light);
    }
    const auto outputs = evaluate(inputs);
    size_t below = 0;
    for (size_t i = 0; i < inputs.size(); ++i) {
        const gpu::AreaProbeInput& in = inputs[i];
        const gpu::AreaProbeOutput& out = outputs[i];
        const float values[] = {out.formFactor, out.formFactorAlone,  out.conic.x,
                                out.conic.y,    out.representative.x, out.representative.y,
                                out.sampled.x,  out.sampled.y};
        for (size_t index = 0; index < std::size(values); ++index)
            ASSERT_TRUE(std::isfinite(values[index]) && values[index] >= 0)
                << values[index] << " (value " << index << ") type " << in.type << " alpha "
                << in.alpha << " v " << in.v.x << " " << in.v.y << " " << in.v.z << " centre "
                << in.toCentre.x << " " << in.toCentre.y << " " << in.toCentre.z << " U "
                << in.axisU.x << " " << in.axisU.y << " " << in.axisU.z << " V " << in.axisV.x
                << " " << in.axisV.y << " " << in.axisV.z << " radius " << in.radius;
        ASSERT_LE(out.formFactor, 1 + 1e-6f);
        ASSERT_LE(out.formFactorAlone, 1 + 1e-6f);
        ASSERT_LE(out.conic.x, 1 + 1e-6f);
        const double top =
            in.type == gpu::LIGHT_RECTANGLE ? std::abs(in.axisU.z) + std::abs(in.axisV.z)
            : in.type == gpu::LIGHT_DISC
                ? in.radius * std::sqrt(std::max(0.0, 1 - double(in.axisU.z) * in.axisU.z))
            : in.type == gpu::LIGHT_TUBE ? in.radius + std::abs(in.axisU.z)
                                         : in.radius;
        const double rounding =
            1e-6 * (glm::length(in.toCentre) + glm::length(in.axisU) + in.radius);
        if (in.toCentre.z + top < -rounding) {
            ++below;
            for (size_t index = 0; index < std::size(values); ++index)
                ASSERT_EQ(values[index], 0)
                    << index << " type " << in.type << " centre " << in.toCentre.x << " "
                    << in.toCentre.y << " " << in.toCentre.z << " U " << in.axisU.x << " "
                    << in.axisU.y << " " << in.axisU.z << " radius " << in.radius;
        }
    }
    std::cout << inputs.size() << " configurations finite, " << below
              << " of them below the horizon and exactly 0\n";
    EXPECT_GT(below, inputs.size() / 10);
}

} // namespace candelabra::test
