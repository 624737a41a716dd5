// SPDX-License-Identifier: Apache-2.0
#include "reference/render.h"

#include <algorithm>
#include <atomic>
#include <cmath>
#include <limits>
#include <numbers>
#include <stdexcept>
#include <string>
#include <thread>

#include "reference/light.h"

namespace candelabra::reference
{

namespace
{

struct Ray {
    glm::dvec3 origin;
    glm::dvec3 direction; // not unit; distances along it are in multiples of its length
};

Ray pixelRay(const Camera& camera, uint32_t width, uint32_t height, uint32_t column, uint32_t row)
{
    const glm::dvec3 forward = glm::normalize(camera.forward);
    const glm::dvec3 right = glm::normalize(glm::cross(forward, camera.up));
    const glm::dvec3 up = glm::cross(right, forward);
    const double x = 2 * (column + 0.5) / width - 1;
    const double y = 1 - 2 * (row + 0.5) / height;
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

// The distance of the centre from the ray decides, instead of b^2 - ac, which cancels for balls
// that are far away compared with their radius.
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

void validate(const Scene& scene, uint32_t width, uint32_t height)
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
    for (size_t i = 0; i < scene.lights.size(); ++i) {
        require(scene.lights[i].type <= CND_LIGHT_DIRECTIONAL,
                "light " + std::to_string(i) + " has an unknown type");
    }
}

} // namespace

std::optional<Hit> tracePixel(const Scene& scene, uint32_t width, uint32_t height, uint32_t column,
                              uint32_t row)
{
    const Ray ray = pixelRay(scene.camera, width, height, column, row);
    const Object* seen = nullptr;
    double nearest = std::numeric_limits<double>::infinity();
    for (const Object& object : scene.objects) {
        const std::optional<double> t = object.type == Object::Type::Plane
                                            ? intersectPlane(object, ray)
                                            : intersectBall(object, ray);
        if (t && *t < nearest) {
            nearest = *t;
            seen = &object;
        }
    }
    if (!seen)
        return std::nullopt;
    Hit hit;
    hit.material = seen->material;
    hit.surface.position = ray.origin + nearest * ray.direction;
    hit.surface.normal = seen->type == Object::Type::Plane
                             ? seen->normal
                             : glm::normalize(hit.surface.position - seen->point);
    hit.surface.toEye = -glm::normalize(ray.direction);
    return hit;
}

glm::dvec3 renderPixel(const Scene& scene, uint32_t width, uint32_t height, uint32_t column,
                       uint32_t row, CndSpecularMethod specularMethod)
{
    const std::optional<Hit> hit = tracePixel(scene, width, height, column, row);
    if (!hit)
        return scene.background;
    const Material& material = scene.materials[hit->material];
    glm::dvec3 luminance = material.emission;
    for (const CndLight& light : scene.lights)
        luminance +=
            outgoingLuminance(hit->surface, material, light, scene.lightOrigin, specularMethod);
    return luminance;
}

Image render(const Scene& scene, uint32_t width, uint32_t height, CndSpecularMethod specularMethod)
{
    validate(scene, width, height);
    Image image{width, height, {}};
    image.pixels.resize(static_cast<size_t>(width) * height);
    std::atomic<uint32_t> nextRow{0};
    const auto work = [&] {
        for (uint32_t row = nextRow++; row < height; row = nextRow++) {
            for (uint32_t column = 0; column < width; ++column)
                image.pixels[static_cast<size_t>(row) * width + column] =
                    renderPixel(scene, width, height, column, row, specularMethod);
        }
    };
    std::vector<std::jthread> threads;
    for (uint32_t i = 1; i < std::max(1u, std::thread::hardware_concurrency()); ++i)
        threads.emplace_back(work);
    work();
    threads.clear();
    return image;
}

} // namespace candelabra::reference
