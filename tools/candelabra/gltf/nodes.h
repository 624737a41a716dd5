// SPDX-License-Identifier: Apache-2.0
// Walks the node hierarchy of a glTF scene. Internal to the glTF loader. Throws SceneError.
#pragma once

#include <vector>

#include <glm/glm.hpp>

#include "gltf/document.h"

namespace candelabra::app
{

struct GltfPlacedNode {
    size_t node = 0;
    glm::dmat4 worldFromNode{1};
};

// Returns the nodes of the default scene, parents before children, in the order of the file.
// Without a default scene they are those of scene 0, and without any scene all root nodes and their
// children, with a warning. Fails for nodes with two parents, cycles, scenes that list a node twice
// or a node that is not a root, and transforms that are not affine, not finite, or exceed 1e12 m.
std::vector<GltfPlacedNode> placeGltfNodes(const GltfDocument& document);

} // namespace candelabra::app
