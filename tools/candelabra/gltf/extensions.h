// SPDX-License-Identifier: Apache-2.0
// Which extensions of glTF the loader reads, and what is missing from the picture without the
// others. Internal to the glTF loader.
#pragma once

#include <string>
#include <vector>

#include <nlohmann/json.hpp>

#include "gltf/warnings.h"

namespace candelabra::app
{

// Warns of the extensions that the file uses and that the loader does not read, with a hint where
// one helps. Returns those of them that the file calls required, as one phrase for a message, or ""
// if there are none. Throws SceneError if the lists of extensions are no lists of names.
std::string checkGltfExtensions(const std::string& file, const nlohmann::json& json,
                                GltfWarnings& warnings);

} // namespace candelabra::app
