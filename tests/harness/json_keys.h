// SPDX-License-Identifier: Apache-2.0
// Compares the keys of what the program prints as JSON with tests/data/json_keys.txt, so that none
// vanishes unnoticed: others read them.
#pragma once

#include <fstream>
#include <map>
#include <set>
#include <string>

#include <nlohmann/json.hpp>

#include "harness/paths.h"

namespace candelabra::test
{

// Adds the keys of all objects in a value by the path of the object. The elements of an array count
// as one.
inline void addKeys(const nlohmann::json& value, const std::string& path,
                    std::map<std::string, std::set<std::string>>& keys)
{
    for (const auto& [key, member] : value.items()) {
        if (value.is_object())
            keys[path].insert(key);
        if (member.is_structured())
            addKeys(member, value.is_object() ? path + "." + key : path + "[]", keys);
    }
}

// Returns the lines that json_keys.txt lacks (+) or has too many (-) for a value that it calls
// `name`; empty if there are none.
inline std::string keyFaults(const nlohmann::json& value, const std::string& name)
{
    std::map<std::string, std::set<std::string>> keys;
    addKeys(value, name, keys);
    std::set<std::string> found, listed;
    for (const auto& [path, members] : keys) {
        std::string line = path + ":";
        for (const std::string& key : members)
            line += " " + key;
        found.insert(line);
    }
    std::ifstream file(dataPath("json_keys.txt"));
    for (std::string line; std::getline(file, line);)
        if (line.substr(0, line.find_first_of(".[:")) == name)
            listed.insert(line);
    std::string out;
    for (const std::string& line : found)
        if (!listed.contains(line))
            out += "+" + line + "\n";
    for (const std::string& line : listed)
        if (!found.contains(line))
            out += "-" + line + "\n";
    return out;
}

} // namespace candelabra::test
