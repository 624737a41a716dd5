// SPDX-License-Identifier: Apache-2.0
// From a scene's camera to the matrices of the modules. View space: x right, y up, looking down -z.
#pragma once

#include <string>

#include "candelabra/candelabra.h"
#include "scene/scene.h"

namespace candelabra::app
{

// Depth of pixels without a surface: all our projections are reversed (near 1, far 0).
constexpr float clearDepth = 0.0f;

// Reversed-Z, infinite where the camera's farPlane is 0, y pointing down in clip space as Vulkan
// wants it. `imageAspect` (width / height) serves cameras without an aspect of their own.
// Throws UsageError for a camera that spans no volume, naming it.
CndCamera makeCamera(const Camera& camera, double imageAspect);

// The camera that `wanted` names: empty (the first), a name, an index, or
// "px,py,pz,tx,ty,tz[,fov]" (metres, metres, vertical degrees). Throws UsageError.
Camera selectCamera(const Scene& scene, const std::string& wanted);

} // namespace candelabra::app
