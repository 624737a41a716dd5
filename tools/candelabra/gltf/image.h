// SPDX-License-Identifier: Apache-2.0
// Decodes the images of a glTF file. Internal to the glTF loader.
#pragma once

#include <cstdint>
#include <span>
#include <string>

#include "gltf/document.h"
#include "scene/scene.h"

namespace candelabra::app
{

// All textures of a scene together may have 2 GiB: a few kilobytes of PNG can unpack to a gigabyte.
constexpr uint64_t maxGltfTexels = uint64_t{1} << 29;

// Decodes a PNG, JPEG or WebP image of at most 16384 pixels a side and `texelsLeft` pixels. Throws
// SceneError that names `element`.
Texture decodeGltfImage(const GltfDocument& document, const std::string& element,
                        std::span<const uint8_t> bytes, uint64_t texelsLeft);

} // namespace candelabra::app
