// SPDX-License-Identifier: Apache-2.0
// Small files to try the program with: a glTF scene, a scene description, and a sky.
#pragma once

#include <cstdint>
#include <string>
#include <vector>

#include "io/image.h"

namespace candelabra::app
{

// A binary glTF file: three things on a floor, a lamp with a radius, a spot, and a camera.
std::vector<uint8_t> exampleGltf();

// A scene description of balls and planes only, so that candelabra truth can integrate it.
std::string exampleSceneJson();

// An equirectangular image of a hazy sky with a low sun, in cd/m^2.
Image exampleSky();

} // namespace candelabra::app
