// SPDX-License-Identifier: Apache-2.0
// Finds the camera of each frame of a sequence.
#pragma once

#include "io/choice.h"
#include "scene/scene.h"

namespace candelabra::app
{

enum class CameraPath {
    Still,
    Turn // once around the vertical through the camera, over all frames
};
constexpr Choice<CameraPath> cameraPathChoices[] = {{"still", CameraPath::Still},
                                                    {"turn", CameraPath::Turn}};

// Returns the camera of the frame `index` of `count`, which is `first` in the first frame.
Camera cameraAt(const Camera& first, CameraPath path, uint32_t index, uint32_t count);

} // namespace candelabra::app
