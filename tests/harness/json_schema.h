// SPDX-License-Identifier: Apache-2.0
// Validates JSON by a schema of tools/candelabra/schemas. json_schema.py does it, with Python's
// jsonschema.
#pragma once

#include <cstdio>
#include <filesystem>
#include <fstream>
#include <string>

#include <nlohmann/json.hpp>
#include <unistd.h>

#include "harness/paths.h"

namespace candelabra::test
{

// Returns what is wrong with a value and where, one line per fault; empty if it is valid, or if
// there is no Python (pythonWord). `name` is the file name of a schema, `part` a place in the
// schema such as "#/properties/points".
inline std::string schemaFaults(const nlohmann::json& value, const std::string& name,
                                const std::string& part = "#")
{
    if (pythonWord().empty())
        return "";
    const std::filesystem::path file =
        std::filesystem::temp_directory_path() /
        ("candelabra-" + std::to_string(getpid()) + "-" + name); // a test runs one at a time
    std::ofstream(file) << value;
    const std::string command = pythonWord() + " " +
                                shellWord(sourcePath("tests/harness/json_schema.py")) + " " +
                                shellWord(sourcePath("tools/candelabra/schemas/" + name)) + " " +
                                shellWord(part) + " < " + shellWord(file.string()) + " 2>&1";
    FILE* output = popen(command.c_str(), "r");
    if (!output)
        return "cannot run " + command;
    std::string faults;
    for (int c = std::fgetc(output); c != EOF; c = std::fgetc(output))
        faults += char(c);
    const int status = pclose(output);
    std::filesystem::remove(file);
    return status == 0 ? "" : faults.empty() ? "failed: " + command : faults;
}

} // namespace candelabra::test
