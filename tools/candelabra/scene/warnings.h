// SPDX-License-Identifier: Apache-2.0
// Warnings about the content of a scene file.
#pragma once

#include <string>
#include <unordered_map>
#include <vector>

#include "scene/scene_error.h"

namespace candelabra::app
{

class LoadWarnings
{
public:
    // `element` is the part of the file that the warning is about, "" for the whole file.
    void add(const std::string& element, const std::string& reason)
    {
        addOfKind(withoutValues(element) + ": " + withoutValues(reason), element, reason);
    }
    // The same, where warnings of the same kind are one sentence, whatever their elements.
    void addOfKind(const std::string& kind, const std::string& element, const std::string& reason);
    // Adds the message of an error about `file`, and what is used instead.
    void addInstead(const std::string& file, const SceneError& error, const std::string& instead);
    // Returns the sentences in the order in which they were first added. Warnings that differ only
    // in the numbers of their elements, and in values, are one sentence, which names the first and
    // counts the others.
    std::vector<std::string> sentences(const std::string& file) const;

private:
    // Returns text without its numbers, and without the text after "is ".
    static std::string withoutValues(const std::string& text);

    struct Warning {
        std::string element, reason;
        size_t others = 0;
    };
    std::vector<Warning> warnings_;
    std::unordered_map<std::string, size_t> byKind_; // index into warnings_
};

} // namespace candelabra::app
