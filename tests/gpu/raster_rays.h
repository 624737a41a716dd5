// SPDX-License-Identifier: Apache-2.0
// Rays of the raster pass and their intersections in double precision, to compare ray-cast pixels
// with.
#pragma once

#include <cmath>
#include <limits>

#include <glm/gtc/type_ptr.hpp>

#include "gpu/gbuffer_harness.h"
#include "shared/gbuffer_data.h"

namespace candelabra::test
{

constexpr double never = std::numeric_limits<double>::infinity();

struct Ray {
    glm::dvec3 origin, direction; // world space, direction unit
    glm::dvec3 at(double t) const { return origin + t * direction; }
};

// Returns the ray through the pixel centre, from the float projection but computed in double
// precision.
inline Ray pixelRay(const RasterOptions& o, uint32_t x, uint32_t y)
{
    const float* m = o.camera.clipFromView;
    const double ndcX = (2.0 * x + 1) / o.width - 1, ndcY = (2.0 * y + 1) / o.height - 1;
    const glm::dmat4 worldFromView = glm::inverse(viewFromWorld(o.camera));
    if (m[15] == 0)
        return {glm::dvec3(worldFromView[3]),
                glm::normalize(glm::dmat3(worldFromView) *
                               glm::dvec3((ndcX + m[8]) / m[0], (ndcY + m[9]) / m[5], -1))};
    const glm::dvec4 origin((ndcX - m[12]) / m[0], (ndcY - m[13]) / m[5], 0, 1);
    return {glm::dvec3(worldFromView * origin), -glm::dvec3(worldFromView[2])};
}

inline double hitPlane(const Ray& ray, const glm::dvec3& point, const glm::dvec3& normal)
{
    const double height = glm::dot(ray.origin - point, normal);
    const double slope = glm::dot(ray.direction, normal);
    return height > 0 && slope < 0 ? -height / slope : never;
}

struct SphereHit {
    double near = never, far = never;
    double axisDistance; // distance of the ray from the centre
};

inline SphereHit hitSphere(const Ray& ray, const glm::dvec3& center, double radius)
{
    const glm::dvec3 toCenter = center - ray.origin;
    const double along = glm::dot(toCenter, ray.direction);
    SphereHit hit;
    hit.axisDistance = glm::length(toCenter - along * ray.direction);
    if (hit.axisDistance <= radius) {
        const double half = std::sqrt(radius * radius - hit.axisDistance * hit.axisDistance);
        hit.near = along - half;
        hit.far = along + half;
    }
    return hit;
}

constexpr double nearPlane = 0.1, farPlane = 1e4, orthographicRange = 200;

// Returns by how much two roundings of depth move a point at `distance`, relative to the distance.
inline double depthStep(int kind, double distance)
{
    constexpr double step = 2.0 / (1 << 24);
    if (kind == 2)
        return distance / nearPlane * step;
    return kind == 3 ? orthographicRange / distance * step : step;
}

// Returns true if the point is safely between the near and far planes, at which the images end.
inline bool insideDepthRange(const RasterOptions& o, const glm::dvec3& p)
{
    const double distance = -(viewFromWorld(o.camera) * glm::dvec4(p, 1)).z;
    const double end = o.camera.clipFromView[15] == 0 ? farPlane : orthographicRange;
    return distance > 1.01 * nearPlane && distance < 0.95 * end;
}

// Sets the projection `kind`: infinite perspective, finite perspective, not reversed, or
// orthographic.
inline void setProjection(RasterOptions& o, int kind)
{
    const double aspect = double(o.width) / o.height;
    o.clearDepth = kind == 2 ? 1.f : 0.f;
    if (kind == 3)
        setOrthographic(o.camera, 5, aspect, nearPlane, orthographicRange);
    else
        setPerspective(o.camera, 0.9, aspect, nearPlane, kind == 0 ? 0 : farPlane, kind != 2);
}

// Returns the world-space position that a shader reconstructs.
inline glm::dvec3 worldPosition(const RasterImage& image, uint32_t x, uint32_t y)
{
    return glm::dvec3(glm::inverse(viewFromWorld(image.camera)) *
                      glm::dvec4(viewPosition(image, x, y), 1));
}

inline CndLight sphereLight(const glm::dvec3& position, double radius, const glm::vec3& luminance)
{
    CndLight light{.type = CND_LIGHT_SPHERE, .radius = float(radius)};
    for (int i = 0; i < 3; ++i) {
        light.position[i] = float(position[i]);
        light.emission[i] = luminance[i];
    }
    light.influenceRadius = std::numeric_limits<float>::infinity();
    return light;
}

inline glm::dvec3 positionOf(const CndLight& light)
{
    return glm::make_vec3(light.position);
}

// Expects that a pixel shows the emitter that is nearest along its ray, at the distance of its
// point `p` within the share `tolerance`, and a surface that reflects nothing.
inline void expectEmitter(const RasterImage& image, const RasterOptions& o, uint32_t x, uint32_t y,
                          const CndLight& light, const glm::dvec3& p, double tolerance)
{
    const size_t i = size_t(y) * image.width + x;
    for (int c = 0; c < 3; ++c)
        ASSERT_EQ(image.radiance[i][c], light.emission[c]) << x << " " << y;
    if (insideDepthRange(o, p)) { // closer lights are drawn at the near plane
        ASSERT_LE(glm::length(worldPosition(image, x, y) - p),
                  tolerance * glm::length(p - pixelRay(o, x, y).origin))
            << x << " " << y << " type " << light.type;
    }
    if (o.layout == CND_GBUFFER_COMPACT) {
        ASSERT_EQ(image.normalRoughness[i].x, gpu::NORMAL_ROUGHNESS_UNLIT_COMPACT);
    } else {
        ASSERT_EQ(image.albedo[i], glm::uvec2(0));
        ASSERT_EQ(image.specular[i], glm::uvec2(0));
    }
}

} // namespace candelabra::test
