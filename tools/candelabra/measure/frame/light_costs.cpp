// SPDX-License-Identifier: Apache-2.0
#include "measure/frame/light_costs.h"

#include <algorithm>
#include <cctype>
#include <cmath>
#include <limits>

#include <fmt/format.h>
#include <spdlog/spdlog.h>

#include "measure/frame/surfaces.h"
#include "reference/vectors.h"
#include "render/readback.h"
#include "scene/light_types.h"

namespace candelabra::app
{
namespace
{

constexpr uint32_t costTile = 8; // pixels a side, like a workgroup of shade_tiles
constexpr double everywhere = std::numeric_limits<double>::infinity();

// The members of a light that decide which surfaces it can light.
struct LightVolume {
    uint32_t light;
    glm::dvec3 centre{0}; // world space
    double influenceRadius = everywhere;
    double boundingRadius = 0; // of the emitter; distant lights: the sine of their angular radius
    glm::dvec3 axis{0};        // the direction in which it shines; zero: all directions
    double cosOuter = 0;       // cosine of the angle to the axis up to which it shines
    bool distant = false;

    bool covers(const reference::SurfacePoint& s) const
    {
        if (distant)
            return glm::dot(s.normal, -axis) > -boundingRadius;
        const glm::dvec3 away = s.position - centre;
        if (glm::dot(away, away) >= influenceRadius * influenceRadius ||
            glm::dot(s.normal, away) >= boundingRadius)
            return false;
        return axis == glm::dvec3(0) || glm::dot(away, axis) > cosOuter * glm::length(away);
    }
};

LightVolume volumeOf(uint32_t index, const CndLight& l, const glm::dvec3& origin)
{
    const uint32_t fields = cndLightFields(l.type);
    LightVolume out{.light = index,
                    .boundingRadius = double(cndEmitterBoundingRadius(&l)),
                    .distant = cndIsDistant(l.type) != 0};
    if (!out.distant) {
        out.centre = origin + reference::vec3(l.position);
        out.influenceRadius = l.influenceRadius;
    }
    const bool bothSides = fields & CND_LIGHT_FIELD_TWO_SIDED_BIT && l.twoSided;
    if (fields & CND_LIGHT_FIELD_DIRECTION_BIT && !bothSides)
        out.axis = glm::normalize(reference::vec3(l.direction));
    else if (fields & CND_LIGHT_FIELD_AXIS_V_BIT && !bothSides)
        out.axis = glm::normalize(glm::cross(reference::vec3(l.axisU), reference::vec3(l.axisV)));
    if (fields & CND_LIGHT_FIELD_CONE_BIT)
        out.cosOuter = std::cos(double(l.outerConeAngle));
    return out;
}

struct Box {
    glm::dvec3 min{everywhere}, max{-everywhere};

