// SPDX-License-Identifier: Apache-2.0
#include "gltf/wires.h"

#include <algorithm>
#include <array>
#include <cmath>

#include <fmt/format.h>
#include <glm/gtc/matrix_transform.hpp>

#include "gltf/material.h"
#include "scene/cofactors.h"

namespace candelabra::app
{

namespace
{

// Widths as shares of the diagonal of the scene's bounds. In a picture 720 pixels high that shows
// the diagonal at full height, a line is 2.4 pixels wide and a point 4.8. The more points there
// are, the smaller each is, down to 0.7 pixels, so that points on a surface cover it and its shape
// remains.
constexpr double lineWidth = 1.0 / 300, mostPointWidth = 1.0 / 150, leastPointWidth = 1.0 / 1000;
// The width of a point, in distances to its neighbours if all points lay evenly on a square as wide
// as the diagonal.
constexpr double pointSpacings = 1.5;
// What a mesh costs besides its vertices and indices, in vertices: instances of a mesh of one point
// are a mesh each.
constexpr uint64_t meshCost = 64;

double pointWidth(size_t count)
{
    return std::clamp(pointSpacings / std::sqrt(static_cast<double>(count)), leastPointWidth,
                      mostPointWidth);
}

// The corners of a box of two ends with four corners each, and its triangles, counter-clockwise
// seen from outside.
constexpr std::array<uint32_t, 36> boxTriangles = {0, 2, 3, 0, 3, 1, 4, 5, 7, 4, 7, 6,
                                                   0, 1, 5, 0, 5, 4, 2, 6, 7, 2, 7, 3,
                                                   0, 4, 6, 0, 6, 2, 1, 3, 7, 1, 7, 5};

// Axes of a box along w. A box without a length has those of the world.
struct BoxAxes {
    glm::dvec3 u{1, 0, 0}, v{0, 1, 0}, w{0, 0, 1};
};

BoxAxes axesAlong(const glm::dvec3& direction)
{
    const double length = glm::length(direction);
    if (!(length > 0))
        return {};
    BoxAxes axes;
    axes.w = direction / length;
    axes.u = glm::dvec3(anyTangent(glm::vec3(axes.w)));
    axes.u = glm::normalize(axes.u - axes.w * glm::dot(axes.u, axes.w));
    axes.v = glm::cross(axes.w, axes.u);
    return axes;
}

// Returns the matrix that transforms normals. Unlike the inverse transpose it exists for transforms
// that flatten too, under which lines can still be drawn.
glm::dmat3 normalTransform(const glm::dmat4& worldFromMesh)
{
    const glm::dmat3 m(worldFromMesh);
    return cofactors(m) * (glm::determinant(m) < 0 ? -1.0 : 1.0);
}

} // namespace

uint32_t GltfWires::materialOf(const GltfWire& wire, uint32_t material)
{
    const Material& source = scene_.materials[material];
    const bool hasNormalMap = source.normalTexture.texture >= 0;
    if (source.unlit || (wire.hasNormals && !hasNormalMap))
        return material;
    const auto [found, isNew] = copies_.try_emplace(std::make_pair(material, wire.hasNormals),
                                                    static_cast<uint32_t>(scene_.materials.size()));
    if (!isNew)
        return found->second;
    Material copy = source;
    if (wire.hasNormals) {
        copy.normalTexture = TextureRef{};
        document_.warn(gltfElement("materials", material),
                       "has a normal map, which points and lines are drawn without");
    } else {
        // A texture of the emission is left out, and then the factor without it says nothing.
        const bool glows = copy.emissiveTexture.texture < 0;
        makeUnlit(copy, copy.baseColor + (glows ? copy.emission : glm::vec3(0)));
        requireFiniteEmission(document_, material, copy);
    }
    scene_.materials.push_back(copy);
    return found->second;
}

void GltfWires::takeBudget(const std::string& element, const GltfWire& wire)
{
    const uint64_t segments = wire.ends.size() / 2;
    takeGltfBudget(document_, element, meshCost + gltfBoxCorners * segments,
                   boxTriangles.size() * segments, budget_, gltfWireHint(wire.isPoints));
}

void GltfWires::addBox(const GltfWire& wire, size_t segment, const Placement& placement, Thin& thin)
{
    Mesh& mesh = scene_.meshes[thin.mesh];
    const uint32_t ends[] = {wire.ends[2 * segment], wire.ends[2 * segment + 1]};
    const BoxAxes axes = axesAlong(placement.at(wire, ends[1]) - placement.at(wire, ends[0]));
    const auto first = static_cast<uint32_t>(mesh.vertices.size());
    for (uint32_t corner = 0; corner < gltfBoxCorners; ++corner) {
        const bool isSecond = corner & 4;
        Vertex vertex = wire.vertices[ends[isSecond]];
        vertex.position = glm::vec3(placement.at(wire, ends[isSecond]));
        const glm::dvec3 normal = placement.normals * glm::dvec3(vertex.normal);
        const double length = glm::length(normal);
        vertex.normal = length > 0 ? glm::vec3(normal / length) : glm::vec3(0, 1, 0);
        vertex.tangent = anyTangent(vertex.normal);
        mesh.vertices.push_back(vertex);
        thin.offsets.push_back(glm::vec3((corner & 1 ? 1.0 : -1.0) * axes.u +
                                         (corner & 2 ? 1.0 : -1.0) * axes.v +
                                         (isSecond ? 1.0 : -1.0) * axes.w));
    }
    for (const uint32_t corner : boxTriangles)
        mesh.indices.push_back(first + corner);
}

void GltfWires::add(const std::string& element, const GltfWire& wire,
                    const glm::dmat4& worldFromMesh, uint32_t material)
{
    const size_t segments = wire.ends.size() / 2;
    takeBudget(element, wire);
    Placement placement{worldFromMesh, normalTransform(worldFromMesh)};
    // Positions keep their digits if they are relative to the first of them.
    const glm::dvec3 origin = placement.at(wire, wire.ends[0]);
    placement.fromMesh[3] -= glm::dvec4(origin, 0);
    Thin thin{static_cast<uint32_t>(scene_.meshes.size()), wire.isPoints, {}};
    Mesh& mesh = scene_.meshes.emplace_back();
    mesh.vertices.reserve(gltfBoxCorners * segments);
    mesh.indices.reserve(boxTriangles.size() * segments);
    thin.offsets.reserve(gltfBoxCorners * segments);
    for (size_t segment = 0; segment < segments; ++segment)
        addBox(wire, segment, placement, thin);
    (wire.isPoints ? points_ : lines_) += segments;
    thin_.push_back(std::move(thin));
    scene_.instances.push_back(
        {thin_.back().mesh, materialOf(wire, material), glm::translate(glm::dmat4(1), origin)});
}

void GltfWires::finish()
{
    if (thin_.empty())
        return;
    const Bounds bounds = sceneBounds(scene_);
    const double diagonal = glm::distance(bounds.min, bounds.max);
    const double size = diagonal > 0 ? diagonal : 1;
    const double ofPoints = points_ ? size * pointWidth(points_) : 0, ofLines = size * lineWidth;
    for (const Thin& thin : thin_) {
        std::vector<Vertex>& vertices = scene_.meshes[thin.mesh].vertices;
        const auto half = static_cast<float>(0.5 * (thin.isPoints ? ofPoints : ofLines));
        for (size_t i = 0; i < vertices.size(); ++i)
            vertices[i].position += half * thin.offsets[i];
    }
    const auto note = [&](const char* what, size_t count, double width) {
        if (count)
            scene_.notes.push_back(
                fmt::format("the scene has {} {}{}, which have no width in the file and are drawn "
                            "{:.3g} m wide",
                            count, what, count == 1 ? "" : "s", width));
    };
    note("point", points_, ofPoints);
    note("line", lines_, ofLines);
}

} // namespace candelabra::app
