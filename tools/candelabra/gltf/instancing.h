// SPDX-License-Identifier: Apache-2.0
// Reads EXT_mesh_gpu_instancing, by which a node draws its mesh many times. Internal to the glTF
// loader. Throws SceneError.
#pragma once

#include <vector>

#include <glm/glm.hpp>

#include "gltf/document.h"

namespace candelabra::app
{

// Returns the transforms from the mesh of node `node` to the node, one per copy of the mesh: those
// of the extension, otherwise a single identity. Fails if there are more than `mostInstances`.
std::vector<glm::dmat4> readGltfInstancing(const GltfDocument& document, size_t node,
                                           size_t mostInstances);

} // namespace candelabra::app
