// SPDX-License-Identifier: Apache-2.0
// Reads the materials, textures and images of a glTF file. Internal to the glTF loader. Throws
// SceneError.
#pragma once

#include <cstdint>
#include <span>
#include <string>

#include "gltf/document.h"
#include "scene/scene.h"

namespace candelabra::app
{

// Appends every material of the document to the scene, in order, and the textures that they use. If
// a primitive has no material, appends the default material of glTF 2.0 as well and returns its
// index, else returns 0. Textures whose image cannot be read are left out, with a warning.
uint32_t readGltfMaterials(const GltfDocument& document, Scene& scene);

// Tells whether the alpha of the textures and vertex colours of a material of the document has a
// meaning. That of an opaque material has none (glTF 2.0, section 3.9.4), also if the material is
// glass and so Material::alphaMode is AlphaMode::Blend. A material of -1 is the default material,
// which is opaque.
bool isGltfAlphaUsed(const GltfDocument& document, int material);

// All textures of a scene together may have 2 GiB: a few kilobytes of PNG can unpack to a gigabyte.
constexpr uint64_t maxGltfTexels = uint64_t{1} << 29;

// Decodes a PNG, JPEG or WebP image of at most 16384 pixels a side and `texelsLeft` pixels. Throws
// SceneError that names `element`.
Texture decodeGltfImage(const GltfDocument& document, const std::string& element,
                        std::span<const uint8_t> bytes, uint64_t texelsLeft);

} // namespace candelabra::app
