// SPDX-License-Identifier: Apache-2.0
#include "measure/profile/what_if.h"

#include <algorithm>
#include <cmath>

#include <fmt/format.h>

#include "io/error.h"
#include "io/parse.h"
#include "io/statistics.h"
#include "io/table.h"
#include "measure/frame/light_costs.h"
#include "render/setting_names.h"

namespace candelabra::app
{
namespace
{

using Change = WhatIf::Change;
constexpr double smallestFactor = 0.001, largestFactor = 1000;

[[noreturn]] void refuse(const WhatIf& whatIf, const std::string& why)
{
    throw UsageError(fmt::format("--what-if {}: {}", whatIf.text, why));
}

// Changes a light. Returns false if it does not have what is to be changed.
bool change(CndLight& light, const WhatIf& whatIf)
{
    const auto scale = [&](float& length) { length = float(length * whatIf.factor); };
    if (whatIf.change == Change::Influence) {
        if (cndIsDistant(light.type) || std::isinf(light.influenceRadius))
            return false;
        scale(light.influenceRadius);
    } else if (whatIf.change == Change::Radius) {
        if (cndIsPunctual(light.type))
            return false;
        scale(light.radius);
        std::ranges::for_each(light.axisU, scale);
        std::ranges::for_each(light.axisV, scale);
    }
    return true;
}

// Refuses the change if the engine refuses one of the lights.
void requireValid(const std::vector<CndLight>& lights, std::span<const uint32_t> changed,
                  const WhatIf& whatIf)
{
    // The bounding radius of an emitter divided by its limit.
    const auto use = [&](uint32_t i) {
        const double limit = cndIsDistant(lights[i].type) ? 1 : double(lights[i].influenceRadius);
        return double(cndEmitterBoundingRadius(&lights[i])) / limit;
    };
    const uint32_t worst =
        *std::ranges::max_element(changed, [&](uint32_t x, uint32_t y) { return use(x) < use(y); });
    if (use(worst) < 1)
        return;
    const CndLight& light = lights[worst];
    const bool grows = whatIf.change == Change::Radius;
    const double limit = grows ? whatIf.factor / use(worst) : whatIf.factor * use(worst);
    // The text has three digits. A margin of 0.5% keeps rounding from crossing the limit.
    const std::string factor = fmt::format("; take a factor {} {:.3g}", grows ? "below" : "above",
                                           limit * (grows ? 0.995 : 1.005));
    if (cndIsDistant(light.type))
        refuse(whatIf, fmt::format("light {} would be larger than the sky{}", worst, factor));
    refuse(whatIf,
           fmt::format("light {} would have an influence radius of {:.3g} m, which must be greater "
                       "than the bounding radius of its emitter, {:.3g} m{}",
                       worst, light.influenceRadius, cndEmitterBoundingRadius(&light), factor));
}

// "have no size": what lights that are kept do not have.
std::string lackText(const std::vector<uint32_t>& kept, const WhatIf& whatIf)
{
    return fmt::format("{} no {}", kept.size() == 1 ? "has" : "have",
                       whatIf.change == Change::Influence ? "finite influence radius" : "size");
}

// "21.0% less time (19.3% to 22.8%)"
std::string changeText(const PairedRatio& r)
{
    const auto percent = [](double x) { return fmt::format("{:.1f}%", 100 * std::abs(x - 1)); };
    if (r.isFaster())
        return fmt::format("{} less time ({} to {})", percent(r.median), percent(r.high),
                           percent(r.low));
    if (r.isSlower())
        return fmt::format("{} more time ({} to {})", percent(r.median), percent(r.low),
                           percent(r.high));
    return fmt::format("between {} less and {} more time", percent(r.low), percent(r.high));
}

// "If light 7 (1 of 40) had ...": the condition of the sentence.
std::string conditionText(const WhatIf& whatIf, const WhatIfPairs& pairs)
{
    const std::string lights = namesOfLights(pairs.changed, pairs.lights);
    const bool one = pairs.changed.size() == 1;
    switch (whatIf.change) {
    case Change::Influence:
        return fmt::format("If {} had {:g} times {} influence {}", lights, whatIf.factor,
                           one ? "its" : "their", one ? "radius" : "radii");
    case Change::Radius:
        return fmt::format("If {} were {:g} times as large", lights, whatIf.factor);
    case Change::Off:
        return "Without " + (pairs.changed.size() == pairs.lights ? "any light" : lights);
    case Change::Method:
        break;
    }
    return fmt::format("With --specular {}", specularName(whatIf.method));
}

} // namespace

WhatIf parseWhatIf(const std::string& text)
{
    WhatIf out{.text = text};
    const size_t equals = text.find('=');
    const std::string key = text.substr(0, equals);
    const std::string value = equals == std::string::npos ? "" : text.substr(equals + 1);
    if (text == "off")
        return out;
    if (key == "method" && !value.empty()) {
        out.change = Change::Method;
        out.method = chooseSpecular("--what-if method", value);
        return out;
    }
    if ((key != "influence" && key != "radius") || value.empty())
        refuse(out, "give influence=FACTOR, radius=FACTOR, off or method=NAME");
    out.change = key == "radius" ? Change::Radius : Change::Influence;
    const auto factor = parseNumber(value);
    if (!factor || *factor < smallestFactor || *factor > largestFactor)
        refuse(out, fmt::format("the factor must be a number from {:g} to {:g}", smallestFactor,
                                largestFactor));
    out.factor = *factor;
    return out;
}

ChangedScene changedScene(const Scene& scene, std::span<const uint32_t> lights,
                          const WhatIf& whatIf)
{
    ChangedScene out{.scene = scene};
    for (const uint32_t i : lights)
        (change(out.scene.lights[i], whatIf) ? out.changed : out.kept).push_back(i);
    if (out.changed.empty())
        refuse(whatIf, out.kept.empty()
                           ? "there is no light to change"
                           : fmt::format("{} {}", namesOfLights(out.kept, scene.lights.size()),
                                         lackText(out.kept, whatIf)));
    if (whatIf.change != Change::Off) {
        requireValid(out.scene.lights, out.changed, whatIf);
        return out;
    }
    std::vector<uint32_t> last = out.changed; // the last first, so that indices stay valid
    std::sort(last.rbegin(), last.rend());
    for (const uint32_t i : last) {
        out.scene.lights.erase(out.scene.lights.begin() + i);
        if (!out.scene.lightMotions.empty())
            out.scene.lightMotions.erase(out.scene.lightMotions.begin() + i);
    }
    return out;
}

std::string whatIfText(const WhatIf& whatIf, const WhatIfPairs& pairs, const Profile& profile)
{
    const FrameSeries &a = profile.series[0], &b = profile.series[1];
    std::string out;
    if (!pairs.kept.empty())
        out = fmt::format("The change leaves out {}, which {}.\n",
                          namesOfLights(pairs.kept, pairs.lights), lackText(pairs.kept, whatIf));
    out += conditionText(whatIf, pairs) + ", ";
    if (pairs.a == pairs.b)
        out += fmt::format("the same {} pairs of light and pixel would be evaluated; ",
                           grouped(pairs.a));
    else
        out += fmt::format("{} instead of {} pairs of light and pixel would be evaluated; ",
                           grouped(pairs.b), grouped(pairs.a));
    const std::vector<double> aShading = a.shadingMs(), bShading = b.shadingMs();
    const std::string frame = changeText(pairedRatio(a.frameMs, b.frameMs));
    if (medianOf(aShading) > 0)
        return out + fmt::format("shading would take {} and the frame {}.\n",
                                 changeText(pairedRatio(aShading, bShading)), frame);
    return out + fmt::format("the frame would take {}.\n", frame);
}

Json whatIfJson(const WhatIf& whatIf, const WhatIfPairs& pairs, const Profile& profile)
{
    const FrameSeries &a = profile.series[0], &b = profile.series[1];
    return {{"change", whatIf.text},
            {"changedLights", pairs.changed},
            {"keptLights", pairs.kept},
            {"aPairs", pairs.a},
            {"bPairs", pairs.b},
            {"shading", ratioJson(a.shadingMs(), b.shadingMs())},
            {"frame", ratioJson(a.frameMs, b.frameMs)}};
}

} // namespace candelabra::app
