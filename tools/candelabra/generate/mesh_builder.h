// SPDX-License-Identifier: Apache-2.0
// Functions that build the meshes of the generated scenes.
#pragma once

#include <cmath>
#include <cstdint>

#include <glm/glm.hpp>

#include "scene/scene.h"

namespace candelabra::app
{

// A point of a parametric surface. Normal and tangent need not have unit length, nor be
// perpendicular.
struct SurfacePoint {
    glm::vec3 position{0};
    glm::vec3 normal{0, 1, 0};
    glm::vec3 tangent{1, 0, 0};
};

// Adds a vertex and returns its index.
uint32_t appendVertex(Mesh& mesh, const SurfacePoint& point, const glm::vec2& uv);

// Adds a triangle of existing vertices unless it is degenerate.
void appendTriangle(Mesh& mesh, uint32_t a, uint32_t b, uint32_t c);

// Adds one flat triangle that faces `outward`.
void appendFlatTriangle(Mesh& mesh, const glm::vec3& a, const glm::vec3& b, const glm::vec3& c,
                        const glm::vec3& outward);

// Adds one flat quad that faces `outward`. Its corners are given in order around it.
void appendQuad(Mesh& mesh, const glm::vec3& a, const glm::vec3& b, const glm::vec3& c,
                const glm::vec3& d, const glm::vec3& outward);

// Adds a transformed copy of `part`. `transform` must not mirror.
void appendMesh(Mesh& mesh, const Mesh& part, const glm::mat4& transform);

// The unit vector at `angle` radians from +x towards +y.
inline glm::vec2 direction(float angle)
{
    return {std::cos(angle), std::sin(angle)};
}

// Adds a grid of columns x rows quads on the surface `at(u, v)`, with u and v in [0, 1]. The cross
// product of its derivatives by u and by v must point out.
template <typename Surface>
void appendGrid(Mesh& mesh, uint32_t columns, uint32_t rows, Surface&& at)
{
    const uint32_t first = uint32_t(mesh.vertices.size());
    for (uint32_t row = 0; row <= rows; ++row) {
        for (uint32_t column = 0; column <= columns; ++column) {
            const glm::vec2 uv{float(column) / float(columns), float(row) / float(rows)};
            appendVertex(mesh, at(uv.x, uv.y), uv);
        }
    }
    for (uint32_t row = 0; row < rows; ++row) {
        for (uint32_t column = 0; column < columns; ++column) {
            const uint32_t a = first + row * (columns + 1) + column;
            const uint32_t d = a + columns + 1;
            appendTriangle(mesh, a, a + 1, d + 1);
            appendTriangle(mesh, a, d + 1, d);
        }
    }
}

} // namespace candelabra::app
