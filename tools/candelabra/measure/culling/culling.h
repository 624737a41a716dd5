// SPDX-License-Identifier: Apache-2.0
// Measures what finding the lights of every pixel costs: with the engine, with other ways to cull,
// with brute force, and with no culling at all ("floor"), in interleaved rounds of the same frame.
#pragma once

#include <optional>
#include <string>
#include <vector>

#include "io/parse.h"
#include "io/report.h"
#include "io/statistics.h"
#include "io/table.h"
#include "render/pass_times.h"
#include "render/vulkan_context.h"

namespace candelabra::app
{

struct CullingSettings {
    std::vector<std::string> scenes{"hall", "field", "fence"};
    std::vector<PixelSize> sizes{{1280, 720}};
    std::vector<uint32_t> lights{1000, 4000, 16000, 64000};
    std::vector<uint32_t> overlaps{8, 30};
    uint32_t rounds = minPairs; // the least that give an interval
    uint32_t seed = 1;
    uint32_t shadows = 0; // 32 or 64: the engine also lights the frame with shadows
    // ms; brute force that takes longer is drawn once, and not in every round.
    double brutePatience = 1000;
    double bruteLimit = 60; // s; brute force is skipped if a frame is estimated to take longer
};

// What the lists of lights of a frame hold.
struct CullingStats {
    uint64_t listEntries = 0, listBytes = 0;
    uint64_t listedPairs = 0, evaluatedPairs = 0, insidePairs = 0, contributingPairs = 0;
};

// One way to light the frame, and what it measured.
struct Contender {
    std::string name;
    CullingStats stats;
    PassTimes times;
    std::optional<double> skippedMs; // if it was not drawn: how long it was estimated to take
    // The largest difference of any channel to the engine's image, relative to that image's largest
    // value. The floor has no image, and the frame with shadows has another one.
    std::optional<double> difference;

    // The bound of `difference`; brute force has the bound of BruteCheck instead. The lists of
    // other contenders hold the lights in another order, and sums in float then differ by up
    // to 1.1e-6 with 8 overlaps and 3e-6 with 30 (a million lights in the hall). Lists that lost
    // lights gave 1e-1.
    static constexpr double reorderedBound = 4e-6;
    bool hasRightImage() const;

    double totalMs() const;
    double shadingMs() const; // the part of totalMs() that shading kernels take
    double cullingMs() const { return totalMs() - shadingMs(); }
    double contributingPerListed() const;
    double contributingPerEvaluated() const;
};

struct CullingPoint {
    std::string scene;
    PixelSize size;
    uint32_t lights = 0, overlaps = 0;
    uint32_t tiles = 0, splitTiles = 0, unlistedClusters = 0; // statistics of the engine
    std::vector<Contender> contenders;

    const Contender& of(const std::string& name) const;
    // The fastest of the other ways to cull that were drawn. One with the right image is preferred.
    const Contender& bestBaseline() const;
    // The time of `name` divided by that of the engine in the same round. A contender that was
    // drawn once is compared with the engine in every round.
    PairedRatio toEngine(const std::string& name) const;
    // Names the configuration: "hall, 640x360, 8 overlaps, 4,000 lights".
    std::string title() const;
};
// The names of the contenders.
inline constexpr const char* engineName = "candelabra";
inline constexpr const char* tilesName = "16x16 tiles";
inline constexpr const char* froxelsName = "froxels";
inline constexpr const char* floorName = "floor";
inline constexpr const char* bruteName = "brute force";
inline constexpr const char* shadowedName = "candelabra with shadows";

// Measures all configurations. One whose overlaps cannot be reached is left out with a warning.
std::vector<CullingPoint> measureCulling(const VulkanContext& context,
                                         const CullingSettings& settings, bool showProgress);

std::vector<Table> cullingTables(const std::vector<CullingPoint>& points);
Json cullingJson(const CullingSettings& settings, const std::vector<CullingPoint>& points);
struct CullingPlot {
    std::string name; // of a file, without extension
    std::string svg;
};
// Plots time against the number of lights; one plot per scene, size and overlaps.
std::vector<CullingPlot> cullingPlots(const std::vector<CullingPoint>& points,
                                      const DeviceInfo& device);
// Returns a sentence about each image that differs by more than the bound.
std::vector<std::string> cullingFailures(const std::vector<CullingPoint>& points);

} // namespace candelabra::app
