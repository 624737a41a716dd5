// SPDX-License-Identifier: Apache-2.0
// Shows the window until the first scene is loaded.
#pragma once

#include <memory>

#include "viewer/scene_loader.h"
#include "viewer/screen.h"

namespace candelabra::app
{

// Shows how far the loader is, until it has the scene, and gives the window the size of the scene's
// view. Returns null if the user closes the window before. Throws what loading has thrown; with
// `showFailure` the window first shows it until the user closes it.
std::unique_ptr<LoadedScene> waitForFirstScene(Screen& screen, SceneLoader& loader,
                                               bool showFailure);

} // namespace candelabra::app
