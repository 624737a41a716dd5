// SPDX-License-Identifier: Apache-2.0
// Computes normals and tangents that a glTF file does not contain.
#include <cmath>

#include "gltf/mesh.h"

namespace candelabra::app
{

namespace
{

// The unit normal of a triangle times twice its area. It is computed in double precision, so that
// the products neither overflow nor vanish, whatever the unit of the file.
glm::dvec3 areaNormal(const Mesh& mesh, size_t triangle)
{
    const auto corner = [&](size_t k) {
        return glm::dvec3(mesh.vertices[mesh.indices[3 * triangle + k]].position);
    };
    return glm::cross(corner(1) - corner(0), corner(2) - corner(0));
}

glm::vec3 normalizedOr(const glm::dvec3& v, const glm::vec3& otherwise)
{
    const double length = glm::length(v);
    return length > 0 && std::isfinite(length) ? glm::vec3(v / length) : otherwise;
}

struct UvGradient {
    glm::dvec3 tangent{0}; // points to where u grows; its length is proportional to the area
    bool mirrored = false; // the texture is seen from its back
};

UvGradient uvGradient(const Mesh& mesh, size_t triangle, const TextureRef& ref)
{
    glm::dvec3 p[3];
    glm::dvec2 uv[3];
    for (size_t k = 0; k < 3; ++k) {
        const Vertex& v = mesh.vertices[mesh.indices[3 * triangle + k]];
        const glm::dvec3 w(v.uv[ref.uvSet], 1);
        p[k] = v.position;
        uv[k] = {glm::dot(glm::dvec3(ref.uRow), w), glm::dot(glm::dvec3(ref.vRow), w)};
    }
    const glm::dvec3 e1 = p[1] - p[0], e2 = p[2] - p[0];
    const glm::dvec2 d1 = uv[1] - uv[0], d2 = uv[2] - uv[0];
    const double determinant = d1.x * d2.y - d1.y * d2.x;
    UvGradient gradient;
    // In an image v points down, but the y of a normal map points up. So the bitangent
    // cross(normal, tangent) points against v, and a triangle that shows the image from the front
    // has the opposite winding in uv space.
    gradient.mirrored = determinant > 0;
    const glm::dvec3 t = (d2.y * e1 - d1.y * e2) * (determinant < 0 ? -1.0 : 1.0);
    const double length = glm::length(t), area = glm::length(glm::cross(e1, e2));
    if (determinant != 0 && length > 0 && std::isfinite(length))
        gradient.tangent = t / length * area;
    return gradient;
}

} // namespace

glm::vec4 anyTangent(const glm::vec3& normal)
{
    // With the axis that is least aligned with the normal, the cross product is far from zero.
    const glm::vec3 a = glm::abs(normal);
    const glm::vec3 axis = a.x <= a.y && a.x <= a.z ? glm::vec3(1, 0, 0)
                           : a.y <= a.z             ? glm::vec3(0, 1, 0)
                                                    : glm::vec3(0, 0, 1);
    return glm::vec4(glm::normalize(glm::cross(axis, normal)), 1);
}

void makeFlatNormals(Mesh& mesh)
{
    std::vector<Vertex> corners;
    corners.reserve(mesh.indices.size());
    for (size_t t = 0; t < mesh.indices.size() / 3; ++t) {
        const glm::vec3 normal = normalizedOr(areaNormal(mesh, t), {0, 1, 0});
        for (size_t k = 0; k < 3; ++k) {
            corners.push_back(mesh.vertices[mesh.indices[3 * t + k]]);
            corners.back().normal = normal;
        }
    }
    mesh.vertices = std::move(corners);
    for (size_t i = 0; i < mesh.indices.size(); ++i)
        mesh.indices[i] = static_cast<uint32_t>(i);
}

size_t repairNormals(Mesh& mesh)
{
    // The length of a unit vector that is quantised to 8 bits is wrong by up to 1%. A vector
    // shorter than 1e-3 was never meant to be a unit vector.
    const auto isBroken = [](const Vertex& v) { return !(glm::length(v.normal) > 1e-3f); };
    size_t broken = 0;
    for (const Vertex& v : mesh.vertices)
        broken += isBroken(v);
    if (broken == 0)
        return 0;
    std::vector<glm::dvec3> sums(mesh.vertices.size(), glm::dvec3(0));
    for (size_t t = 0; t < mesh.indices.size() / 3; ++t)
        for (size_t k = 0; k < 3; ++k)
            sums[mesh.indices[3 * t + k]] += areaNormal(mesh, t);
    for (size_t i = 0; i < mesh.vertices.size(); ++i)
        if (isBroken(mesh.vertices[i]))
            mesh.vertices[i].normal = normalizedOr(sums[i], {0, 1, 0});
    return broken;
}

void makeTangents(Mesh& mesh, const TextureRef& ref)
{
    struct Sum {
        glm::dvec3 tangent{0};
        bool used = false;
    };
    const size_t original = mesh.vertices.size();
    std::vector<Sum> sums[2] = {std::vector<Sum>(original), std::vector<Sum>(original)};
    std::vector<bool> mirroredTriangle(mesh.indices.size() / 3);
    for (size_t t = 0; t < mirroredTriangle.size(); ++t) {
        const UvGradient gradient = uvGradient(mesh, t, ref);
        mirroredTriangle[t] = gradient.mirrored;
        for (size_t k = 0; k < 3; ++k) {
            Sum& sum = sums[gradient.mirrored][mesh.indices[3 * t + k]];
            sum.tangent += gradient.tangent;
            sum.used = true;
        }
    }
    const auto tangent = [&](const Vertex& v, const Sum& sum, float handedness) {
        const glm::dvec3 n(v.normal);
        const glm::vec3 any(anyTangent(v.normal));
        const glm::dvec3 t = sum.tangent - n * glm::dot(n, sum.tangent);
        // If the tangent is parallel to the normal, the remainder is rounding and not a direction.
        const bool clear = glm::length(t) > 1e-6 * glm::length(sum.tangent);
        return glm::vec4(clear ? normalizedOr(t, any) : any, handedness);
    };
    std::vector<uint32_t> twin(original);
    for (uint32_t i = 0; i < original; ++i) {
        twin[i] = i;
        if (sums[1][i].used && sums[0][i].used) {
            twin[i] = static_cast<uint32_t>(mesh.vertices.size());
            mesh.vertices.push_back(mesh.vertices[i]);
        }
        if (sums[1][i].used)
            mesh.vertices[twin[i]].tangent = tangent(mesh.vertices[i], sums[1][i], -1);
        if (!sums[1][i].used || twin[i] != i)
            mesh.vertices[i].tangent = tangent(mesh.vertices[i], sums[0][i], 1);
    }
    for (size_t t = 0; t < mirroredTriangle.size(); ++t)
        for (size_t k = 0; mirroredTriangle[t] && k < 3; ++k)
            mesh.indices[3 * t + k] = twin[mesh.indices[3 * t + k]];
}

} // namespace candelabra::app
