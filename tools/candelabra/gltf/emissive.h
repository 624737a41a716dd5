// SPDX-License-Identifier: Apache-2.0
// Turns surfaces that emit light into area lights. Internal to the glTF loader.
#pragma once

#include "gltf/document.h"
#include "gltf/lights.h"
#include "scene/scene.h"

namespace candelabra::app
{

class GltfEmissiveRectangles
{
public:
    // If an instance of the mesh is a flat rectangle and its material emits, adds a rectangle light
    // of the same luminance, which shines to both sides if the material is double-sided, and
    // returns true: the light takes the place of the instance. Rectangles may consist of any number
    // of triangles. Emissive instances of other shapes, and those with a texture of their emission,
    // stay what they are.
    bool replace(const Mesh& mesh, const Material& material, const glm::dmat4& worldFromObject,
                 GltfLights& out);
    // Warns of emissive instances that replace() has left as they are.
    void warn(const GltfDocument& document) const;

private:
    size_t others_ = 0, textured_ = 0;
};

} // namespace candelabra::app
