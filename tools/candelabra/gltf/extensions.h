// SPDX-License-Identifier: Apache-2.0
// Lists the extensions of glTF that the loader reads, and the effects that a picture lacks because
// it reads nothing or only a part of the others. Internal to the glTF loader.
#pragma once

#include <string>

#include <nlohmann/json.hpp>

#include "scene/warnings.h"

namespace candelabra::app
{

// Warns of the extensions that the file uses and of which the loader reads nothing or only a part,
// with a hint where one helps. Returns the extensions that the file calls required and of which the
// loader reads nothing, as one phrase for a message, or "" if there are none. Throws SceneError if
// the lists of extensions are no lists of names.
std::string checkGltfExtensions(const std::string& file, const nlohmann::json& json,
                                LoadWarnings& warnings);

} // namespace candelabra::app
