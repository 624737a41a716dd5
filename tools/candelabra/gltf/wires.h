// SPDX-License-Identifier: Apache-2.0
// Points and lines of a glTF file, which are drawn as thin boxes. Internal to the glTF loader.
// Throws SceneError.
#pragma once

#include <cstdint>
#include <map>
#include <string>
#include <utility>
#include <vector>

#include <glm/glm.hpp>

#include "gltf/document.h"
#include "gltf/mesh.h"
#include "scene/scene.h"

namespace candelabra::app
{

class GltfWires
{
public:
    GltfWires(const GltfDocument& document, Scene& scene, GltfMeshBudget& budget)
        : document_(document), scene_(scene), budget_(budget)
    {
    }

    // Adds an instance of points or lines to the scene, with a mesh of its own, which finish()
    // completes. `element` is the primitive, and `material` the one that it has in the file.
    void add(const std::string& element, const GltfWire& wire, const glm::dmat4& worldFromMesh,
             uint32_t material);
    // Gives all points and lines their width, which is a share of the size of the scene, and notes
    // what it is.
    void finish();

private:
    struct Placement {
        glm::dmat4 fromMesh{1};
        glm::dmat3 normals{1};

        glm::dvec3 at(const GltfWire& wire, uint32_t vertex) const
        {
            return glm::dvec3(fromMesh * glm::dvec4(wire.vertices[vertex].position, 1));
        }
    };
    // A mesh of boxes that have no width yet: all corners of an end lie in its middle. `offsets`
    // says by how many half widths finish() moves each.
    struct Thin {
        uint32_t mesh = 0;
        bool isPoints = false;
        std::vector<glm::vec3> offsets;
    };

    // The index of the material that points and lines have instead of `material`. Without normals
    // they have their plain colour, whatever the light (glTF 2.0, section 3.9.7). Normal maps are
    // left out.
    uint32_t materialOf(const GltfWire& wire, uint32_t material);
    // Subtracts the boxes of points or lines from the budget. Fails if it is too small.
    void takeBudget(const std::string& element, const GltfWire& wire);
    void addBox(const GltfWire& wire, size_t segment, const Placement& placement, Thin& thin);

    const GltfDocument& document_;
    Scene& scene_;
    GltfMeshBudget& budget_;
    std::vector<Thin> thin_;
    // Copies of materials for points and lines, by the original and whether there are normals.
    std::map<std::pair<uint32_t, bool>, uint32_t> copies_;
    size_t points_ = 0, lines_ = 0;
};

} // namespace candelabra::app
