// SPDX-License-Identifier: Apache-2.0
#include "measure/accuracy/thin_lights.h"

#include <array>
#include <cmath>

#include <fmt/format.h>

#include "measure/kernels/in_double.h"
#include "scene/light_types.h"

namespace candelabra::app
{
namespace
{

constexpr std::array<uint32_t, 3> thinTypes{CND_LIGHT_TUBE, CND_LIGHT_RECTANGLE, CND_LIGHT_POLYGON};

std::vector<LightScale> thinScales()
{
    std::vector<LightScale> out{{}};
    for (int power = 1; power <= 5; ++power)
        out.push_back({.size = 1, .thickness = std::pow(10, -power)});
    for (int power = 1; power <= 5; ++power)
        out.push_back({.size = std::pow(10, -power), .thickness = 1});
    return out;
}

} // namespace

double thinLightSteps(const ThinLightSettings& s)
{
    return double(thinTypes.size() * thinScales().size() * s.groups * samplesPerGroup);
}

std::vector<ThinLightPoint> measureThinLights(const VulkanContext& context,
                                              const ThinLightSettings& s, Progress& progress)
{
    std::vector<ThinLightPoint> out;
    for (const uint32_t type : thinTypes) {
        const Evaluation evaluation{.lightType = type, .method = CND_SPECULAR_CONIC};
        const LightEvaluator evaluator(context, evaluation);
        for (const LightScale& scale : thinScales()) {
            progress.doing(fmt::format("thin and small lights: {}", lightTypeName(type)));
            SampleSet set = makeSamples(type, s.groups, s.seed, scale);
            integrateTruth(set, s.truthTolerance, [&](size_t n) { progress.advance(double(n)); });
            out.push_back({type, scale,
                           kernelError(set, evaluator.evaluate(set.receivers, set.lights),
                                       respondInDouble(evaluation, set.receivers, set.lights))});
        }
    }
    return out;
}

Table thinLightTable(const std::vector<ThinLightPoint>& points)
{
    constexpr const char* meanAndMax = "% mean / p99 / max";
    Table table({"light",
                 "size",
                 "thickness",
                 {"above", meanAndMax},
                 {"crossing", meanAndMax},
                 {"F0 0.04: all", meanAndMax},
                 {"formula", meanAndMax},
                 {"float32", meanAndMax},
                 "invalid"},
                "Thin and small lights: errors in percent of the highest true response over light "
                "directions");
    for (const ThinLightPoint& p : points) {
        if (p.scale.size == 1 && p.scale.thickness == 1)
            table.rule();
        table.add({lightTypeName(p.lightType), fmt::format("{:.0e}", p.scale.size),
                   fmt::format("{:.0e}", p.scale.thickness), meanP99Max(p.error.mirror.above),
                   meanP99Max(p.error.mirror.crossing), meanP99Max(p.error.dielectric.all),
                   meanP99Max(p.error.parts->formula.mirror),
                   meanP99Max(p.error.parts->float32.mirror), fmt::format("{}", p.error.invalid)});
    }
    return table;
}

Json thinLightJson(const ThinLightSettings& s, const std::vector<ThinLightPoint>& points)
{
    Json rows = Json::array();
    for (const ThinLightPoint& p : points)
        rows.push_back({{"light", lightTypeName(p.lightType)},
                        {"size", p.scale.size},
                        {"thickness", p.scale.thickness},
                        {"error", toJson(p.error)}});
    return {{"groups", s.groups},
            {"seed", s.seed},
            {"truthTolerance", s.truthTolerance},
            {"points", rows}};
}

} // namespace candelabra::app
