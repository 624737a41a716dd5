// SPDX-License-Identifier: Apache-2.0
#include "measure/frame/frames.h"

#include <algorithm>
#include <chrono>

#include <fmt/format.h>

#include "io/table.h"
#include "render/frame_ring.h"
#include "render/setting_names.h"
#include "scene/light_types.h"

namespace candelabra::app
{

namespace
{

// Draws samples of frames in a ring of two slots, and collects their statistics in order.
class FrameCollector
{
public:
    FrameCollector(const VulkanContext& context, Renderer& renderer)
        : renderer_(renderer), ring_(context, 2)
    {
    }
    // Records and submits a sample. Times are collected if it is `measured`.
    void draw(const FrameOptions& frame, bool measured)
    {
        const auto [cmd, slot, reused] = ring_.begin();
        if (reused)
            collect(slot);
        renderer_.record(cmd, slot, frame);
        ring_.submit();
        drawn_[slot] = {.open = true, .measured = measured, .lastSample = frame.sample.isLast()};
        newest_ = slot;
    }
    // Tells whether the newest frame had enough room (Renderer::fits). Waits for the GPU.
    bool fits()
    {
        wait();
        return renderer_.fits(newest_);
    }
    // Waits for the GPU and collects what has not been collected.
    void wait()
    {
        ring_.wait();
        collect(1 - newest_);
        collect(newest_);
    }
    const MeasuredFrames& result() const { return out_; }

private:
    struct Drawn {
        bool open = false; // its statistics have not been collected
        bool measured = false, lastSample = true;
    };
    void collect(uint32_t slot)
    {
        Drawn& drawn = drawn_[slot];
        if (!drawn.open)
            return;
        drawn.open = false;
        out_.last = renderer_.stats(slot);
        if (!drawn.measured)
            return;
        const std::vector<PassTime>& passes = out_.last.passes;
        passes_.insert(passes_.end(), passes.begin(), passes.end());
        if (!drawn.lastSample)
            return;
        out_.times.add(passes_);
        passes_.clear();
    }

