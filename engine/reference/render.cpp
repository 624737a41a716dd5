// SPDX-License-Identifier: Apache-2.0
#include "reference/render.h"

#include <algorithm>
#include <atomic>
#include <cmath>
#include <exception>
#include <limits>
#include <mutex>
#include <numbers>
#include <stdexcept>
#include <string>
#include <thread>

#include "reference/joining.h"
#include "reference/light.h"
#include "reference/visibility.h"
#include "reference/visible_lights.h"

namespace candelabra::reference
{

namespace
{

Ray pixelRay(const Camera& camera, uint32_t width, uint32_t height, uint32_t column, uint32_t row)
{
    const glm::dvec3 forward = glm::normalize(camera.forward);
    const glm::dvec3 right = glm::normalize(glm::cross(forward, camera.up));
    const glm::dvec3 up = glm::cross(right, forward);
    const double x = 2 * (column + 0.5) / width - 1;
    const double y = 1 - 2 * (row + 0.5) / height;
    if (camera.orthographicHeight > 0)
        return {camera.position +
                    camera.orthographicHeight / 2 * (x * camera.aspect * right + y * up),
                forward};
    const double scale = std::tan(camera.verticalFov / 2);
    return {camera.position, forward + scale * (x * camera.aspect * right + y * up)};
}

std::optional<double> intersectPlane(const Object& plane, const Ray& ray)
{
    const double approach = glm::dot(ray.direction, plane.normal);
    if (approach >= 0)
        return std::nullopt;
    const double t = glm::dot(plane.point - ray.origin, plane.normal) / approach;
    return t > 0 ? std::optional(t) : std::nullopt;
}

// Decides by the distance of the centre from the ray instead of by b^2 - ac, which cancels for
// balls that are far away compared with their radius.
std::optional<double> intersectBall(const Object& ball, const Ray& ray)
{
    const glm::dvec3 fromCenter = ray.origin - ball.point;
    const double length2 = glm::dot(ray.direction, ray.direction);
    const double nearest = -glm::dot(fromCenter, ray.direction) / length2;
    const glm::dvec3 miss = fromCenter + nearest * ray.direction;
    const double depth2 = ball.radius * ball.radius - glm::dot(miss, miss);
    if (depth2 < 0)
        return std::nullopt;
    const double t = nearest - std::sqrt(depth2 / length2);
    return t > 0 ? std::optional(t) : std::nullopt;
}

void require(bool condition, const std::string& sentence)
{
    if (!condition)
        throw std::invalid_argument(sentence);
}

// `lightTypes`: how many of the light types, in enum order, have a model.
void validate(const Scene& scene, uint32_t width, uint32_t height, uint32_t lightTypes)
{
    require(width > 0 && height > 0, "the image is empty");
    const Camera& camera = scene.camera;
    require(camera.verticalFov > 0 && camera.verticalFov < std::numbers::pi,
            "the camera's field of view is not between 0 and pi");
    require(glm::length(glm::cross(camera.forward, camera.up)) > 0,
            "the camera's up is parallel to its forward direction");
    for (size_t i = 0; i < scene.materials.size(); ++i) {
        const double alpha = scene.materials[i].alpha;
        require(alpha > 0 && alpha <= 1,
                "alpha of material " + std::to_string(i) + " is not in (0, 1]");
    }
    for (size_t i = 0; i < scene.objects.size(); ++i) {
        require(scene.objects[i].material < scene.materials.size(),
                "object " + std::to_string(i) + " names a material that does not exist");
    }
    for (const Triangle& triangle : scene.triangles)
        require(triangle.material < scene.materials.size(),
                "a triangle names a material that does not exist");
    for (size_t i = 0; i < scene.lights.size(); ++i) {
        require(scene.lights[i].type < lightTypes,
                "light " + std::to_string(i) + " has an unknown type");
    }
}

// Calls work(i) for 0 <= i < count from `threads` threads (0: one per core). The first exception
// stops all threads and is rethrown here.
template <class Work>
void inParallel(uint32_t count, uint32_t threads, Work&& work)
{
    std::atomic<uint32_t> next{0};
    std::exception_ptr failure;
    std::mutex failureMutex;
    const auto run = [&] {
        try {
            for (uint32_t i = next++; i < count; i = next++)
                work(i);
        } catch (...) {
            const std::lock_guard lock(failureMutex);
            if (!failure)
                failure = std::current_exception();
            next = count;
        }
    };
    const uint32_t wanted = threads ? threads : std::max(1u, std::thread::hardware_concurrency());
    std::vector<std::jthread> others;
    for (uint32_t i = 1; i < wanted; ++i)
        others.emplace_back(run);
    run();
    others.clear();
    if (failure)
        std::rethrow_exception(failure);
}

// What a ray meets first.
struct NearestHit {
    double distance = std::numeric_limits<double>::infinity(); // nothing
    const Object* object = nullptr;                            // null: a triangle
    TriangleHit triangle;
};

NearestHit nearestSurface(const Scene& scene, const Occluders& surfaces, const Ray& ray)
{
    NearestHit nearest;
    if (const auto hit = surfaces.nearest(ray))
        nearest = {hit->distance, nullptr, *hit};
    for (const Object& object : scene.objects) {
        const std::optional<double> t = object.type == Object::Type::Plane
                                            ? intersectPlane(object, ray)
                                            : intersectBall(object, ray);
        if (t && *t < nearest.distance)
            nearest = {*t, &object, {}};
    }
    return nearest;
}

// Returns the interpolated normal, turned towards the side of the triangle from which the ray
// comes.
glm::dvec3 normalAt(const Triangle& triangle, const TriangleHit& hit, const Ray& ray)
{
    const auto& [a, b, c] = triangle.corners;
    const auto& [na, nb, nc] = triangle.normals;
    const glm::dvec3 face = glm::cross(b - a, c - a);
    const glm::dvec3 smooth = (1 - hit.u - hit.v) * na + hit.u * nb + hit.v * nc;
    const glm::dvec3 normal = glm::normalize(glm::length(smooth) > 0 ? smooth : face);
    return glm::dot(face, ray.direction) > 0 ? -normal : normal;
}

Hit surfaceAt(const Scene& scene, const NearestHit& nearest, const Ray& ray)
{
    Hit hit;
    hit.surface.position = ray.origin + nearest.distance * ray.direction;
    hit.surface.toEye = -glm::normalize(ray.direction);
    if (nearest.object) {
        const Object& object = *nearest.object;
        hit.material = object.material;
        hit.surface.normal = object.type == Object::Type::Plane
                                 ? object.normal
                                 : glm::normalize(hit.surface.position - object.point);
    } else {
        const Triangle& triangle = scene.triangles[nearest.triangle.triangle];
        hit.material = triangle.material;
        hit.surface.normal = normalAt(triangle, nearest.triangle, ray);
    }
    return hit;
}

// The content of a pixel: its own luminance, and the surface there, if any, that lights illuminate.
struct Seen {
    glm::dvec3 luminance{0};
    std::optional<SurfacePoint> surface;
    Material material; // of the surface, as it appears from the eye
};

Seen traceRay(const Scene& scene, const Occluders& surfaces, const Ray& ray)
{
    const NearestHit surface = nearestSurface(scene, surfaces, ray);
    double nearest = surface.distance;
    const CndLight* light = nullptr;
    for (size_t i = 0; scene.lightsVisible && i < scene.lights.size(); ++i)
        if (const auto t = intersectLight(scene.lights[i], scene.lightOrigin, ray);
            t && *t < nearest) {
            nearest = *t;
            light = &scene.lights[i];
        }
    if (light)
        return {.luminance = {light->emission[0], light->emission[1], light->emission[2]}};
    if (std::isinf(surface.distance)) {
        const auto distant =
            scene.lightsVisible ? distantLuminance(scene.lights, ray.direction) : std::nullopt;
        return {.luminance = distant.value_or(scene.background)};
    }
    const Hit hit = surfaceAt(scene, surface, ray);
    const Material& material = scene.materials[hit.material];
    return {material.emission, hit.surface,
            joinLobes(material, glm::dot(hit.surface.normal, hit.surface.toEye), scene.lobes,
                      scene.energyCompensation)};
}

glm::dvec3 shadedPixel(const Scene& scene, const Occluders& surfaces, const Ray& ray,
                       CndSpecularMethod specularMethod)
{
    const Seen seen = traceRay(scene, surfaces, ray);
    glm::dvec3 luminance = seen.luminance;
    if (seen.surface)
        for (const CndLight& light : scene.lights)
            luminance += outgoingLuminance(*seen.surface, seen.material, light, scene.lightOrigin,
                                           specularMethod);
    return luminance;
}

} // namespace

std::optional<Hit> tracePixel(const Scene& scene, uint32_t width, uint32_t height, uint32_t column,
                              uint32_t row)
{
    const Occluders surfaces(scene.objects, scene.triangles);
    const Ray ray = pixelRay(scene.camera, width, height, column, row);
    const NearestHit nearest = nearestSurface(scene, surfaces, ray);
    return std::isinf(nearest.distance) ? std::nullopt
                                        : std::optional(surfaceAt(scene, nearest, ray));
}

glm::dvec3 renderPixel(const Scene& scene, uint32_t width, uint32_t height, uint32_t column,
                       uint32_t row, CndSpecularMethod specularMethod)
{
    return shadedPixel(scene, Occluders(scene.objects, scene.triangles),
                       pixelRay(scene.camera, width, height, column, row), specularMethod);
}

Image render(const Scene& scene, uint32_t width, uint32_t height, CndSpecularMethod specularMethod)
{
    validate(scene, width, height, CND_LIGHT_DIRECTIONAL + 1);
    Image image{width, height, {}};
    image.pixels.resize(static_cast<size_t>(width) * height);
    const Occluders surfaces(scene.objects, scene.triangles);
    inParallel(height, 0, [&](uint32_t row) {
        for (uint32_t column = 0; column < width; ++column)
            image.pixels[static_cast<size_t>(row) * width + column] =
                shadedPixel(scene, surfaces, pixelRay(scene.camera, width, height, column, row),
                            specularMethod);
    });
    return image;
}

TruthRows renderTruth(const Scene& scene, uint32_t width, uint32_t height,
                      std::span<const uint32_t> rows, const TruthOptions& options)
{
    validate(scene, width, height, CND_LIGHT_TYPE_COUNT);
    require(options.relative >= 1e-9 && options.relative <= 1e-2,
            "the tolerance is not between 1e-9 and 1e-2");
    for (const uint32_t row : rows)
        require(row < height, "row " + std::to_string(row) + " is outside the image");
    TruthRows out;
    out.pixels.resize(rows.size() * width);
    std::atomic<uint64_t> unconverged{0};
    std::mutex rowMutex;
    const Occluders surfaces(scene.objects, scene.triangles);
    const auto truthOfPixel = [&](uint32_t column, uint32_t row) {
        const Ray ray = pixelRay(scene.camera, width, height, column, row);
        const Seen seen = traceRay(scene, surfaces, ray);
        glm::dvec3 pixel = seen.luminance;
        if (seen.surface)
            unconverged += addLights({.lights = scene.lights,
                                      .ignoredLayers = scene.ignoredLayers,
                                      .lightOrigin = scene.lightOrigin,
                                      .occluders = options.shadows ? &surfaces : nullptr,
                                      .relative = options.relative,
                                      .seed = (options.seed << 32) + size_t{row} * width + column},
                                     *seen.surface, seen.material, pixel);
        return pixel;
    };
    const glm::dvec3 missing(std::numeric_limits<double>::quiet_NaN());
    inParallel(static_cast<uint32_t>(rows.size()), options.threads, [&](uint32_t i) {
        for (uint32_t column = 0; column < width; ++column)
            out.pixels[static_cast<size_t>(i) * width + column] =
                !options.wanted || options.wanted(column, rows[i]) ? truthOfPixel(column, rows[i])
                                                                   : missing;
        if (options.onRow) {
            const std::lock_guard lock(rowMutex);
            options.onRow();
        }
    });
    out.unconverged = unconverged;
    return out;
}

} // namespace candelabra::reference
