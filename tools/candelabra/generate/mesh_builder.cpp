// SPDX-License-Identifier: Apache-2.0
#include "generate/mesh_builder.h"

namespace candelabra::app
{

uint32_t appendVertex(Mesh& mesh, const SurfacePoint& point, const glm::vec2& uv)
{
    Vertex vertex;
    vertex.position = point.position;
    vertex.normal = glm::normalize(point.normal);
    // A smoothed normal need not be perpendicular to the tangent.
    const glm::vec3 tangent =
        point.tangent - vertex.normal * glm::dot(point.tangent, vertex.normal);
    vertex.tangent = glm::vec4(glm::normalize(tangent), 1);
    vertex.uv[0] = vertex.uv[1] = uv;
    mesh.vertices.push_back(vertex);
    return uint32_t(mesh.vertices.size() - 1);
}

void appendTriangle(Mesh& mesh, uint32_t a, uint32_t b, uint32_t c)
{
    const glm::vec3 edge1 = mesh.vertices[b].position - mesh.vertices[a].position;
    const glm::vec3 edge2 = mesh.vertices[c].position - mesh.vertices[a].position;
    // At a pole two corners coincide, and the cross product is 0 or as small as rounding makes it
    // (1e-7 squared). That of a real triangle is larger.
    if (glm::length(glm::cross(edge1, edge2)) > 1e-8f)
        mesh.indices.insert(mesh.indices.end(), {a, b, c});
}

void appendFlatTriangle(Mesh& mesh, const glm::vec3& a, const glm::vec3& b, const glm::vec3& c,
                        const glm::vec3& outward)
{
    const glm::vec3 normal = glm::cross(b - a, c - a);
    if (glm::dot(normal, outward) < 0) {
        appendFlatTriangle(mesh, a, c, b, outward);
        return;
    }
    const uint32_t first = appendVertex(mesh, {a, normal, b - a}, {0, 0});
    appendVertex(mesh, {b, normal, b - a}, {1, 0});
    appendVertex(mesh, {c, normal, b - a}, {0, 1});
    appendTriangle(mesh, first, first + 1, first + 2);
}

void appendQuad(Mesh& mesh, const glm::vec3& a, const glm::vec3& b, const glm::vec3& c,
                const glm::vec3& d, const glm::vec3& outward)
{
    const glm::vec3 normal = glm::cross(c - a, d - b);
    if (glm::dot(normal, outward) < 0) {
        appendQuad(mesh, b, a, d, c, outward);
        return;
    }
    const uint32_t first = appendVertex(mesh, {a, normal, b - a}, {0, 0});
    appendVertex(mesh, {b, normal, b - a}, {1, 0});
    appendVertex(mesh, {c, normal, b - a}, {1, 1});
    appendVertex(mesh, {d, normal, b - a}, {0, 1});
    appendTriangle(mesh, first, first + 1, first + 2);
    appendTriangle(mesh, first, first + 2, first + 3);
}

void appendMesh(Mesh& mesh, const Mesh& part, const glm::mat4& transform)
{
    const uint32_t first = uint32_t(mesh.vertices.size());
    const glm::mat3 linear(transform);
    const glm::mat3 normalTransform = glm::transpose(glm::inverse(linear));
    for (Vertex vertex : part.vertices) {
        vertex.position = glm::vec3(transform * glm::vec4(vertex.position, 1));
        vertex.normal = glm::normalize(normalTransform * vertex.normal);
        vertex.tangent = glm::vec4(glm::normalize(linear * glm::vec3(vertex.tangent)), 1);
        mesh.vertices.push_back(vertex);
    }
    for (const uint32_t index : part.indices)
        mesh.indices.push_back(first + index);
}

} // namespace candelabra::app
