// SPDX-License-Identifier: Apache-2.0
// KHR_lights_punctual and KHR_lights_area -> CndLight. Internal to the glTF loader.
#pragma once

#include <optional>
#include <vector>

#include <glm/glm.hpp>

#include "gltf/document.h"
#include "scene/scene.h"
#include "scene/scene_options.h"

namespace candelabra::app
{

// Lights found while walking the nodes; positions in world space, to be placed by placeLights.
struct GltfLights {
    std::vector<CndLight> lights;
    std::vector<glm::dvec3> positions;
};

// Adds the light of node `node` under its world transform, if it has one.
//   KHR_lights_punctual: point and spot in cd, directional in lx, `range` is the influence radius
//   (without it: INFINITY). A point light with extras.radius (metres, > 0), else with
//   options.punctualRadius, becomes a sphere of that radius and the same intensity, L = I / (pi
//   R^2). With options.sunRadius a directional light becomes a distant sphere of the same
//   illuminance. Scale does not change any of these. KHR_lights_area (glTF pull request 1948, never
//   ratified; ours): shape "sphere", "disk" or "rect", intensity in cd/m^2, radius, width and
//   height in metres (default 1) times the node's scale, and, as an addition, `range`. Disks and
//   rects face -z and are one-sided.
void addGltfLights(const GltfDocument& document, size_t node, const glm::dmat4& worldFromNode,
                   const SceneOptions& options, GltfLights& out);

} // namespace candelabra::app
