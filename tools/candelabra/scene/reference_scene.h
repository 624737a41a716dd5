// SPDX-License-Identifier: Apache-2.0
// From a scene to the one that the double-precision reference renders.
#pragma once

#include <cstdint>

#include "reference/render.h"
#include "scene/scene.h"

namespace candelabra::app
{

// The planes, balls and lights of `scene` seen from `camera`, the background included; lights of
// other layers than the camera's are left out.
// `imageAspect` (width / height) serves cameras without an aspect of their own. With
// `lightsVisible` area lights are seen. Throws SceneError for what the reference does not know:
// meshes, an environment, orthographic cameras.
reference::Scene toReference(const Scene& scene, const Camera& camera, double imageAspect,
                             bool lightsVisible);

// Of everything that decides the pixels, and of the version of the integrators.
uint64_t referenceHash(const reference::Scene& scene);

} // namespace candelabra::app
