// SPDX-License-Identifier: Apache-2.0
// Walks the node hierarchy of a glTF scene. Internal to the glTF loader. Throws SceneError.
#pragma once

#include <optional>
#include <string>
#include <vector>

#include <glm/glm.hpp>

#include "gltf/document.h"

namespace candelabra::app
{

struct GltfPlacedNode {
    size_t node = 0;
    glm::dmat4 worldFromNode{1};
    std::optional<size_t> parent;
    uint32_t depth = 0; // number of nodes above it
};

struct GltfTransform {
    glm::dvec3 translation{0};
    glm::dvec4 rotation{0, 0, 0, 1}; // quaternion x, y, z, w, of any length
    glm::dvec3 scale{1};
};

// Returns the matrix that scales, then rotates, then translates. A quaternion that is zero does not
// rotate, with a warning that names `rotation`.
glm::dmat4 gltfMatrix(const GltfDocument& document, const std::string& rotation,
                      const GltfTransform& transform);

// Fails if the last row of the matrix, which `element` names, is not 0, 0, 0, 1.
void requireAffine(const GltfDocument& document, const std::string& element, const glm::dmat4& m);

// Fails if the transform to world space of something in `element` exceeds 1e12 m.
void refuseHugeTransform(const GltfDocument& document, const std::string& element,
                         const glm::dmat4& world);

// Returns the nodes of the default scene, parents before children, in the order of the file.
// Without a default scene they are those of scene 0, and without any scene all root nodes and their
// children, with a warning. Nodes that a scene lists although they have a parent are drawn once,
// where their parents put them, with a warning. Fails for nodes with two parents, cycles, and
// transforms that are not affine, not finite, or exceed 1e12 m.
std::vector<GltfPlacedNode> placeGltfNodes(const GltfDocument& document);

// Returns worldFromNode of all nodes of the file, also of those that are in no scene, such as
// joints that only a skin names. Fails as placeGltfNodes does.
std::vector<glm::dmat4> gltfWorldTransforms(const GltfDocument& document);

// Returns the transforms from the mesh of node `node` to the node, one per copy of the mesh: those
// of EXT_mesh_gpu_instancing, otherwise a single identity. Fails if there are more than
// `mostInstances`.
std::vector<glm::dmat4> readGltfInstancing(const GltfDocument& document, size_t node,
                                           size_t mostInstances);

} // namespace candelabra::app
