// SPDX-License-Identifier: Apache-2.0
#include "view/frame_passes.h"

#include <algorithm>
#include <iterator>

#include "clusters/clusters.h"

namespace candelabra::lighting
{
namespace
{

// The name of each Pass, which is that of its kernel.
constexpr std::array<const char*, passCount> names = {
    "device_lights",     "light_order",    "refit_occluders", "dfg_table",         "prepare_lights",
    "prepare_occluders", "polygon_facets", "project_depth",   "measure_influence", "cut_lights",
    "tile_clusters",     "split_tiles",    "block_clusters",  "light_tree",        "cluster_lists",
    "prove_dark",        "ask_pairs",      "list_occluders",  "pair_visibility",   "shade_tiles",
    "shade_unlisted",    "shade_brute",    "count_pairs",     "count_shadows"};

constexpr Pass ofShadows[] = {Pass::RefitOccluders, Pass::PrepareOccluders, Pass::PolygonFacets,
                              Pass::ProveDark,      Pass::AskPairs,         Pass::ListOccluders,
                              Pass::PairVisibility, Pass::CountShadows};

// Why a frame does not find shadows that the previous one has found.
constexpr const char* unmoved = "surfaces, lights and occluders unchanged";

constexpr Pass clustering[] = {Pass::TileClusters, Pass::SplitTiles, Pass::BlockClusters,
                               Pass::LightTree, Pass::ClusterLists};

} // namespace

FramePasses::FramePasses(const FrameContent& c)
    : findsShadows_(c.findsShadows), listsAlone_(!c.distantInView)
{
    // Occluders are uploaded and fitted by the first recording, even if it has no lights.
    if (!c.refitsOccluders)
        skip(Pass::RefitOccluders, "no positions of the device's");
    if (!c.occludersChanged)
        skip(Pass::RefitOccluders, "occluders unchanged");
    if (!c.lights)
        for (size_t pass = 0; pass < passCount; ++pass)
            if (Pass(pass) != Pass::RefitOccluders)
                skip(Pass(pass), "no lights");
    if (!c.deviceLights)
        skip(Pass::DeviceLights, "no lights of the device's");
    if (!c.deviceLightsChanged)
        skip(Pass::DeviceLights, "lights unchanged");
    if (!c.lightsChanged)
        skip(Pass::LightOrder, "lights unchanged");
    // The lights are uploaded and sorted by the first recording, even if none reaches its view.
    if (!c.placedInView && !c.distantInView)
        for (size_t pass = size_t(Pass::RefitOccluders) + 1; pass < passCount; ++pass)
            skip(Pass(pass),
                 c.inLayers ? "no light reaches the view" : "no light of the view's layers");
    if (!c.readsAlbedoTable)
        skip(Pass::DfgTable, "lobes are added as they are");
    if (c.albedoTableFilled)
        skip(Pass::DfgTable, "filled by an earlier frame");
    if (c.depthIsProjected)
        skip(Pass::ProjectDepth, "the G-buffer has depth");
    if (c.brute)
        for (const Pass pass :
             {Pass::TileClusters, Pass::SplitTiles, Pass::BlockClusters, Pass::ClusterLists,
              Pass::ShadeTiles, Pass::ShadeUnlisted, Pass::CountPairs})
            skip(pass, "brute force");
    else
        skip(Pass::ShadeBrute, "lights are culled");
    if (c.brute && !c.forward)
        skip(Pass::LightTree, "brute force");
    if (!c.cutByError)
        for (const Pass pass : {Pass::MeasureInfluence, Pass::CutLights})
            skip(pass, "not asked for");
    if (c.listsKept)
        for (const Pass pass :
             {Pass::PrepareLights, Pass::ProjectDepth, Pass::MeasureInfluence, Pass::CutLights})
            skip(pass, "surfaces and lights unchanged");
    if (!c.placedInView)
        for (const Pass pass :
             {Pass::MeasureInfluence, Pass::CutLights, Pass::SplitTiles, Pass::BlockClusters,
              Pass::LightTree, Pass::ClusterLists, Pass::ShadeUnlisted})
            skip(pass, "distant lights only");
    if (c.listsKept)
        for (const Pass pass : clustering)
            skip(pass, "surfaces and lights unchanged");
    if (!c.countPairs)
        for (const Pass pass : {Pass::CountPairs, Pass::CountShadows})
            skip(pass, "not asked for");
    skipShadows(c);
}

void FramePasses::skipShadows(const FrameContent& c)
{
    for (const Pass pass : ofShadows)
        if (pass == Pass::RefitOccluders)
            continue;
        else if (c.shadowsOff)
            skip(pass, "shadowsOff");
        else if (!c.occludersInLayers &&
                 (pass == Pass::PrepareOccluders || pass == Pass::ProveDark || !c.hostFindsPoints))
            skip(pass, "no occluder of the view's layers");
    if (c.hostFindsPoints)
        skip(Pass::ProveDark, "the host finds the points");
    if (c.brute)
        for (const Pass pass :
             {Pass::ProveDark, Pass::AskPairs, Pass::ListOccluders, Pass::CountShadows})
            skip(pass, "brute force");
    if (!c.placedInView)
        for (const Pass pass : {Pass::ProveDark, Pass::AskPairs, Pass::ListOccluders})
            skip(pass, "distant lights only");
    if (!c.polygons)
        skip(Pass::PolygonFacets, "no polygons");
    if (c.listsKept)
        for (const Pass pass : {Pass::PrepareOccluders, Pass::PolygonFacets, Pass::ProveDark})
            skip(pass, unmoved);
    if (c.slotsKept)
        for (const Pass pass : {Pass::AskPairs, Pass::ListOccluders, Pass::PairVisibility})
            skip(pass, unmoved);
}

void FramePasses::skip(Pass pass, const char* reason)
{
    const char*& skipped = skipped_[size_t(pass)];
    if (!skipped)
        skipped = reason;
}

void FramePasses::addFindings(const gpu::LightingCounters& counters)
{
    if (!runs(Pass::ShadeTiles)) // brute force, or no light
        return;
    if (!surfaceTileCount(counters))
        for (const Pass pass :
             {Pass::SplitTiles, Pass::ProveDark, Pass::AskPairs, Pass::ListOccluders,
              Pass::PairVisibility, Pass::ShadeTiles, Pass::CountPairs, Pass::CountShadows})
            skip(pass, "no surface");
    if (listsAlone_ && !counters.listEntries)
        for (const Pass pass : {Pass::ListOccluders, Pass::PairVisibility, Pass::ShadeTiles})
            skip(pass, "every list is empty");
    if (!counters.splitTiles)
        skip(Pass::SplitTiles, "no deep tile");
    if (!counters.unlistedClusters)
        skip(Pass::ShadeUnlisted, "every cluster has its list");
}

void FramePasses::write(CndPassPlan (&out)[CND_MAX_PASSES], uint32_t& count) const
{
    count = 0;
    for (size_t pass = 0; pass < passCount; ++pass)
        if (findsShadows_ || std::ranges::find(ofShadows, Pass(pass)) == std::end(ofShadows))
            out[count++] = {names[pass], skipped_[pass]};
}

} // namespace candelabra::lighting
