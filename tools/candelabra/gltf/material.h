// SPDX-License-Identifier: Apache-2.0
// glTF materials, textures and images -> Scene. Internal to the glTF loader; throws SceneError.
#pragma once

#include "gltf/document.h"
#include "scene/scene.h"

namespace candelabra::app
{

// Appends every material of the document, in order, and the textures they use; then, when a
// primitive has no material, the default material of glTF 2.0, whose index is returned. Images are
// PNG or JPEG up to 16384 pixels a side.
uint32_t readGltfMaterials(const GltfDocument& document, Scene& scene);

} // namespace candelabra::app
