// SPDX-License-Identifier: Apache-2.0
// The depth range of orthographic cameras.
#pragma once

#include "scene/scene.h"

namespace candelabra::app
{

// Moves the near and far plane of every orthographic camera to the scene, with room on either side
// as wide as the scene for what a user moves. The planes only come closer together, so what a
// camera did not show stays out of the picture. Orthographic depth is linear, and float rounds it
// to 6e-8 of the range: files with a far plane at 1e6 m would have surfaces wrong by centimetres.
// Perspective cameras need no such thing: their depth is reversed, and its error is 6e-8 of the
// distance whatever the far plane.
void fitDepthRanges(Scene& scene);

} // namespace candelabra::app
