// SPDX-License-Identifier: Apache-2.0
// The names that settings of a scene and of a frame have on the command line, in the viewer's panel
// and in results.
#pragma once

#include <iterator>

#include "candelabra/candelabra.h"
#include "io/choice.h"
#include "render/renderer.h"
#include "shared/specular_methods.h"

namespace candelabra::app
{

inline constexpr Choice<CndLobeJoining> lobeChoices[] = {{"conserving", CND_LOBES_CONSERVING},
                                                         {"sum", CND_LOBES_SUM}};
inline constexpr Choice<CndSpecularMethod> specularChoices[] = {
#define X(id, NAME, name) {name, CND_SPECULAR_##NAME},
    CND_SPECULAR_METHODS(X)
#undef X
};
inline constexpr Choice<CndCulling> cullingChoices[] = {{"clustered", CND_CULLING_CLUSTERED},
                                                        {"brute", CND_CULLING_BRUTE}};
// The points of each light for which shadows are found.
inline constexpr Choice<uint32_t> shadowChoices[] = {{"off", 0}, {"32", 32}, {"64", 64}};
inline constexpr uint32_t usualShadowPoints = 64; // without a choice of the user
// CND_INFLUENCE_BY_ERROR is chosen by an option of its own, which holds the error.
inline constexpr Choice<CndInfluenceRule> influenceChoices[] = {{"given", CND_INFLUENCE_GIVEN},
                                                                {"uncut", CND_INFLUENCE_UNCUT}};
inline constexpr Choice<Reuse> reuseChoices[] = {
    {"none", Reuse::None}, {"lists", Reuse::Lists}, {"lighting", Reuse::Lighting}};
inline constexpr Choice<HeatMap> heatMapChoices[] = {
    {"none", HeatMap::None},           {"lights-per-pixel", HeatMap::LightsPerPixel},
    {"evaluated", HeatMap::Evaluated}, {"efficiency", HeatMap::Efficiency},
    {"class", HeatMap::PixelClass},    {"shadow", HeatMap::Shadow}};
inline constexpr Choice<CndGBufferLayout> gbufferChoices[] = {{"full", CND_GBUFFER_FULL},
                                                              {"compact", CND_GBUFFER_COMPACT}};
inline constexpr Choice<CndToneMap> toneMapChoices[] = {{"none", CND_TONEMAP_NONE},
                                                        {"reinhard", CND_TONEMAP_REINHARD},
                                                        {"aces", CND_TONEMAP_ACES},
                                                        {"neutral", CND_TONEMAP_PBR_NEUTRAL},
                                                        {"agx", CND_TONEMAP_AGX}};
inline constexpr Choice<CndMetering> meteringChoices[] = {{"average", CND_METERING_AVERAGE},
                                                          {"centre", CND_METERING_CENTRE_WEIGHTED}};

inline const char* specularName(CndSpecularMethod method)
{
    return nameOf(method, specularChoices);
}
// Returns the method that the value of an option names. Throws UsageError.
inline CndSpecularMethod chooseSpecular(const std::string& option, const std::string& text)
{
    if (text == "ltc")
        throw UsageError(option + " \"ltc\": only \"candelabra bench accuracy\" still evaluates "
                                  "linearly transformed cosines; conic replaces them");
    return choose(option, text, specularChoices);
}
// Returns the method after another one; the first one is after the last one.
inline CndSpecularMethod nextSpecular(CndSpecularMethod method)
{
    for (size_t i = 0; i + 1 < std::size(specularChoices); ++i)
        if (specularChoices[i].value == method)
            return specularChoices[i + 1].value;
    return specularChoices[0].value;
}
inline const char* cullingName(CndCulling culling)
{
    return nameOf(culling, cullingChoices);
}
inline const char* shadowsName(uint32_t points)
{
    return nameOf(points, shadowChoices);
}
inline const char* influenceName(CndInfluenceRule rule)
{
    return rule == CND_INFLUENCE_BY_ERROR ? "error" : nameOf(rule, influenceChoices);
}

} // namespace candelabra::app
