// SPDX-License-Identifier: Apache-2.0
#include "load/brightness.h"

#include <algorithm>
#include <cmath>
#include <numbers>

#include "candelabra/glm.hpp"
#include "generate/light_overlaps.h"

namespace candelabra::app
{
namespace
{

using std::numbers::pi;

// Returns the luminance of a pixel in cd/m^2. Files may hold any number; those that are negative or
// not finite are black, as the engine takes them.
double pixelLuminance(const Image& image, uint32_t x, uint32_t y)
{
    const float* pixel = &image.pixels[(size_t(y) * image.width + x) * size_t(image.channels)];
    const float rgb[3] = {pixel[0], pixel[image.channels == 1 ? 0 : 1],
                          pixel[image.channels == 1 ? 0 : 2]};
    const double luminance = luminanceOf(rgb);
    return std::isfinite(luminance) && luminance > 0 ? luminance : 0;
}

// Returns the luminous intensity in cd that a point of the same power has, into all directions or,
// of lights with one side, into half of them.
double candelasOf(const CndLight& light)
{
    if (light.type == CND_LIGHT_SPOT)
        return luminanceOf(light.emission);
    float lumens[3];
    if (cndLuminousPowerOfLight(&light, lumens, nullptr) != CND_SUCCESS)
        return 0;
    const bool flat = light.type == CND_LIGHT_RECTANGLE || light.type == CND_LIGHT_DISC ||
                      light.type == CND_LIGHT_POLYGON;
    return luminanceOf(lumens) / (flat && !light.twoSided ? 2 * pi : 4 * pi);
}

// Returns the illuminance in lx of a surface that faces a light without a place.
double illuminanceOf(const CndLight& light)
{
    const double sine = double{light.radius};
    const double perEmission = light.type == CND_LIGHT_DISTANT_SPHERE ? pi * sine * sine : 1;
    return perEmission * luminanceOf(light.emission);
}

// Returns the illuminance in lx that a light gives a sample, as a point of the same power.
double illuminanceOf(const CndLight& light, const glm::dvec3& position, const SurfaceSample& sample)
{
    if (cndIsDistant(light.type)) {
        const glm::dvec3 d(toGlm(light.direction));
        return illuminanceOf(light) * std::max(-glm::dot(glm::normalize(d), sample.normal), 0.0);
    }
    const glm::dvec3 toLight = position - sample.position;
    // Nearer than the surface of an emitter, a point would be too bright.
    const double least = std::max(double{cndEmitterBoundingRadius(&light)}, 1e-6);
    const double distance = std::max(glm::length(toLight), least);
    if (light.influenceRadius > 0 && distance > double{light.influenceRadius})
        return 0;
    const double cosine = std::max(glm::dot(toLight, sample.normal) / distance, 0.0);
    return candelasOf(light) * cosine / (distance * distance);
}

} // namespace

double luminanceOf(const float (&rgb)[3])
{
    return 0.2126 * double{rgb[0]} + 0.7152 * double{rgb[1]} + 0.0722 * double{rgb[2]};
}

glm::dvec3 equirectangularDirection(const Image& image, uint32_t x, uint32_t y)
{
    const double azimuth = (2 * (x + 0.5) / image.width - 1) * pi;
    const double polar = (y + 0.5) / image.height * pi;
    return {std::sin(azimuth) * std::sin(polar), std::cos(polar),
            -std::cos(azimuth) * std::sin(polar)};
}

double groundIlluminance(const SceneEnvironment& environment)
{
    const Image& image = environment.radiance;
    double sum = 0;
    for (uint32_t y = 0; y < image.height; ++y) {
        // The integral of the cosine of level ground over the solid angle of a pixel, where cosine
        // times sine of the polar angle integrates to half the squared sine.
        const auto squaredSine = [&](double row) {
            const double sine = std::sin(std::min(row / image.height, 0.5) * pi);
            return sine * sine;
        };
        const double weight = pi / image.width * (squaredSine(y + 1.0) - squaredSine(y));
        for (uint32_t x = 0; weight > 0 && x < image.width; ++x)
            sum += weight * pixelLuminance(image, x, y);
    }
    return environment.scale * sum;
}

double planeIlluminance(const SceneEnvironment& environment, const glm::dvec3& normal)
{
    const Image& image = environment.radiance;
    double sum = 0;
    for (uint32_t y = 0; y < image.height; ++y) {
        const double solidAngle =
            2 * pi / image.width *
            (std::cos(pi * y / image.height) - std::cos(pi * (y + 1.0) / image.height));
        for (uint32_t x = 0; x < image.width; ++x) {
            const double cosine = glm::dot(normal, equirectangularDirection(image, x, y));
            sum += cosine > 0 ? solidAngle * cosine * pixelLuminance(image, x, y) : 0;
        }
    }
    return environment.scale * sum;
}

double sunIlluminance(const Scene& scene)
{
    double sum = 0;
    for (const CndLight& light : scene.lights)
        sum += cndIsDistant(light.type) ? illuminanceOf(light) : 0;
    return sum;
}

double typicalIlluminance(const Scene& scene)
{
    const std::vector<SurfaceSample> all = visibleSamples(scene);
    constexpr size_t most = 256;
    const size_t step = std::max<size_t>(all.size() / most, 1);
    double sum = 0;
    size_t count = 0;
    for (size_t i = 0; i < all.size(); i += step, ++count)
        for (const CndLight& light : scene.lights) {
            const glm::dvec3 position(toGlm(light.position));
            sum += illuminanceOf(light, scene.lightOrigin + position, all[i]);
        }
    return (count ? sum / double(count) : 0) +
           (scene.environment ? groundIlluminance(*scene.environment) : 0);
}

} // namespace candelabra::app
