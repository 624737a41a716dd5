// SPDX-License-Identifier: Apache-2.0
// Decodes the images that glTF textures refer to. Internal to the glTF loader.
#pragma once

#include <cstdint>
#include <map>
#include <tuple>

#include "gltf/document.h"
#include "scene/scene.h"

namespace candelabra::app
{

// Finds the index in scene.textures for a glTF texture and a colour space. Each image is decoded
// once per colour space and sampler. Throws SceneError that names the image.
class GltfTextures
{
public:
    GltfTextures(const GltfDocument& document, Scene& scene) : document_(document), scene_(scene) {}

    // Returns -1, with a warning, if the texture has no PNG or JPEG image.
    int32_t find(int gltfTexture, bool srgb);

private:
    Texture decode(size_t image);

    const GltfDocument& document_;
    Scene& scene_;
    std::map<std::tuple<int, int, bool>, int32_t> known_; // (image, sampler, srgb) -> texture
    uint64_t texels_ = 0;                                 // decoded so far
};

} // namespace candelabra::app
