// SPDX-License-Identifier: Apache-2.0
// Makes the engine's camera matrices of a scene's camera. In view space x points right, y up, and
// the camera looks along -z.
#pragma once

#include <string>

#include "candelabra/candelabra.h"
#include "scene/scene.h"

namespace candelabra::app
{

// The depth of pixels without a surface. All projections of the program are reversed: the near
// plane has depth 1, the far plane 0.
constexpr float clearDepth = 0.0f;

// Returns view and projection matrices with reversed depth, an infinite far plane if the camera's
// farPlane is 0, and y pointing down in clip space, as in Vulkan. `imageAspect` is the image's
// width / height; cameraOfPicture says how a camera with another aspect is used. Throws UsageError,
// which names the camera, if the camera spans no volume.
CndCamera makeCamera(const Camera& camera, double imageAspect);

// Returns the camera of the scene that `wanted` names or describes: the first for an empty text,
// else one by name, by index, or a new one from "px,py,pz,tx,ty,tz[,fov]": position and target in
// metres, and the vertical field of view in degrees. Throws UsageError.
Camera selectCamera(const Scene& scene, const std::string& wanted);

// Returns the instances of the node of a glTF file that `wanted` names, with those of all nodes
// below it, or of the node with that number in the file. Throws UsageError.
InstanceRange selectNode(const Scene& scene, const std::string& wanted);

} // namespace candelabra::app
