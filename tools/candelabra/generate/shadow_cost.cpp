// SPDX-License-Identifier: Apache-2.0
#include "generate/shadow_cost.h"

#include <algorithm>
#include <cmath>
#include <optional>
#include <thread>
#include <vector>

#include <fmt/format.h>

#include "candelabra/glm.hpp"
#include "generate/ray_caster.h"

namespace candelabra::app
{
namespace
{

constexpr uint32_t mostRows = 12;
// Bound the time that an estimate takes.
constexpr double mostPairsTested = 2e7;
constexpr uint64_t mostBoxesTested = 20000000; // then the points so far stand for all
constexpr size_t lightsPerPoint = 2;

// What llvmpipe takes for a pair of a pixel and a light, in seconds of CPU time (DECISIONS 86). A
// hidden light has one price, and a light with nothing between it and the pixel's tile another. If
// only a few triangles may be there, each box that the search of the pixel tests has a price. All
// other pairs have a price of their own and one per box.
constexpr double hiddenPair = 0.02e-6, litPair = 0.02e-6, listedBox = 0.006e-6, walkedPair = 1.2e-6,
                 walkedBox = 0.018e-6;
constexpr uint64_t mostListed = 6; // triangles
constexpr double tileSide = 8;     // pixels

struct SeenPoint {
    RayHit hit;
    double tileRadius; // m; of the pixels that share a search
};

// The points that the camera sees in rows and columns of equal distance. `rays`: their number and
// that of places without a surface.
std::vector<SeenPoint> seenPoints(RayCaster& caster, const Camera& camera, PixelSize size,
                                  size_t& rays)
{
    // About one ray per tile is enough.
    const auto rows =
        uint32_t(std::clamp(std::ceil(size.height / tileSide), 1.0, double(mostRows)));
    const double aspect = double(size.width) / size.height;
    const auto columns = uint32_t(std::clamp(std::round(aspect * rows), 1.0, 8.0 * mostRows));
    const double pixel = camera.orthographic ? camera.orthographicHeight / size.height
                                             : 2 * std::tan(camera.verticalFov / 2) / size.height;
    std::vector<SeenPoint> out;
    for (uint32_t y = 0; y < rows; ++y)
        for (uint32_t x = 0; x < columns; ++x)
            if (const Ray ray = cameraRay(camera, x, y, columns, rows);
                const auto hit = caster.cast(ray)) {
                const double cosine = std::abs(glm::dot(hit->normal, ray.direction));
                const double scale = camera.orthographic ? pixel : pixel * hit->distance;
                out.push_back({*hit, std::sqrt(0.5) * tileSide * scale / std::max(cosine, 0.2)});
            }
    rays = size_t{rows} * columns;
    return out;
}

// Returns what is between the point and the light, if that may light the point. `size`: of the
// scene in metres.
std::optional<Shaft> shaftTo(const Scene& scene, const CndLight& light, const RayHit& point,
                             double size, bool uncut)
{
    Shaft out{.start = point.position, .endRadius = cndEmitterBoundingRadius(&light)};
    if (cndIsDistant(light.type)) {
        out.axis = -size * glm::dvec3(toGlm(light.direction));
        out.endRadius *= size;
    } else {
        const glm::dvec3 position(toGlm(light.position));
        out.axis = scene.lightOrigin + position - point.position;
        if (!uncut && glm::length(out.axis) >= double(light.influenceRadius))
            return std::nullopt;
    }
    if (glm::dot(point.normal, out.axis) <= -out.endRadius || out.axis == glm::dvec3(0))
        return std::nullopt;
    return out;
}

// Tells whether rays to four places of a light are blocked.
bool isHidden(const Scene& scene, RayCaster& caster, const Shaft& shaft, uint32_t ignoredLayers)
{
    const glm::dvec3 away = std::abs(shaft.axis.y) < 0.7 * glm::length(shaft.axis)
                                ? glm::dvec3(0, 1, 0)
                                : glm::dvec3(1, 0, 0);
    const glm::dvec3 u = 0.7 * shaft.endRadius * glm::normalize(glm::cross(shaft.axis, away));
    const glm::dvec3 v = glm::cross(u, glm::normalize(shaft.axis));
    for (const glm::dvec3& offset : {u, -u, v, -v}) {
        const glm::dvec3 to = shaft.axis + offset;
        const auto hit = caster.cast({shaft.start + 1e-4 * to, glm::normalize(to)});
        if (!hit || hit->analytic || hit->distance > glm::length(to) - shaft.endRadius ||
            (ignoredLayers >> scene.instances[hit->object].occluderLayer & 1))
            return false;
    }
    return true;
}

// `boxes`: grows by those that were tested.
double secondsOfPair(const Scene& scene, RayCaster& caster, const Shaft& shaft, double tileRadius,
                     uint32_t ignoredLayers, uint64_t& boxes)
{
    if (isHidden(scene, caster, shaft, ignoredLayers))
        return hiddenPair;
    Shaft fromTile = shaft;
    fromTile.startRadius = tileRadius;
    const ShaftContents ofTile = caster.contentsOf(fromTile, ignoredLayers);
    boxes += ofTile.boxes;
    if (ofTile.triangles == 0)
        return litPair;
    const ShaftContents ofPixel = caster.contentsOf(shaft, ignoredLayers);
    boxes += ofPixel.boxes;
    if (ofTile.triangles <= mostListed)
        return listedBox * double(ofPixel.boxes);
    return walkedPair + walkedBox * double(ofPixel.boxes);
}

} // namespace

double shadowCpuSeconds(const Scene& scene, const Camera& camera, PixelSize size, bool uncut)
{
    std::vector<const CndLight*> lights;
    for (const CndLight& light : scene.lights)
        if (isShown(light, camera) && !light.unshadowed)
            lights.push_back(&light);
    if (lights.empty())
        return 0;
    RayCaster caster(scene);
    size_t rays = 0;
    const std::vector<SeenPoint> points = seenPoints(caster, camera, size, rays);
    const Bounds bounds = sceneBounds(scene);
    const double extent = std::max(glm::length(bounds.max - bounds.min), 1.0);
    const double tested = double(points.size()) * double(lights.size());
    const auto step = std::max<size_t>(1, size_t(tested / mostPairsTested));
    struct AskedLight {
        Shaft shaft;
        uint32_t ignoredLayers;
    };
    std::vector<AskedLight> asked;
    double seconds = 0;
    uint64_t boxes = 0;
    size_t count = 0;
    for (size_t i = 0; i < points.size() && boxes < mostBoxesTested; i += step, ++count) {
        asked.clear();
        for (const CndLight* light : lights)
            if (const auto shaft = shaftTo(scene, *light, points[i].hit, extent, uncut))
                asked.push_back({*shaft, light->unshadowedBy});
        const size_t some = std::min(asked.size(), lightsPerPoint);
        for (size_t k = 0; k < some; ++k) {
            const AskedLight& a = asked[(2 * k + 1) * asked.size() / (2 * some)];
            seconds += secondsOfPair(scene, caster, a.shaft, points[i].tileRadius, a.ignoredLayers,
                                     boxes) *
                       double(asked.size()) / double(some);
        }
    }
    const double pixels = double(size.width) * size.height * double(points.size()) / double(rays);
    return count ? seconds / double(count) * pixels : 0;
}

double secondsOnCores(double cpuSeconds)
{
    // llvmpipe uses no more threads.
    constexpr unsigned most = 16;
    return cpuSeconds / std::clamp(std::thread::hardware_concurrency(), 1u, most);
}

std::string shadowsLeftOutText(double seconds)
{
    return fmt::format(
        "shadows are off, because a picture would take about {:.{}f} s longer on this "
        "CPU; --shadows 64 turns them on",
        seconds, seconds < 10 ? 1 : 0);
}

} // namespace candelabra::app
