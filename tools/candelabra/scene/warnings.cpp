// SPDX-License-Identifier: Apache-2.0
#include "gltf/warnings.h"

#include "scene/scene_file.h"

namespace candelabra::app
{

void GltfWarnings::add(const std::string& element, const std::string& reason)
{
    const auto [entry, isNew] = byReason_.try_emplace(reason, warnings_.size());
    if (isNew)
        warnings_.push_back({element, reason});
    else
        ++warnings_[entry->second].others;
}

std::vector<std::string> GltfWarnings::sentences(const std::string& file) const
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
