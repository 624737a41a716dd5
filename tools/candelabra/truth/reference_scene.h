// SPDX-License-Identifier: Apache-2.0
// Converts a scene to one that the double-precision reference renders.
#pragma once

#include <cstdint>
#include <string>
#include <vector>

#include "reference/render.h"
#include "scene/scene.h"

namespace candelabra::app
{

// Converts surfaces, lights and background of `scene`, seen from `camera`. Lights that share no
// layer with the camera are left out. `imageAspect` is the image's width / height, as for
// makeCamera. With `lightsVisible` the emitters of area lights are seen. Materials are those
// without their textures and vertex colours. What castsShadow()
// (scene/shadow_casters.h) refuses stops no light. Surfaces that are not opaque are seen as if
// they were if their alpha reaches the cutoff (masked) or one half (others), else not at
// all. `instances`, if not null, receives the index of the instance of each triangle.
reference::Scene toReference(const Scene& scene, const Camera& camera, double imageAspect,
                             bool lightsVisible, std::vector<uint32_t>* instances = nullptr);

// Returns one sentence for each thing in the scene that the reference leaves out.
std::vector<std::string> leftOutByReference(const Scene& scene);

// A hash of everything that decides the pixels, including the version of the integrators.
uint64_t referenceHash(const reference::Scene& scene, const reference::TruthOptions& options);

} // namespace candelabra::app
