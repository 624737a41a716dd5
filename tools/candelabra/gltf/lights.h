// SPDX-License-Identifier: Apache-2.0
// Converts lights of KHR_lights_punctual and KHR_lights_area to CndLight. Internal to the glTF
// loader.
#pragma once

#include <vector>

#include <glm/glm.hpp>

#include "gltf/document.h"
#include "gltf/nodes.h"
#include "scene/scene.h"
#include "scene/scene_options.h"

namespace candelabra::app
{

// The lights found while walking the nodes, and their positions in world space, which placeLights
// takes.
struct GltfLights {
    std::vector<CndLight> lights;
    std::vector<glm::dvec3> positions;
};

// Adds the light of a node, placed by the node's world transform, if the node has a light.
//
// KHR_lights_punctual: point and spot lights have their intensity in cd, directional lights in lx.
// `range` is the influence radius; without it the radius is INFINITY. A point light with
// extras.radius (metres, > 0; of the node or of the light), or otherwise with
// options.punctualRadius, becomes a sphere of that radius and the same intensity, with
// L = I / (pi R^2). A spot with extras.radius becomes a one-sided disc of the same intensity along
// its axis. With options.sunRadius, a directional light becomes a distant sphere of the same
// illuminance. The node's scale changes none of these.
//
// KHR_lights_area (glTF pull request 1948, which was never ratified; this is our reading of it):
// the shape is "sphere", "disk" or "rect". The intensity is in cd/m^2; radius, width and height are
// in metres (default 1) and are multiplied by the node's scale. `range` is our addition. Disks and
// rects face -z and are one-sided.
void addGltfLights(const GltfDocument& document, const GltfPlacedNode& placed,
                   const SceneOptions& options, GltfLights& out);

// The drawn body of a lamp must not shadow the lamp's light. A body is an instance that emits and
// surrounds a light: it hides the light in more than half of all directions, as a closed mesh does,
// and a bulb without its base. Bodies get an occluder layer of their own, which does not
// shadow the lights in them. Shades that do not emit stay what they are. `positions`: of the
// scene's lights, in world space.
void findLampBodies(Scene& scene, const std::vector<glm::dvec3>& positions);

// Turns surfaces that emit light into area lights.
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
