// SPDX-License-Identifier: Apache-2.0
// Reads scene files and parses their JSON, with error messages that name file and element. All
// functions throw SceneError.
#pragma once

#include <cstdint>
#include <string>
#include <string_view>
#include <vector>

#include <nlohmann/json_fwd.hpp>

namespace candelabra::app
{

// The largest coordinate or length in scene files, in metres. It is far beyond any scene, and small
// enough for squared distances to stay finite in single precision.
constexpr double maxCoordinate = 1e12;

// Returns "file: element: reason", or "file: reason" if `element` is empty.
std::string sceneMessage(const std::string& file, const std::string& element,
                         const std::string& reason);
// Throws a SceneError with that message.
[[noreturn]] void failScene(const std::string& file, const std::string& element,
                            const std::string& reason);

// Makes `text` safe for a message of one line, whatever bytes a file holds: cuts it to maxLength
// bytes and replaces everything that is not printable ASCII by '?'.
std::string printable(std::string_view text, size_t maxLength = 160);

// Returns true if the name of `path` ends in `extension` (".json"), in lower or upper case.
bool hasExtension(const std::string& path, std::string_view extension);

// Reads a regular file of 1 to 4294967295 bytes.
std::vector<uint8_t> readSceneFile(const std::string& path);
// Reads `path`, a file that `file` refers to in `element`. Error messages name `file` and
// `element`.
std::vector<uint8_t> readSceneFile(const std::string& path, const std::string& file,
                                   const std::string& element);

// Parses UTF-8 JSON. More than 256 MiB of text or more than 64 levels of nesting are refused, so
// that memory and recursion stay bounded. `file` is used in messages only.
nlohmann::json parseSceneJson(const std::string& file, std::string_view text);

} // namespace candelabra::app
