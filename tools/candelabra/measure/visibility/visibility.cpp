// SPDX-License-Identifier: Apache-2.0
#include "measure/visibility/visibility.h"

#include <algorithm>
#include <array>
#include <atomic>
#include <cmath>
#include <ctime>
#include <mutex>
#include <numbers>
#include <numeric>
#include <set>
#include <thread>

#include <fmt/format.h>

#include "candelabra/glm.hpp"
#include "generate/random.h"
#include "io/table.h"
#include "measure/frame/frames.h"
#include "measure/frame/pick.h"
#include "measure/profile/profile_frames.h"
#include "reference/emitter_points.h"
#include "reference/joining.h"
#include "reference/truth.h"
#include "reference/visibility.h"
#include "render/readback.h"

namespace candelabra::app
{
namespace
{

struct RivalRow {
    const char* name;
    std::optional<int> rays; // as VisibilityError::rays
};
constexpr RivalRow rivals[] = {{"no shadows", 0},       {"1 ray to the centre", 1},
                               {"1 random ray", 1},     {"4 random rays", 4},
                               {"16 random rays", 16},  {"64 random rays", 64},
                               {"256 random rays", 256}};
constexpr size_t rivalCount = std::size(rivals);
constexpr size_t firstRandom = 2;

double medianOfPass(const FrameSeries& series, const std::string& name)
{
    for (const FrameSeries::Pass& pass : series.passes)
        if (pass.name == name)
            return medianOf(pass.ms);
    return 0;
}

// The CPU time of all threads while a frame is recorded and drawn.
double cpuMsOf(const VulkanContext& context, Renderer& renderer, const FrameOptions& frame)
{
    const std::clock_t start = std::clock();
    context.submitAndWait([&](VkCommandBuffer cmd) { renderer.record(cmd, 0, frame); });
    return 1e3 * double(std::clock() - start) / CLOCKS_PER_SEC;
}

// The rays from a surface to a light.
class LightRays
{
public:
    LightRays(const reference::Scene& scene, const reference::Occluders& occluders, size_t light,
              const reference::SurfacePoint& surface)
        : occluders_(occluders),
          surface_(surface),
          light_(scene.lights[light]),
          origin_(scene.lightOrigin),
          ignoredLayers_(scene.ignoredLayers[light]),
          emitter_(light_, origin_, surface.position)
    {
    }

    // Returns what each rival takes for the visible share.
    std::array<double, rivalCount> shares(Random& random) const
    {
        std::array<double, rivalCount> out;
        out.fill(1);
        if (emitter_.contain())
            return out;
        out[1] = isSeen(centre()) ? 1 : 0;
        int seen = 0, cast = 0;
        for (size_t rival = firstRandom; rival < rivalCount; ++rival) {
            for (; cast < *rivals[rival].rays; ++cast)
                seen += isSeen(randomPoint(random));
            out[rival] = double(seen) / cast;
        }
        return out;
    }

private:
    reference::EmitterPoint centre() const
    {
        if (emitter_.isPoint())
            return emitter_.at(0, 0);
        const glm::dvec3 vector(
            toGlm(cndIsDistant(light_.type) ? light_.direction : light_.position));
        const glm::dvec3 toCentre =
            cndIsDistant(light_.type) ? -vector : origin_ + vector - surface_.position;
        return emitter_.along(glm::normalize(toCentre)).value_or(emitter_.at(0.5, 0.5));
    }
    // A point that can light the surface.
    reference::EmitterPoint randomPoint(Random& random) const
    {
        constexpr int mostTries = 64;
        reference::EmitterPoint out;
        for (int i = 0; i < mostTries; ++i) {
            const glm::vec2 uv = random.uniform2();
            out = emitter_.at(double(uv.x), double(uv.y));
            if (out.density > 0 && glm::dot(surface_.normal, out.direction) > 0)
                break;
        }
        return out;
    }
    // As the truth tests points (reference/visibility.h).
    bool isSeen(const reference::EmitterPoint& point) const
    {
        const bool distant = std::isinf(point.distance);
        return !occluders_.stop(
            {.origin = surface_.position,
             .direction = distant ? point.direction : point.distance * point.direction,
             .end = distant ? point.distance : 1 / (1 + 0x1p-12),
             .ignoredLayers = ignoredLayers_});
    }

