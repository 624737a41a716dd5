// SPDX-License-Identifier: Apache-2.0
// Fixture of the glTF tests: loads what a GltfBuilder made, and inspects warnings and geometry.
#pragma once

#include <string>

#include <gtest/gtest.h>

#include "load/load.h"
#include "scene/scene_error.h"
#include "scene/scene_options.h"
#include "unit/gltf_builder.h"
#include "unit/scene_invariants.h"

namespace candelabra::test
{

class GltfTest : public testing::Test
{
protected:
    // Loads a scene and checks the invariants that every scene must satisfy.
    app::Scene load(const GltfBuilder& builder, const app::SceneOptions& options = {})
    {
        app::Scene scene = app::loadScene(folder_.write("scene.gltf", builder.text()), options);
        EXPECT_EQ(brokenInvariant(scene), "");
        return scene;
    }

    // Returns the message of the SceneError that loading throws, or "no error".
    std::string error(const GltfBuilder& builder, const app::SceneOptions& options = {})
    {
        try {
            app::loadScene(folder_.write("scene.gltf", builder.text()), options);
        } catch (const app::SceneError& e) {
            return e.what();
        }
        return "no error";
    }

    static bool warns(const app::Scene& scene, const std::string& text)
    {
        for (const std::string& warning : scene.warnings)
            if (warning.find(text) != std::string::npos)
                return true;
        return false;
    }

    static glm::dvec3 worldPosition(const app::Scene& scene, const app::Instance& instance,
                                    size_t corner)
    {
        const app::Mesh& mesh = scene.meshes[instance.mesh];
        const glm::vec3 p = mesh.vertices[mesh.indices[corner]].position;
        return glm::dvec3(instance.worldFromObject * glm::dvec4(p, 1));
    }

    // Returns the normal of a triangle's counter-clockwise side; its length is twice the area.
    static glm::dvec3 worldAreaNormal(const app::Scene& scene, const app::Instance& instance,
                                      size_t triangle)
    {
        const glm::dvec3 a = worldPosition(scene, instance, 3 * triangle);
        const glm::dvec3 b = worldPosition(scene, instance, 3 * triangle + 1);
        const glm::dvec3 c = worldPosition(scene, instance, 3 * triangle + 2);
        return glm::cross(b - a, c - a);
    }

    // Returns a vertex normal as a renderer transforms it: by the inverse transpose.
    static glm::dvec3 worldNormal(const app::Scene& scene, const app::Instance& instance,
                                  size_t corner)
    {
        const app::Mesh& mesh = scene.meshes[instance.mesh];
        const glm::dmat3 m = glm::transpose(glm::inverse(glm::dmat3(instance.worldFromObject)));
        return glm::normalize(m * glm::dvec3(mesh.vertices[mesh.indices[corner]].normal));
    }

    TemporaryFolder folder_;
};

} // namespace candelabra::test
