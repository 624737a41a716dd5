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

// Turns (glTF texture, colour space) into an index into scene.textures, decoding each image once
// per colour space and sampler. Throws SceneError naming the image.
class GltfTextures
{
public:
    GltfTextures(const GltfDocument& document, Scene& scene) : document_(document), scene_(scene) {}

    // -1, with a warning, when the texture has no image that we can read.
    int32_t find(int gltfTexture, bool srgb);

private:
    Texture decode(size_t image);

    const GltfDocument& document_;
    Scene& scene_;
    std::map<std::tuple<int, int, bool>, int32_t> known_; // (image, sampler, srgb) -> texture
    uint64_t texels_ = 0;
};

} // namespace candelabra::app
