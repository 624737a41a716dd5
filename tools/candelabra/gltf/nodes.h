// SPDX-License-Identifier: Apache-2.0
// The node hierarchy of a glTF scene. Internal to the glTF loader; throws SceneError.
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

// The nodes of the default scene (scene 0 without one; all root nodes, with a warning, when the
// file has no scene), parents before children, in file order. Fails for nodes with two parents,
// cycles, scenes that list a node twice or a node that is no root, and transforms that are not
// affine, not finite or leave 1e12 m.
std::vector<GltfPlacedNode> placeGltfNodes(const GltfDocument& document);

} // namespace candelabra::app
