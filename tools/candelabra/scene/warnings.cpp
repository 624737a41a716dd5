// SPDX-License-Identifier: Apache-2.0
#include "scene/warnings.h"

#include <algorithm>
#include <cctype>

#include "scene/scene_file.h"

namespace candelabra::app
{

std::string LoadWarnings::withoutValues(const std::string& text)
{
    std::string out;
    for (size_t i = 0; i < text.size(); ++i) {
        const size_t number = text.find_first_not_of("0123456789.eE+-", i);
        if (std::isdigit(static_cast<unsigned char>(text[i]))) {
            i = std::min(number, text.size()) - 1;
            out += '#';
        } else if (text[i] == '"' && out.ends_with(", is ")) {
            i = std::min(text.find('"', i + 1), text.size() - 1);
        } else if (text[i] != '-') {
            out += text[i];
        }
    }
    return out;
}

void LoadWarnings::addOfKind(const std::string& kind, const std::string& element,
                             const std::string& reason)
{
    const auto [entry, isNew] = byKind_.try_emplace(kind, warnings_.size());
    if (isNew)
        warnings_.push_back({element, reason});
    else if (warnings_[entry->second].element != element)
        ++warnings_[entry->second].others;
}

void LoadWarnings::addInstead(const std::string& file, const SceneError& error,
                              const std::string& instead)
{
    std::string message = error.what();
    if (const std::string start = printable(file, 4096) + ": "; message.starts_with(start))
        message.erase(0, start.size());
    const size_t colon = message.find(": ");
    const bool hasElement = colon != std::string::npos;
    add(hasElement ? message.substr(0, colon) : "",
        (hasElement ? message.substr(colon + 2) : message) + "; " + instead);
}

std::vector<std::string> LoadWarnings::sentences(const std::string& file) const
{
    std::vector<std::string> out;
    for (const Warning& w : warnings_) {
        std::string sentence = printable(file, 4096) + ": " + w.element;
        if (w.others > 0 && !w.element.empty())
            sentence +=
                " (and " + std::to_string(w.others) + (w.others == 1 ? " other)" : " others)");
        out.push_back(sentence + (w.element.empty() ? "" : ": ") + w.reason);
    }
    return out;
}

} // namespace candelabra::app
