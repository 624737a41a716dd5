// SPDX-License-Identifier: Apache-2.0
#include "commands/messages.h"

#include <cstdio>

#include <spdlog/spdlog.h>

namespace candelabra::app
{

void logWarnings(const Scene& scene)
{
    constexpr size_t shown = 10; // a broken file can give thousands of warnings
    for (size_t i = 0; i < scene.warnings.size() && i < shown; ++i)
        spdlog::warn("warning: {}", scene.warnings[i]);
    if (scene.warnings.size() > shown)
        spdlog::warn("warning: {} more like these", scene.warnings.size() - shown);
    for (const std::string& note : scene.notes)
        spdlog::info("{}", note);
}

size_t printValidationMessages(const VulkanContext& context)
{
    const auto messages = context.instance().messages().take();
    for (const ValidationMessage& message : messages)
        std::fprintf(stderr, "candelabra: validation: %s: %s\n", message.id.c_str(),
                     message.text.c_str());
    return messages.size();
}

} // namespace candelabra::app