    double squaredDistance(const glm::dvec3& p) const
    {
        const glm::dvec3 d = glm::max(glm::max(min - p, p - max), glm::dvec3(0));
        return glm::dot(d, d);
    }
};

std::vector<glm::vec4> drawAndReadPairs(const VulkanContext& context, Renderer& renderer,
                                        FrameOptions frame)
{
    frame.heatMap = HeatMap::Evaluated;
    frame.reuse = Reuse::None;
    // Draws again until all light lists fit, because pairs of missing lists are not counted.
    do
        context.submitAndWait([&](VkCommandBuffer cmd) { renderer.record(cmd, 0, frame); });
    while (!renderer.fits(0));
    if (const uint32_t missing = renderer.lightingStats(0).unlistedClusters)
        spdlog::warn("warning: there was no memory for {}; pairs of pixels without a list are not "
                     "counted",
                     counted(missing, "light list"));
    return readPairs(context, renderer);
}

struct CostRow {
    uint32_t light;
    uint64_t pixels;
    double pairs, share, ms;
};

std::vector<CostRow> rowsOf(const LightCosts& costs, size_t count, double shadingMs)
{
    std::vector<CostRow> out;
    for (size_t i = 0; i < std::min(count, costs.lights.size()); ++i) {
        const LightCost& l = costs.lights[i];
        const double share = costs.pairs > 0 ? l.pairs / costs.pairs : 0;
        out.push_back({l.light, l.pixels, l.pairs, share, share * shadingMs});
    }
    return out;
}

} // namespace

LightCosts shareOut(const PairImage& image, const std::vector<CndLight>& lights,
                    const glm::dvec3& origin, const Camera& camera)
{
    const auto [width, height] = image.size;
    std::vector<LightVolume> volumes;
    for (uint32_t i = 0; i < lights.size(); ++i)
        if (isShown(lights[i], camera))
            volumes.push_back(volumeOf(i, lights[i], origin));

    LightCosts out;
    std::vector<LightCost> all(lights.size());
    std::vector<reference::SurfacePoint> points;
    std::vector<std::pair<uint32_t, uint32_t>>
        covered; // a light, and the pixels of the tile that it covers
    for (uint32_t top = 0; top < height; top += costTile)
        for (uint32_t left = 0; left < width; left += costTile) {
            Box box;
            double evaluated = 0;
            points.clear();
            covered.clear();
            for (uint32_t y = top; y < std::min(top + costTile, height); ++y)
                for (uint32_t x = left; x < std::min(left + costTile, width); ++x) {
                    evaluated += double(image.evaluated[size_t(y) * width + x]);
                    if (const auto point = image.pointAt(x, y)) {
                        points.push_back(*point);
                        box.min = glm::min(box.min, point->position);
                        box.max = glm::max(box.max, point->position);
                    }
                }
            out.surfaces += points.size();
            out.pairs += evaluated;
            uint64_t sum = 0;
            for (const LightVolume& volume : volumes) {
                if (points.empty() ||
                    (!volume.distant && box.squaredDistance(volume.centre) >=
                                            volume.influenceRadius * volume.influenceRadius))
                    continue;
                uint32_t pixels = 0;
                for (const reference::SurfacePoint& point : points)
                    pixels += volume.covers(point);
                sum += pixels;
                if (pixels)
                    covered.emplace_back(volume.light, pixels);
            }
            out.coveredPairs += sum;
            if (!sum)
                out.others += evaluated;
            for (const auto& [light, pixels] : covered) {
                all[light].pixels += pixels;
                all[light].pairs += evaluated * double(pixels) / double(sum);
            }
        }
    for (uint32_t i = 0; i < all.size(); ++i)
        if (all[i].pixels)
            out.lights.push_back({i, all[i].pixels, all[i].pairs});
    std::ranges::stable_sort(out.lights, std::ranges::greater(), &LightCost::pairs);
    return out;
}

LightCosts lightCosts(const VulkanContext& context, Renderer& renderer, const Scene& scene,
                      const FrameOptions& frame)
{
    PairImage image;
    for (const glm::vec4& pairs : drawAndReadPairs(context, renderer, frame))
        image.evaluated.push_back(pairs.y);
    const Surfaces surfaces(context, renderer, frame);
    image.size = surfaces.size();
    image.pointAt = [&](uint32_t x, uint32_t y) { return surfaces.pointAt(x, y); };
    std::vector<CndLight> lights;
    lightsAtTime(scene, frame.time, lights);
    LightCosts out = shareOut(image, lights, scene.lightOrigin, frame.camera);
    out.time = frame.time;
    return out;
}

uint64_t evaluatedPairs(const VulkanContext& context, Renderer& renderer, const FrameOptions& frame)
{
    uint64_t sum = 0;
    for (const glm::vec4& pairs : drawAndReadPairs(context, renderer, frame))
        sum += uint64_t(pairs.y);
    return sum;
}

std::string namesOfLights(const std::vector<uint32_t>& lights, size_t all)
{
    constexpr size_t named = 3;
    if (lights.size() == all)
        return all == 1 ? "the only light" : "all " + counted(all, "light");
    std::string out = lights.size() == 1 ? "light " : "lights ";
    for (size_t i = 0; i < std::min(lights.size(), named); ++i)
        out += fmt::format("{}{}", i ? ", " : "", lights[i]);
    return out + fmt::format("{} ({} of {})", lights.size() > named ? ", ..." : "",
                             grouped(lights.size()), grouped(all));
}

Table lightCostTable(const LightCosts& costs, const Scene& scene, size_t count, double shadingMs)
{
    Table table({"light",
                 Column::words("type"),
                 Column::words("position m"),
                 {"influence radius", "m"},
                 "pixels",
                 "of all",
                 "pairs",
                 "share",
                 {"time", "ms"}});
    const auto add = [&](const std::string& name, const std::string& type,
                         const std::string& position, const std::string& radius, uint64_t pixels,
                         double pairs, double ms) {
        table.add(
            {name, type, position, radius, pixels ? grouped(pixels) : "",
             pixels ? fmt::format("{:.2f}%", 100.0 * double(pixels) / double(costs.surfaces)) : "",
             grouped(uint64_t(std::llround(pairs))),
             fmt::format("{:.2f}%", costs.pairs > 0 ? 100 * pairs / costs.pairs : 0.0),
             threeDigits(ms)});
    };
    double shown = 0;
    std::vector<uint32_t> named;
    const std::vector<CostRow> rows = rowsOf(costs, count, shadingMs);
    for (const CostRow& row : rows) {
        const CndLight light = lightAtTime(scene, row.light, costs.time);
        const glm::dvec3 at = scene.lightOrigin + reference::vec3(light.position);
        add(fmt::format("{}", row.light), lightTypeName(light.type),
            cndIsDistant(light.type) ? "" : fmt::format("{:.2f}, {:.2f}, {:.2f}", at.x, at.y, at.z),
            threeDigits(double(light.influenceRadius)), row.pixels, row.pairs, row.ms);
        shown += row.pairs;
        named.push_back(row.light);
    }
    const double perPair = costs.pairs > 0 ? shadingMs / costs.pairs : 0;
    table.rule();
    const double rest = costs.pairs - costs.others - shown;
    add(counted(costs.lights.size() - rows.size(), "other light"), "", "", "", 0, rest,
        rest * perPair);
    if (costs.others > 0)
        add("tiles without a light", "", "", "", 0, costs.others, costs.others * perPair);
    table.add({"shading", "", "", "", "", "", grouped(uint64_t(std::llround(costs.pairs))),
               "100.00%", threeDigits(shadingMs)});
    if (shown > 0) {
        std::string who = namesOfLights(named, scene.lights.size());
        who[0] = char(std::toupper(who[0]));
        table.note(fmt::format("{} {} {:.1f}% of shading.", who,
                               named.size() == 1 ? "takes" : "take", 100 * shown / costs.pairs));
    }
    return table;
}

Json lightCostJson(const LightCosts& costs, const Scene& scene, size_t count, double shadingMs)
{
    Json rows = Json::array();
    for (const CostRow& row : rowsOf(costs, count, shadingMs)) {
        const CndLight light = lightAtTime(scene, row.light, costs.time);
        rows.push_back({{"light", row.light},
                        {"type", lightTypeName(light.type)},
                        {"position", light.position},
                        {"influenceRadius", light.influenceRadius},
                        {"pixels", row.pixels},
                        {"pairs", row.pairs},
                        {"share", row.share},
                        {"ms", row.ms}});
    }
    double sum = 0;
    for (const LightCost& light : costs.lights)
        sum += light.pairs;
    const double perPair = costs.pairs > 0 ? shadingMs / costs.pairs : 0;
    return {{"shadingMs", shadingMs},
            {"surfacePixels", costs.surfaces},
            {"pairs", costs.pairs},
            {"coveredPairs", costs.coveredPairs},
            {"lightsThatCoverPixels", costs.lights.size()},
            {"sumOfAllLightsMs", sum * perPair},
            {"tilesWithoutLightMs", costs.others * perPair},
            {"lights", rows}};
}

} // namespace candelabra::app
