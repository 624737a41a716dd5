// SPDX-License-Identifier: Apache-2.0
// Identifies files that were given as scenes but are something else.
#pragma once

#include <string>
#include <string_view>

namespace candelabra::app
{

// Returns what a file with this name and these first bytes is, and what to do about it, as the end
// of a sentence: "is a PNG image, not a scene". Returns an empty text if it may be a scene.
std::string otherFileKind(const std::string& path, std::string_view start);

// Throws a SceneError with that sentence if `path` is a folder or a file of another kind. Does
// nothing if there is no such file, or if it cannot be read.
void refuseOtherFiles(const std::string& path);

} // namespace candelabra::app