    Renderer& renderer_;
    FrameRing ring_;
    Drawn drawn_[2];
    uint32_t newest_ = 0;
    std::vector<PassTime> passes_; // of the samples of the frame so far
    MeasuredFrames out_;
};

bool asksForShadows(const CndLightingStats& stats)
{
    return stats.askedPairs || stats.shadowSlots || stats.missingShadowSlots || stats.triedProofs ||
           stats.litEntries || stats.hiddenEntries;
}

} // namespace

MeasuredFrames renderFrames(const VulkanContext& context, Renderer& renderer,
                            const FrameOptions& options, FrameCounts counts, bool moving,
                            const std::function<void()>& onFrame, const FrameHooks& hooks,
                            double interval)
{
    FrameCollector frames(context, renderer);
    for (uint32_t i = 0; i < counts.warmUp; ++i) {
        frames.draw(options, false);
        onFrame();
    }
    while (counts.warmUp && !frames.fits())
        frames.draw(options, false);
    using Clock = std::chrono::steady_clock;
    for (const auto start = Clock::now();
         std::chrono::duration<double>(Clock::now() - start).count() < counts.warmUpSeconds;)
        frames.draw(options, false);
    for (uint32_t i = counts.first; i < counts.measured; i += counts.step) {
        FrameOptions frame = options;
        if (moving && i > 0) {
            frame.time += interval * i;
            frame.deltaTime = float(interval);
            frame.resetExposure = false;
        }
        if (hooks.finished)
            frames.wait(); // for the warm-up frames
        if (hooks.prepare)
            hooks.prepare(i, frame);
        for (uint32_t sample = 0; sample < counts.samples; ++sample) {
            frame.sample = {sample, counts.samples};
            frames.draw(frame, true);
            onFrame();
        }
        if (hooks.finished) {
            frames.wait();
            hooks.finished(i);
        }
    }
    frames.wait();
    return frames.result();
}

CndLightingStats countPairs(const VulkanContext& context, Renderer& renderer, FrameOptions options)
{
    options.countPairs = true;
    options.heatMap = HeatMap::None;
    options.culling = CND_CULLING_CLUSTERED;
    context.submitAndWait([&](VkCommandBuffer cmd) { renderer.record(cmd, 0, options); });
    return renderer.stats(0).lighting;
}

std::string passTable(const PassTimes& times)
{
    const bool one = times.frames() == 1; // then all statistics are the same
    Table table(one ? std::vector<Column>{"GPU pass", "ms"}
                    : std::vector<Column>{"GPU pass", "min ms", "median ms", "p95 ms"});
    const auto add = [&](const PassSummary& pass) {
        if (one)
            table.add({pass.name, threeDigits(pass.medianMs)});
        else
            table.add({pass.name, threeDigits(pass.minMs), threeDigits(pass.medianMs),
                       threeDigits(pass.p95Ms)});
    };
    for (const PassSummary& pass : times.summary())
        add(pass);
    table.rule();
    add(times.total());
    return table.text();
}

std::string planText(const FrameStats& frame)
{
    std::string types;
    for (uint32_t type = 0; type < CND_LIGHT_TYPE_COUNT; ++type)
        if (const uint32_t count = frame.lighting.lightTypeCounts[type])
            types += fmt::format("{}{} {}", types.empty() ? "" : ", ", grouped(count),
                                 lightTypeName(type));
    std::string out;
    if (frame.lit)
        out =
            fmt::format("lights: {}; other types have no passes\n", types.empty() ? "none" : types);
    for (const CndPassPlan& pass : frame.plan) {
        // A pass that has a time although it did nothing was recorded (CndPassPlan).
        const bool recorded = std::ranges::any_of(
            frame.passes, [&](const PassTime& p) { return p.name == pass.name; });
        const char* what = recorded ? "recorded, found nothing to do" : "skipped";
        out += fmt::format("{:<20} {}\n", pass.name,
                           pass.skipped ? fmt::format("{}: {}", what, pass.skipped) : "runs");
    }
    return out;
}

std::string shadowText(const CndLightingStats& stats, PixelSize size)
{
    if (!asksForShadows(stats))
        return "";
    const auto perPixel = [&](uint64_t pairs) {
        return threeDigits(double(pairs) / (double(size.width) * size.height));
    };
    const uint64_t asked = stats.askedPairs;
    std::string out = fmt::format(
        "shadows: {} lights reach a pixel. It asks for {}, and sees {} of them wholly, {} in part "
        "and {} not at all; {} used",
        perPixel(stats.contributingPairs), perPixel(asked),
        perPixel(asked - stats.partlyLitPairs - stats.darkPairs), perPixel(stats.partlyLitPairs),
        perPixel(stats.darkPairs), counted(stats.shadowSlots, "slot"));
    if (stats.litEntries || stats.hiddenEntries || stats.testedEntries || stats.walkedEntries)
        out += fmt::format("; of the lights in lists, {} are lit, {} hidden, {} tested and {} "
                           "walked for",
                           grouped(stats.litEntries), grouped(stats.hiddenEntries),
                           grouped(stats.testedEntries), grouped(stats.walkedEntries));
    else if (stats.shadowSlots)
        out += ", all kept from the frame before, so that this one asked for none";
    if (stats.missingShadowSlots)
        out += fmt::format("; {} missing, whose pixels take longer", // a message says more
                           counted(stats.missingShadowSlots, "slot"));
    if (stats.unfinishedPairs)
        out += fmt::format("; {} searches for occluders cut off, because the device limits loops",
                           grouped(stats.unfinishedPairs));
    return out + "\n";
}

Json toJson(const std::vector<CndPassPlan>& plan)
{
    Json out = Json::array();
    for (const CndPassPlan& pass : plan)
        out.push_back({{"pass", pass.name},
                       {"runs", !pass.skipped},
                       {"skipped", pass.skipped ? Json(pass.skipped) : Json()}});
    return out;
}

Json toJson(const PassTimes& times)
{
    const auto one = [](const PassSummary& pass) {
        return Json{{"name", pass.name},
                    {"minMs", pass.minMs},
                    {"medianMs", pass.medianMs},
                    {"p95Ms", pass.p95Ms}};
    };
    Json passes = Json::array();
    for (const PassSummary& pass : times.summary())
        passes.push_back(one(pass));
    return {{"frames", times.frames()}, {"passes", passes}, {"total", one(times.total())}};
}

Json toJson(const CndLightingStats& stats)
{
    const double tiles = std::max(stats.tileCount, 1u);
    Json out{{"lights", stats.lightCount},
             {"tiles", stats.tileCount},
             {"listEntries", stats.listEntries},
             {"entriesPerTile", stats.listEntries / tiles},
             {"maxListLength", stats.maxListLength},
             {"unlistedClusters", stats.unlistedClusters},
             {"missingListBytes", stats.missingListBytes},
             {"cutBelowLux", stats.cutBelow},
             {"listedPairs", stats.listedPairs},
             {"insidePairs", stats.insidePairs},
             {"contributingPairs", stats.contributingPairs},
             {"evaluatedPairs", stats.evaluatedPairs}};
    if (asksForShadows(stats))
        out["shadows"] = {{"askedPairs", stats.askedPairs},
                          {"partlyLitPairs", stats.partlyLitPairs},
                          {"darkPairs", stats.darkPairs},
                          {"slots", stats.shadowSlots},
                          {"missingSlots", stats.missingShadowSlots},
                          {"litEntries", stats.litEntries},
                          {"hiddenEntries", stats.hiddenEntries},
                          {"testedEntries", stats.testedEntries},
                          {"walkedEntries", stats.walkedEntries},
                          {"unfinishedPairs", stats.unfinishedPairs},
                          {"triedProofs", stats.triedProofs},
                          {"wonProofs", stats.wonProofs}};
    return out;
}

Json toJson(const CndExposureStats& stats)
{
    return {{"targetEv100", stats.targetEv100},
            {"adaptedEv100", stats.adaptedEv100},
            {"exposurePerCandelaPerSquareMetre", stats.exposure},
            {"invalidPixels", stats.invalidPixels}};
}

Json toJson(const FrameOptions& options, CndGBufferLayout layout)
{
    const glm::dvec3& p = options.camera.position;
    const glm::dvec3& f = options.camera.forward;
    return {{"camera",
             {{"name", options.camera.name},
              {"positionMetres", {p.x, p.y, p.z}},
              {"forward", {f.x, f.y, f.z}}}},
            {"timeSeconds", options.time},
            {"specular", specularName(options.specular)},
            {"sampleCount", options.sampleCount},
            {"influence", influenceName(options.influence.rule)},
            {"influenceError", options.influence.maxError},
            {"culling", cullingName(options.culling)},
            {"shadows", shadowsName(options.shadows)},
            {"reuse", nameOf(options.reuse, reuseChoices)},
            {"debug", nameOf(options.heatMap, heatMapChoices)},
            {"bloom", options.bloom},
            {"edgeFilter", options.edgeFilter},
            {"gbuffer", nameOf(layout, gbufferChoices)},
            {"toneMap", nameOf(options.exposure.toneMap, toneMapChoices)},
            {"lightsVisible", options.lightsVisible},
            {"levelsOfDetail", options.drawsLevels()},
            {"cullTriangles", options.cullTriangles},
            {"exposure", options.exposure.manual ? "manual" : "auto"},
            {"compensationEv", options.exposure.compensation},
            {"middleGrey", options.exposure.middleGrey}};
}

Json sceneJson(const Scene& scene, const Renderer& renderer)
{
    Json environment; // null: there is none
    if (scene.environment)
        environment = {{"file", scene.environment->file},
                       {"rotationRadians", scene.environment->rotation},
                       {"scale", scene.environment->scale}};
    return {{"name", scene.name},
            {"lights", scene.lights.size()},
            {"instances", scene.instances.size()},
            {"triangles", renderer.triangleCount()},
            {"textures", scene.textures.size()},
            {"lobes", nameOf(scene.lobes, lobeChoices)},
            {"energyCompensation", scene.energyCompensation},
            {"environment", environment},
            {"warnings", scene.warnings}};
}

} // namespace candelabra::app
