// SPDX-License-Identifier: Apache-2.0
// Cameras for scenes that have none, whose own show little, or that a user wants to see from other
// sides.
#pragma once

#include "scene/scene.h"

namespace candelabra::app
{

// The number of cameras of a file that are tried, times the number of its vertices, is at most
// this. One camera is always tried.
constexpr size_t mostPointsTried = size_t{1} << 25;

// Appends cameras that show all instances in pictures of the given width / height.
//
// Of an object: "three-quarter" from the front and slightly above, then "front", "right", "back",
// "left" and "above". Each fills fitShare of the picture. The front is the side towards +z, as glTF
// has it. "three-quarter" looks from another side if little of the front would be drawn, for
// instance of a plane that shows its back there.
//
// Of a room, which shows mostly backs of its surfaces from outside and mostly fronts from inside:
// "open-side", which looks in from outside, if the room is open to one side;
// "inside" and "inside-2", at the height of eyes, with the widest views that were found; then the
// cameras above. Scene::interior becomes true.
//
// Of lights alone, which may be visible as emitters: "three-quarter". Without those too, a camera
// at the origin.
//
// Scene::defaultCamera becomes the first camera of the file that shows the scene at least half as
// wide or as high as the picture, or else the first automatic one, with a note. In scenes of very
// many vertices only the first of very many cameras are tried, and the note says how many.
void addAutomaticCameras(Scene& scene, double aspect);

} // namespace candelabra::app
