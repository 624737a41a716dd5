// SPDX-License-Identifier: Apache-2.0
// Converts a scene to one that the double-precision reference renders.
#pragma once

#include <cstdint>

#include "reference/render.h"
#include "scene/scene.h"

namespace candelabra::app
{

// Converts planes, balls, lights and background of `scene`, seen from `camera`. Lights that share
// no layer with the camera are left out. `imageAspect` is the image's width / height, as for
// makeCamera. With `lightsVisible` the emitters of area lights are seen. Throws
// SceneError for what the reference cannot render: meshes, an environment, orthographic cameras.
reference::Scene toReference(const Scene& scene, const Camera& camera, double imageAspect,
                             bool lightsVisible);

// A hash of everything that decides the pixels, including the version of the integrators.
uint64_t referenceHash(const reference::Scene& scene);

} // namespace candelabra::app
