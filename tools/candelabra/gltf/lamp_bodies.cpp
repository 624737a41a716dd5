// SPDX-License-Identifier: Apache-2.0
#include "gltf/lamp_bodies.h"

#include <algorithm>
#include <cmath>
#include <numbers>

namespace candelabra::app
{
namespace
{

bool isInside(const glm::dvec3& p, const Bounds& box)
{
    return glm::all(glm::greaterThan(p, box.min)) && glm::all(glm::lessThan(p, box.max));
}

// Tells whether the triangles between these corners, three each, surround a point. Adds up their
// signed solid angles (Van Oosterom and Strackee 1983), which are 4 pi inside of a closed mesh and
// 0 outside.
bool surround(const std::vector<glm::dvec3>& corners, const glm::dvec3& point)
{
    double halfAngles = 0;
    for (size_t i = 0; i < corners.size(); i += 3) {
        const glm::dvec3 a = corners[i] - point, b = corners[i + 1] - point,
                         c = corners[i + 2] - point;
        const double la = glm::length(a), lb = glm::length(b), lc = glm::length(c);
        halfAngles += std::atan2(glm::dot(a, glm::cross(b, c)), la * lb * lc + glm::dot(a, b) * lc +
                                                                    glm::dot(b, c) * la +
                                                                    glm::dot(c, a) * lb);
    }
    return std::abs(halfAngles) > std::numbers::pi;
}

std::vector<glm::dvec3> cornersOf(const Mesh& mesh, const glm::dmat4& worldFromObject)
{
    std::vector<glm::dvec3> out;
    for (const uint32_t index : mesh.indices)
        out.emplace_back(worldFromObject * glm::dvec4(mesh.vertices[index].position, 1));
    return out;
}

} // namespace

void findLampBodies(Scene& scene, const std::vector<glm::dvec3>& positions)
{
    if (positions.empty())
        return;
    for (Instance& instance : scene.instances) {
        const Material& material = scene.materials[instance.material];
        if (material.unlit || material.emission == glm::vec3(0))
            continue;
        const std::vector<glm::dvec3> corners =
            cornersOf(scene.meshes[instance.mesh], instance.worldFromObject);
        if (corners.empty())
            continue;
        Bounds box{corners[0], corners[0]};
        for (const glm::dvec3& corner : corners)
            box = {glm::min(box.min, corner), glm::max(box.max, corner)};
        for (size_t i = 0; i < positions.size(); ++i)
            if (!cndIsDistant(scene.lights[i].type) && isInside(positions[i], box) &&
                surround(corners, positions[i])) {
                instance.occluderLayer = lampBodyLayer;
                scene.lights[i].unshadowedBy |= 1u << lampBodyLayer;
            }
    }
}

} // namespace candelabra::app
