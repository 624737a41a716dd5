// SPDX-License-Identifier: Apache-2.0
#include "load/studio.h"

#include <algorithm>
#include <cmath>
#include <numbers>

#include "load/brightness.h"

namespace candelabra::app
{
namespace
{

using std::numbers::pi;

// A round light with a soft edge, in the space of the environment, where the camera looks along -z.
struct SoftLight {
    double azimuth, elevation; // radians; azimuth to the right of the direction towards the camera
    double halfAngle;          // radians; from there on it gives nothing
    double luminance;          // of its middle, relative
};

constexpr SoftLight key = {-0.75, 0.6, 0.6, 9.0}; // left of the camera and above
constexpr SoftLight softLights[] = {
    key,
    {1.1, 0.3, 0.7, 0.7},  // fill: right of the camera
    {2.6, 0.7, 0.35, 6.0}, // from behind, for an edge of light
};

glm::dvec3 directionOf(const SoftLight& light)
{
    return {std::sin(light.azimuth) * std::cos(light.elevation), std::sin(light.elevation),
            std::cos(light.azimuth) * std::cos(light.elevation)};
}

double smooth(double from, double to, double x)
{
    const double t = std::clamp((x - from) / (to - from), 0.0, 1.0);
    return t * t * (3 - 2 * t);
}

double skyLuminance(const glm::dvec3& direction)
{
    const double up = direction.y;
    // The floor is darkest straight below, and the ceiling a little brighter than the walls. All
    // are grey, so that both white and black objects stand out from them.
    double out = 0.13 + 0.14 * smooth(-0.7, 0.05, up) + 0.05 * smooth(0.0, 0.9, up);
    for (const SoftLight& light : softLights) {
        const double angle =
            std::acos(std::clamp(glm::dot(directionOf(light), direction), -1.0, 1.0));
        out += light.luminance * (1 - smooth(0.35 * light.halfAngle, light.halfAngle, angle));
    }
    return out;
}

// Returns the area of an instance in m^2.
double areaOf(const Scene& scene, const Instance& instance)
{
    const Mesh& mesh = scene.meshes[instance.mesh];
    const glm::dmat3 worldFromObject(instance.worldFromObject);
    double sum = 0;
    for (size_t i = 0; i + 2 < mesh.indices.size(); i += 3) {
        const auto corner = [&](size_t k) {
            return worldFromObject * glm::dvec3(mesh.vertices[mesh.indices[i + k]].position);
        };
        sum += 0.5 * glm::length(glm::cross(corner(1) - corner(0), corner(2) - corner(0)));
    }
    return sum;
}

} // namespace

bool isLit(const Scene& scene)
{
    const auto emits = [](const CndLight& light) {
        return std::any_of(std::begin(light.emission), std::end(light.emission),
                           [](float e) { return e > 0; });
    };
    return scene.environment || std::any_of(scene.lights.begin(), scene.lights.end(), emits);
}

float studioWhite(const Scene& scene)
{
    double unlit = 0, glowing = 0; // m^2
    bool isAnyUnlit = false;
    for (const Instance& instance : scene.instances) {
        const Material& material = scene.materials[instance.material];
        isAnyUnlit = isAnyUnlit || material.unlit;
        if (material.unlit || material.emission != glm::vec3(0))
            (material.unlit ? unlit : glowing) += areaOf(scene, instance);
    }
    return isAnyUnlit && unlit >= glowing ? unlitLuminance : 1;
}

float studioEv100(float white)
{
    return std::log2(0.18f * white * 100 / 12.5f);
}

SceneEnvironment studioEnvironment(const Camera& defaultCamera, float white)
{
    SceneEnvironment out;
    out.file = "studio";
    Image& image = out.radiance;
    image = {.width = 512, .height = 256, .channels = 3, .pixels = {}};
    for (uint32_t y = 0; y < image.height; ++y)
        for (uint32_t x = 0; x < image.width; ++x) {
            const float luminance = float(skyLuminance(equirectangularDirection(image, x, y)));
            image.pixels.insert(image.pixels.end(), {luminance, luminance, luminance});
        }
    out.scale = pi * double{white} / planeIlluminance(out, directionOf(key));
    const glm::dvec3& forward = defaultCamera.forward;
    out.rotation = std::atan2(-forward.x, -forward.z);
    return out;
}

} // namespace candelabra::app
