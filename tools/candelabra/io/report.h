// SPDX-License-Identifier: Apache-2.0
// What a command leaves behind for machines: text files that appear whole or not at all, and where
// its numbers come from.
#pragma once

#include <string>

#include <nlohmann/json.hpp>

#include "render/vulkan_instance.h"

namespace candelabra::app
{

using Json = nlohmann::ordered_json;

// Writes to a temporary file beside `path`, then renames it; "-" is stdout. Throws RunError.
void writeText(const std::string& path, const std::string& text);
// The same, indented by two. Numbers that are not finite become null.
void writeJson(const std::string& path, const Json& json);

// Throws UsageError when the directory of `path` does not exist, so that a typing mistake is found
// before the work is done. `option` names it in the sentence.
void requireWritable(const std::string& option, const std::string& path);

// Program version, commit, device, driver, UTC time and command line.
Json provenance(const DeviceInfo& device, const std::string& commandLine);

// "candelabra render hall ...", with quotes where a shell needs them.
std::string commandLine(int argc, const char* const* argv);

} // namespace candelabra::app
