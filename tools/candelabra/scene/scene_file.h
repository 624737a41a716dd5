// SPDX-License-Identifier: Apache-2.0
// Getting at scene files: bytes, JSON text, and wording for errors. Everything throws SceneError.
#pragma once

#include <cstdint>
#include <string>
#include <string_view>
#include <vector>

#include <nlohmann/json_fwd.hpp>

namespace candelabra::app
{

// Coordinates and lengths in scene files, metres: far beyond any scene, and small enough that
// squared distances stay finite in single precision.
constexpr double maxCoordinate = 1e12;

// Throws "file: element: reason" (without "element: " when it is empty).
[[noreturn]] void failScene(const std::string& file, const std::string& element,
                            const std::string& reason);

// `text` cut to maxLength bytes, everything outside printable ASCII replaced by '?': messages stay
// one line whatever bytes a file holds.
std::string printable(std::string_view text, size_t maxLength = 160);

// Returns true if the name of `path` ends in `extension` (".json"), in lower or upper case.
bool hasExtension(const std::string& path, std::string_view extension);

// The bytes of a regular file of 1..4294967295 bytes.
std::vector<uint8_t> readSceneFile(const std::string& path);
// The same for a file that `file` refers to in `element`: complaints are about those two.
std::vector<uint8_t> readSceneFile(const std::string& path, const std::string& file,
                                   const std::string& element);

// Parses UTF-8 JSON; refuses more than 256 MiB of text and nesting deeper than 64, so that memory
// and recursion stay bounded. `file` is used in messages only.
nlohmann::json parseSceneJson(const std::string& file, std::string_view text);

} // namespace candelabra::app
