// SPDX-License-Identifier: Apache-2.0
// Warnings about the content of a glTF file. Internal to the glTF loader.
#pragma once

#include <string>
#include <unordered_map>
#include <vector>

namespace candelabra::app
{

class GltfWarnings
{
public:
    // `element` is the part of the file that the warning is about, "" for the whole file.
    void add(const std::string& element, const std::string& reason);
    // Returns one sentence for each reason, in the order in which reasons were first added. If
    // several elements have the same reason, the sentence names the first and counts the others.
    std::vector<std::string> sentences(const std::string& file) const;

private:
    struct Warning {
        std::string element, reason;
        size_t others = 0;
    };
    std::vector<Warning> warnings_;
    std::unordered_map<std::string, size_t> byReason_; // index into warnings_
};

} // namespace candelabra::app
