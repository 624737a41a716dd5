// SPDX-License-Identifier: Apache-2.0
#include "measure/accuracy/low_roughness.h"
#include "render/setting_names.h"

#include <algorithm>
#include <cmath>
#include <numbers>

namespace candelabra::app
{
namespace
{

constexpr float perceptualRoughness = 0.01f;
const glm::dvec3 lightCentre{0.9, 0.8, 1.6};
constexpr double lightRadius = 0.25;

// One pixel of an orthographic view along -z onto the unit ball.
struct Hit {
    size_t pixel;
    glm::vec3 n, toLight;
};

std::vector<Hit> hitsOf(uint32_t size)
{
    std::vector<Hit> out;
    for (uint32_t y = 0; y < size; ++y)
        for (uint32_t x = 0; x < size; ++x) {
            // The view shows the quarter of the ball that mirrors the light.
            const glm::dvec2 at((x + 0.5) / size * 0.7, 0.7 - (y + 0.5) / size * 0.7);
            const double z2 = 1 - glm::dot(at, at);
            if (z2 <= 0)
                continue;
            const glm::dvec3 n(at, std::sqrt(z2));
            out.push_back({size_t(y) * size + x, glm::vec3(n), glm::vec3(lightCentre - n)});
        }
    return out;
}

// The method of Karis 2013 as it is usually written, in float32: alpha is roughness^2 without a
// lower limit, the distribution uses NoH^2 (a2 - 1) + 1, shadowing is the separable Schlick-Smith
// form, and nothing guards against rounding.
float naiveKaris(const Hit& hit)
{
    const glm::vec3 v(0, 0, 1);
    const float radius = float(lightRadius);
    const float alpha = perceptualRoughness * perceptualRoughness;
    const glm::vec3 r = 2 * glm::dot(v, hit.n) * hit.n - v;
    const glm::vec3 centreToRay = glm::dot(hit.toLight, r) * r - hit.toLight;
    const glm::vec3 closest =
        hit.toLight + centreToRay * std::clamp(radius / glm::length(centreToRay), 0.0f, 1.0f);
    const glm::vec3 l = glm::normalize(closest), h = glm::normalize(v + l);
    const float distance = glm::length(hit.toLight);
    const float NoL = std::clamp(glm::dot(hit.n, l), 0.0f, 1.0f);
    const float NoV = std::clamp(glm::dot(hit.n, v), 0.0f, 1.0f);
    const float NoH = std::clamp(glm::dot(hit.n, h), 0.0f, 1.0f);
    const float a2 = alpha * alpha;
    const float f = NoH * NoH * (a2 - 1) + 1;
    const float d = a2 / (std::numbers::pi_v<float> * f * f);
    const float k = alpha / 2;
    const float visibility = 1 / (4 * (NoL * (1 - k) + k) * (NoV * (1 - k) + k));
    const float widened = std::clamp(alpha + radius / (2 * distance), 0.0f, 1.0f);
    const float narrowing = alpha / widened;
    const float s = radius / distance;
    return std::numbers::pi_v<float> * s * s * narrowing * narrowing * d * visibility * NoL;
}

LowRoughnessImage imageOf(const std::string& method, uint32_t size)
{
    return {.method = method, .size = size, .response = std::vector<float>(size_t(size) * size)};
}

} // namespace

std::vector<LowRoughnessImage> measureLowRoughness(const VulkanContext& context, uint32_t size)
{
    const std::vector<Hit> hits = hitsOf(size);
    std::vector<LowRoughnessImage> out{imageOf("naive karis", size)};
    std::vector<gpu::BenchReceiver> receivers;
    std::vector<CndLight> lights;
    for (const Hit& hit : hits) {
        out[0].response[hit.pixel] = naiveKaris(hit);
        receivers.push_back(
            {.n = hit.n, .v = {0, 0, 1}, .perceptualRoughness = perceptualRoughness});
        CndLight light{.type = CND_LIGHT_SPHERE, .radius = float(lightRadius)};
        for (int i = 0; i < 3; ++i)
            light.position[i] = hit.toLight[i];
        lights.push_back(light);
    }
    for (const CndSpecularMethod method : {CND_SPECULAR_KARIS, CND_SPECULAR_CONIC}) {
        const LightEvaluator evaluator(context, {.method = method});
        out.push_back(imageOf(specularName(method), size));
        const auto responses = evaluator.evaluate(receivers, lights);
        for (size_t i = 0; i < hits.size(); ++i)
            out.back().response[hits[i].pixel] = responses[i].a;
    }
    return out;
}

std::vector<uint8_t> lowRoughnessPicture(const std::vector<LowRoughnessImage>& images)
{
    std::vector<uint8_t> rgb;
    const uint32_t size = images.front().size;
    for (uint32_t y = 0; y < size; ++y)
        for (const LowRoughnessImage& image : images)
            for (uint32_t x = 0; x < size; ++x) {
                const float a = image.response[size_t(y) * size + x];
                if (std::isfinite(a)) {
                    const float shown = std::pow(std::clamp(a, 0.0f, 1.0f), 1 / 2.2f);
                    rgb.insert(rgb.end(), 3, uint8_t(std::lround(shown * 255)));
                } else {
                    rgb.insert(rgb.end(), {255, 0, 255});
                }
            }
    return rgb;
}

} // namespace candelabra::app
