// SPDX-License-Identifier: Apache-2.0
#include "gltf/lights.h"

#include <algorithm>
#include <cmath>
#include <limits>
#include <optional>

#include "candelabra/glm.hpp"

namespace candelabra::app
{

namespace
{

// The largest distance of corners from those of an exact rectangle, as a share of its diagonal.
constexpr double tolerance = 1e-3;

struct Rectangle {
    glm::dvec3 center{0}, halfU{0}, halfV{0}; // shines along cross(halfU, halfV)
};

std::vector<glm::dvec3> worldPositions(const Mesh& mesh, const glm::dmat4& worldFromObject)
{
    std::vector<glm::dvec3> out;
    out.reserve(mesh.vertices.size());
    for (const Vertex& v : mesh.vertices)
        out.emplace_back(worldFromObject * glm::dvec4(v.position, 1));
    return out;
}

glm::dvec3 farthest(const std::vector<glm::dvec3>& points, const auto& distance)
{
    return *std::ranges::max_element(points, [&](const glm::dvec3& a, const glm::dvec3& b) {
        return distance(a) < distance(b);
    });
}

// Returns the rectangle that the triangles cover exactly once, if there is one.
std::optional<Rectangle> rectangleOf(const Mesh& mesh, const glm::dmat4& worldFromObject)
{
    const std::vector<glm::dvec3> points = worldPositions(mesh, worldFromObject);
    // The two points of a rectangle that are farthest from each other are opposite corners, and the
    // point that is farthest from their diagonal is another corner.
    const auto from = [](const glm::dvec3& origin) {
        return [origin](const glm::dvec3& p) { return glm::distance(p, origin); };
    };
    const glm::dvec3 a = farthest(points, from(points[0]));
    const glm::dvec3 b = farthest(points, from(a));
    const double diagonal = glm::distance(a, b);
    if (!(diagonal > 0))
        return std::nullopt;
    const glm::dvec3 along = (b - a) / diagonal;
    const glm::dvec3 c = farthest(
        points, [&](const glm::dvec3& p) { return glm::length(glm::cross(p - a, along)); });
    Rectangle r{0.5 * (a + b), 0.5 * (c - a), 0.5 * (b - c)};
    const double lengthU = glm::length(r.halfU), lengthV = glm::length(r.halfV);
    // No light is smaller than 1e-15 m: its square must not vanish in single precision.
    if (!(std::min(lengthU, lengthV) > std::max(tolerance * diagonal, 1e-15)) ||
        !(std::abs(glm::dot(r.halfU, r.halfV)) <= 0.5 * tolerance * lengthU * lengthV))
        return std::nullopt;
    const glm::dvec3 u = r.halfU / lengthU, v = r.halfV / lengthV;
    for (const glm::dvec3& p : points) {
        const glm::dvec3 d = p - r.center;
        const double margin = tolerance * diagonal;
        if (std::abs(glm::dot(d, u)) > lengthU + margin ||
            std::abs(glm::dot(d, v)) > lengthV + margin ||
            std::abs(glm::dot(d, glm::cross(u, v))) > margin)
            return std::nullopt;
    }
    glm::dvec3 areaNormal{0}, centroid{0};
    double area = 0;
    for (size_t t = 0; t + 2 < mesh.indices.size(); t += 3) {
        const auto corner = [&](size_t k) { return points[mesh.indices[t + k]]; };
        const glm::dvec3 n = 0.5 * glm::cross(corner(1) - corner(0), corner(2) - corner(0));
        areaNormal += n;
        area += glm::length(n);
        centroid += glm::length(n) / 3 * (corner(0) + corner(1) + corner(2));
    }
    // The triangles face one side if their normals add up to the area, and cover the rectangle if
    // that is its area and their centroid is its centre.
    const double wanted = 4 * lengthU * lengthV;
    if (!(std::abs(area - wanted) <= 0.01 * wanted) || !(glm::length(areaNormal) >= 0.99 * area) ||
        !(glm::distance(centroid / area, r.center) <= 0.01 * diagonal))
        return std::nullopt;
    if (glm::dot(areaNormal, glm::cross(u, v)) < 0)
        std::swap(r.halfU, r.halfV);
    return r;
}

CndLight lightOf(const Rectangle& r, const Material& material)
{
    CndLight light = {};
    light.type = CND_LIGHT_RECTANGLE;
    assign(light.axisU, glm::vec3(r.halfU));
    assign(light.axisV, glm::vec3(r.halfV));
    assign(light.emission, material.emission);
    light.twoSided = material.doubleSided;
    light.influenceRadius = std::numeric_limits<float>::infinity();
    return light;
}

} // namespace

bool GltfEmissiveRectangles::replace(const Mesh& mesh, const Material& material,
                                     const glm::dmat4& worldFromObject, GltfLights& out)
{
    if (material.unlit || material.emission == glm::vec3(0))
        return false;
    if (material.emissiveTexture.texture >= 0) {
        ++textured_;
        return false;
    }
    const auto rectangle = rectangleOf(mesh, worldFromObject);
    if (!rectangle) {
        ++others_;
        return false;
    }
    out.lights.push_back(lightOf(*rectangle, material));
    out.positions.push_back(rectangle->center);
    return true;
}

void GltfEmissiveRectangles::warn(const GltfDocument& document) const
{
    if (others_)
        document.warn("", "has " + std::to_string(others_) +
                              " emissive surfaces that are no flat rectangles; they become no "
                              "lights");
    if (textured_)
        document.warn("", "has " + std::to_string(textured_) +
                              " emissive surfaces with a texture of their emission; they become "
                              "no lights");
}

} // namespace candelabra::app
