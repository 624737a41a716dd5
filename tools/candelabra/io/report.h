// SPDX-License-Identifier: Apache-2.0
// Writes the text and JSON files of the commands. A file appears complete or not at all.
#pragma once

#include <string>

#include <nlohmann/json.hpp>

namespace candelabra::app
{

using Json = nlohmann::ordered_json;

// Writes a temporary file beside `path`, then renames it to `path`. A `path` of "-" is standard
// output. Throws RunError.
void writeText(const std::string& path, const std::string& text);
// Writes `json` as text, indented by two spaces, as writeText does. Numbers that are not finite
// become null.
void writeJson(const std::string& path, const Json& json);

// Throws UsageError if no file can be written to `path`, so that a typing mistake is found before
// the work is done: `path` is not the name of a regular file, the name is too long, or its
// directory does not exist or is not writable. `option` is the option that the message names.
void requireWritable(const std::string& option, const std::string& path);
// Throws UsageError if writing `output` would replace `input`.
void requireOther(const std::string& option, const std::string& output, const std::string& input);

// The command line as text, such as "candelabra render hall", with quotes where a shell needs them.
// `program` is the name that replaces argv[0].
std::string commandLine(int argc, const char* const* argv,
                        const std::string& program = "candelabra");

} // namespace candelabra::app
