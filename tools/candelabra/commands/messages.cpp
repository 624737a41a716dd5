// SPDX-License-Identifier: Apache-2.0
#include "commands/messages.h"

#include <cstdio>

#include <fmt/format.h>
#include <spdlog/spdlog.h>

#include "scene/shadow_casters.h"

namespace candelabra::app
{
namespace
{

// Says that automatic exposure has reached an end of its range, and what helps; empty if it has
// not.
std::string exposureLimitText(const CndExposureSettings& settings, float ev100)
{
    constexpr const char* hint = "; is the scene in metres, and are its lights in cd, lm or lx?";
    if (ev100 <= settings.minEv100)
        return fmt::format("; {:g} is the lower limit of automatic exposure, so the picture may be "
                           "too dark: --compensation EV above 0 or --exposure EV below {:g} "
                           "brightens it{}",
                           settings.minEv100, settings.minEv100, hint);
    if (ev100 >= settings.maxEv100)
        return fmt::format("; {:g} is the upper limit of automatic exposure, so the picture may be "
                           "too bright: --compensation EV below 0 or --exposure EV above {:g} "
                           "darkens it{}",
                           settings.maxEv100, settings.maxEv100, hint);
    return "";
}

} // namespace

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

void warnOfShadows(const Scene& scene)
{
    for (const std::string& warning : inexactShadows(scene))
        spdlog::warn("warning: {}", warning);
}

std::string exposureText(const CndExposureSettings& settings, const Scene& scene, bool given,
                         const CndExposureStats& stats)
{
    std::string out = fmt::format("exposed at EV100 {:.2f} ({})", stats.adaptedEv100,
                                  given              ? "as given"
                                  : scene.knownEv100 ? "for the light of the studio"
                                                     : "automatic");
    if (scene.exposureCompensation != 0)
        out += fmt::format(", {:+g} EV of the scene", scene.exposureCompensation);
    if (settings.compensation != 0)
        out += fmt::format(", {:+g} EV by --compensation", settings.compensation);
    out += fmt::format(", middle grey {:g}", settings.middleGrey);
    return settings.manual ? out : out + exposureLimitText(settings, stats.adaptedEv100);
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