    const reference::Occluders& occluders_;
    const reference::SurfacePoint& surface_;
    const CndLight& light_;
    glm::dvec3 origin_;
    uint32_t ignoredLayers_;
    reference::EmitterPoints emitter_;
};

// The luminance of a pixel in three channels; 0 if it shows no surface.
struct PixelValues {
    glm::dvec3 truth{0};
    std::array<glm::dvec3, rivalCount> rivals{};
};

PixelValues pixelValues(const reference::Scene& scene, const reference::Occluders& occluders,
                        const reference::Hit& hit, double tolerance, uint64_t seed)
{
    const reference::Material& surface = scene.materials[hit.material];
    const reference::Material material =
        joinLobes(surface, glm::dot(hit.surface.normal, hit.surface.toEye), scene.lobes,
                  scene.energyCompensation);
    PixelValues out{.truth = surface.emission};
    out.rivals.fill(surface.emission);
    reference::addLights({.lights = scene.lights,
                          .ignoredLayers = scene.ignoredLayers,
                          .lightOrigin = scene.lightOrigin,
                          .occluders = &occluders,
                          .relative = tolerance,
                          .seed = seed},
                         hit.surface, material, out.truth);
    Random random(seed);
    for (size_t i = 0; i < scene.lights.size(); ++i) {
        const glm::dvec3 light =
            truthLuminance(hit.surface, material, scene.lights[i], scene.lightOrigin, tolerance)
                .luminance;
        if (light == glm::dvec3(0))
            continue;
        const auto shares = LightRays(scene, occluders, i, hit.surface).shares(random);
        for (size_t rival = 0; rival < rivalCount; ++rival)
            out.rivals[rival] += shares[rival] * light;
    }
    return out;
}

std::vector<uint32_t> randomPixels(PixelSize size, uint32_t count)
{
    const uint32_t all = size.width * size.height;
    std::set<uint32_t> chosen;
    Random random(1);
    while (chosen.size() < std::min(count, all))
        chosen.insert(random.below(all));
    return {chosen.begin(), chosen.end()};
}

// Errors relative to the values of `whole`, where these are positive.
ErrorSpread errorsOver(const std::vector<double>& whole, const std::vector<double>& values,
                       const std::vector<double>& truths)
{
    std::vector<double> errors;
    for (size_t i = 0; i < truths.size(); ++i)
        if (whole[i] > 0)
            errors.push_back(std::abs(values[i] - truths[i]) / whole[i]);
    if (errors.empty())
        return {};
    return {.mean = std::accumulate(errors.begin(), errors.end(), 0.0) / double(errors.size()),
            .spread = spreadOf(errors)};
}

} // namespace

double visibilitySteps(const VisibilitySettings& s)
{
    return 2.0 * double(maxWarmUp) + 3.0 * s.rounds + s.pixels;
}

Scene withPointLights(Scene scene)
{
    constexpr float pi = std::numbers::pi_v<float>;
    for (CndLight& light : scene.lights) {
        float power[3];
        if (light.type == CND_LIGHT_DISTANT_SPHERE) {
            light.type = CND_LIGHT_DIRECTIONAL;
            for (float& emission : light.emission)
                emission *= pi * light.radius * light.radius;
        } else if (!cndIsPunctual(light.type) &&
                   cndLuminousPowerOfLight(&light, power, nullptr) == CND_SUCCESS) {
            light.type = CND_LIGHT_POINT;
            for (int c = 0; c < 3; ++c)
                light.emission[c] = power[c] / (4 * pi);
        }
    }
    return scene;
}

VisibilityCost measureVisibilityCost(const VulkanContext& context, Renderer& renderer,
                                     const VisibilitySettings& settings, Progress& progress)
{
    progress.doing("timing");
    FrameOptions without = settings.frame;
    without.shadows = 0;
    const Profile profile = profileFrames(
        context, renderer, {.variants = {settings.frame, without}, .rounds = settings.rounds},
        [&] { progress.advance(1); });
    VisibilityCost out{.stats = countPairs(context, renderer, settings.frame),
                       .proveMs = medianOfPass(profile.series[0], "prove_dark"),
                       .askMs = medianOfPass(profile.series[0], "ask_pairs"),
                       .listMs = medianOfPass(profile.series[0], "list_occluders"),
                       .visibilityMs = medianOfPass(profile.series[0], "pair_visibility"),
                       .ratio = pairedRatio(profile.series[1].gpuMs, profile.series[0].gpuMs)};
    std::vector<double> more;
    for (uint32_t round = 0; round < settings.rounds; ++round) {
        const double with = cpuMsOf(context, renderer, settings.frame);
        more.push_back(with - cpuMsOf(context, renderer, without));
        progress.advance(1);
    }
    out.cpuMs = medianOf(more);
    return out;
}

double measureRayMs(const VulkanContext& context, Renderer& pointLights,
                    const VisibilitySettings& settings, Progress& progress)
{
    const Profile profile = profileFrames(context, pointLights,
                                          {.variants = {settings.frame}, .rounds = settings.rounds},
                                          [&] { progress.advance(1); });
    const uint64_t asked = countPairs(context, pointLights, settings.frame).askedPairs;
    return medianOfPass(profile.series[0], "pair_visibility") /
           double(std::max<uint64_t>(asked, 1));
}

VisibilityErrors measureVisibilityErrors(const VulkanContext& context, Renderer& renderer,
                                         const reference::Scene& model,
                                         const VisibilitySettings& settings, Progress& progress)
{
    progress.doing("integrating");
    context.submitAndWait([&](VkCommandBuffer cmd) { renderer.record(cmd, 0, settings.frame); });
    const Image image = readRadiance(context, renderer);
    const std::vector<uint32_t> pixels = randomPixels(renderer.size(), settings.pixels);
    const reference::Occluders occluders(model.objects, model.triangles);
    std::vector<PixelValues> found(pixels.size());
    std::atomic<size_t> next{0};
    std::mutex progressMutex;
    const auto work = [&] {
        for (size_t i = next++; i < pixels.size(); i = next++) {
            const auto hit = reference::tracePixel(
                model, image.width, image.height, pixels[i] % image.width, pixels[i] / image.width);
            if (hit)
                found[i] = pixelValues(model, occluders, *hit, settings.tolerance, pixels[i]);
            const std::lock_guard lock(progressMutex);
            progress.advance(1);
        }
    };
    {
        std::vector<std::jthread> threads;
        for (unsigned i = 1; i < std::thread::hardware_concurrency(); ++i)
            threads.emplace_back(work);
        work();
    }
    VisibilityErrors out;
    std::vector<double> truths, ours, others[rivalCount];
    const std::vector<double>& unshadowed = others[0];
    for (size_t i = 0; i < pixels.size(); ++i) {
        if (!(luminanceOf(found[i].rivals[0]) > 0))
            continue;
        const float* p = &image.pixels[size_t{3} * pixels[i]];
        truths.push_back(luminanceOf(found[i].truth));
        ours.push_back(luminanceOf({p[0], p[1], p[2]}));
        for (size_t rival = 0; rival < rivalCount; ++rival)
            others[rival].push_back(luminanceOf(found[i].rivals[rival]));
        out.leaks += !(truths.back() > 0) && ours.back() > 0;
    }
    out.compared = truths.size();
    const auto add = [&](const RivalRow& row, const std::vector<double>& values) {
        out.rows.push_back({row.name, row.rays, errorsOver(truths, values, truths),
                            errorsOver(unshadowed, values, truths)});
    };
    add({"this engine", {}}, ours);
    for (size_t rival = 0; rival < rivalCount; ++rival)
        add(rivals[rival], others[rival]);
    if (!settings.pictures)
        return out;
    const auto addPicture = [&](const char* name, auto&& valueOf) {
        Image picture{image.width, image.height, 3,
                      std::vector<float>(image.pixels.size(), std::nanf(""))};
        for (size_t i = 0; i < pixels.size(); ++i)
            for (int c = 0; c < 3; ++c)
                picture.pixels[size_t{3} * pixels[i] + c] = float(valueOf(found[i])[c]);
        out.pictures.emplace_back(name, std::move(picture));
    };
    out.pictures.emplace_back("this engine", image);
    addPicture("truth", [](const PixelValues& v) { return v.truth; });
    for (size_t rival = 0; rival < rivalCount; ++rival)
        addPicture(rivals[rival].name, [&](const PixelValues& v) { return v.rivals[rival]; });
    return out;
}

namespace
{

// Returns the time of pair_visibility if each pair that asks takes one ray. 0: it is not known.
double oneRayMs(const VisibilityCost& cost)
{
    return cost.rayMs * double(cost.stats.askedPairs);
}

// Returns the time of pair_visibility in a frame with the visible shares of a row.
std::optional<double> visibilityMs(const VisibilityCost& cost, const VisibilityError& row)
{
    if (!row.rays)
        return cost.visibilityMs;
    if (*row.rays > 0 && oneRayMs(cost) == 0)
        return {};
    return *row.rays * oneRayMs(cost);
}

// Returns how many rays take as long as a pair that asks. 0: it is not known.
double raysPerPair(const VisibilityCost& cost)
{
    return oneRayMs(cost) > 0 ? cost.visibilityMs / oneRayMs(cost) : 0;
}

} // namespace

std::string visibilityText(const VisibilityCost& cost, const VisibilityErrors& errors,
                           PixelSize size)
{
    const CndLightingStats& s = cost.stats;
    const double pairs = double(std::max<uint64_t>(s.contributingPairs, 1));
    std::string out = shadowText(s, size);
    out += fmt::format("{} that blocks list, {} proven dark; prove_dark {} ms\n",
                       counted(s.triedProofs, "light"), grouped(s.wonProofs),
                       threeDigits(cost.proveMs));
    out += fmt::format("ask_pairs {} ms, list_occluders {} ms, pair_visibility {} ms: {} us per "
                       "pair of a pixel and a light that reaches it; CPU time {} us per pair\n",
                       threeDigits(cost.askMs), threeDigits(cost.listMs),
                       threeDigits(cost.visibilityMs), threeDigits(1e3 * cost.visibilityMs / pairs),
                       threeDigits(1e3 * cost.cpuMs / pairs));
    out += fmt::format("the frame takes {:.3f} [{:.3f}, {:.3f}] times as long as without shadows\n",
                       cost.ratio.median, cost.ratio.low, cost.ratio.high);
    if (raysPerPair(cost) > 0)
        out += fmt::format("a pair that asks takes as long as {} rays\n",
                           threeDigits(raysPerPair(cost)));
    Table table({"visible share of a light", "pair_visibility, ms", "mean error", "p95", "p99",
                 "of the pixel: mean", "p95", "p99"});
    const auto percent = [](double x) { return fmt::format("{:.3f}%", 100 * x); };
    for (const VisibilityError& e : errors.rows) {
        const auto ms = visibilityMs(cost, e);
        std::vector<std::string> cells{e.name, ms ? threeDigits(*ms) : "-"};
        for (const ErrorSpread& error : {e.ofUnshadowed, e.ofPixel})
            for (const double x : {error.mean, error.spread.p95, error.spread.p99})
                cells.push_back(percent(x));
        table.add(cells);
    }
    table.note(fmt::format("Errors of the luminance of {}, relative to the pixel without shadows, "
                           "and to the pixel itself where it has light. {} that should be black "
                           "{} light. A ray takes as long as a pair that asks in the same scene "
                           "with point lights.",
                           counted(errors.compared, "random pixel"), counted(errors.leaks, "pixel"),
                           errors.leaks == 1 ? "has" : "have"));
    return out + table.text();
}

Json visibilityJson(const VisibilityCost& cost, const VisibilityErrors& errors)
{
    const CndLightingStats& s = cost.stats;
    const double pairs = double(std::max<uint64_t>(s.contributingPairs, 1));
    const auto percent = [](const ErrorSpread& e) {
        return Json{{"meanPercent", 100 * e.mean},
                    {"p95Percent", 100 * e.spread.p95},
                    {"p99Percent", 100 * e.spread.p99}};
    };
    Json list = Json::array();
    for (const VisibilityError& e : errors.rows) {
        const auto ms = visibilityMs(cost, e);
        list.push_back({{"name", e.name},
                        {"pairVisibilityMs", ms ? Json(*ms) : Json()},
                        {"ofUnshadowed", percent(e.ofUnshadowed)},
                        {"ofPixel", percent(e.ofPixel)}});
    }
    return {{"pairs",
             {{"reaching", s.contributingPairs},
              {"asked", s.askedPairs},
              {"lit", s.askedPairs - s.partlyLitPairs - s.darkPairs},
              {"partlyLit", s.partlyLitPairs},
              {"dark", s.darkPairs},
              {"missingSlots", s.missingShadowSlots},
              {"unfinished", s.unfinishedPairs}}},
            {"proofs", {{"tried", s.triedProofs}, {"won", s.wonProofs}}},
            {"proveDarkMs", cost.proveMs},
            {"askPairsMs", cost.askMs},
            {"listOccludersMs", cost.listMs},
            {"pairVisibilityMs", cost.visibilityMs},
            {"raysPerPair", raysPerPair(cost)},
            {"cpuMicrosecondsPerPair", 1e3 * cost.cpuMs / pairs},
            {"timeOverUnshadowed",
             {{"median", cost.ratio.median}, {"low", cost.ratio.low}, {"high", cost.ratio.high}}},
            {"pixelsCompared", errors.compared},
            {"leaks", errors.leaks},
            {"errors", list}};
}

} // namespace candelabra::app
