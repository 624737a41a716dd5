// SPDX-License-Identifier: Apache-2.0
// Functions with which the generated scenes are put together.
#pragma once

#include <string>
#include <utility>

#include <glm/gtc/matrix_transform.hpp>

#include "scene/scene.h"

namespace candelabra::app
{

// Makes an upright camera that looks along `direction`, which may have any length but must not be
// vertical.
inline Camera makeUprightCamera(std::string name, const glm::dvec3& position,
                                const glm::dvec3& direction, double verticalFov)
{
    Camera camera;
    camera.name = std::move(name);
    camera.position = position;
    camera.forward = glm::normalize(direction);
    const glm::dvec3 right = glm::normalize(glm::cross(camera.forward, glm::dvec3(0, 1, 0)));
    camera.up = glm::cross(right, camera.forward);
    camera.verticalFov = verticalFov;
    return camera;
}

struct SceneBuilder {
    Scene scene;

    uint32_t addMesh(Mesh mesh)
    {
        scene.meshes.push_back(std::move(mesh));
        return uint32_t(scene.meshes.size() - 1);
    }

    uint32_t addMaterial(Material material)
    {
        scene.materials.push_back(std::move(material));
        return uint32_t(scene.materials.size() - 1);
    }

    // `baseColor` is the reflectance of the metal at normal incidence (F0), in linear Rec.709.
    uint32_t addMetal(std::string name, const glm::vec3& baseColor, float perceptualRoughness)
    {
        return addMaterial({.name = std::move(name),
                            .baseColor = baseColor,
                            .metalness = 1,
                            .perceptualRoughness = perceptualRoughness});
    }

    // `baseColor` is the diffuse albedo in linear Rec.709.
    uint32_t addDielectric(std::string name, const glm::vec3& baseColor, float perceptualRoughness)
    {
        return addMaterial({.name = std::move(name),
                            .baseColor = baseColor,
                            .perceptualRoughness = perceptualRoughness});
    }

    void place(uint32_t mesh, uint32_t material, const glm::dmat4& worldFromObject)
    {
        scene.instances.push_back({mesh, material, worldFromObject});
    }

    // Adds an instance that is scaled, then turned by `yaw` radians about y, then moved.
    void place(uint32_t mesh, uint32_t material, const glm::dvec3& position,
               const glm::dvec3& scale = glm::dvec3(1), double yaw = 0)
    {
        glm::dmat4 worldFromObject = glm::translate(glm::dmat4(1), position);
        if (yaw != 0)
            worldFromObject = glm::rotate(worldFromObject, yaw, glm::dvec3(0, 1, 0));
        place(mesh, material, glm::scale(worldFromObject, scale));
    }

    // Adds an instance of a mesh that has radius 1 and extends from y = 0 to y = 1, so that it
    // extends from `from` to `to`.
    void placeRod(uint32_t mesh, uint32_t material, const glm::dvec3& from, const glm::dvec3& to,
                  double radius)
    {
        const glm::dvec3 axis = to - from;
        const glm::dvec3 other = axis.x * axis.x < 0.5 * glm::dot(axis, axis) ? glm::dvec3(1, 0, 0)
                                                                              : glm::dvec3(0, 0, 1);
        const glm::dvec3 side = glm::normalize(glm::cross(axis, other));
        const glm::dvec3 front = glm::cross(side, glm::normalize(axis));
        place(mesh, material,
              glm::dmat4(glm::dvec4(side * radius, 0), glm::dvec4(axis, 0),
                         glm::dvec4(front * radius, 0), glm::dvec4(from, 1)));
    }
};

} // namespace candelabra::app
