// SPDX-License-Identifier: Apache-2.0
// Decides which passes the content of a frame needs, and why each of the others is left out.
#pragma once

#include <array>

#include "candelabra/candelabra.h"
#include "shared/lighting_data.h"

namespace candelabra::lighting
{

enum class Pass : uint8_t {
    DeviceLights,
    LightOrder,
    RefitOccluders,
    DfgTable,
    PrepareLights,
    PrepareOccluders,
    PolygonFacets,
    ProjectDepth,
    MeasureInfluence,
    CutLights,
    TileClusters,
    SplitTiles,
    BlockClusters,
    LightTree,
    ClusterLists,
    ProveDark,
    AskPairs,
    ListOccluders,
    PairVisibility,
    ShadeTiles,
    ShadeUnlisted,
    ShadeBrute,
    CountPairs,
    CountShadows
};
inline constexpr size_t passCount = size_t(Pass::CountShadows) + 1;
static_assert(passCount <= CND_MAX_PASSES);

// FrameContent lists the facts about a frame, known before its recording begins, that decide which
// of its passes have work.
struct FrameContent {
    bool lights = false;   // there is a light
    bool inLayers = false; // some light may be in a layer of the frame
    // Some light may reach the view: one with a position, a distant one.
    bool placedInView = false, distantInView = false;
    bool lightsChanged = false; // some changes are not uploaded yet
    bool deviceLights = false;  // some lights come from the device (CndDeviceLights)
    bool deviceLightsChanged = false;
    bool depthIsProjected = true; // the host's depth image holds depth
    bool brute = false;
    bool listsKept = false; // this frame uses the lists of the previous one
    bool slotsKept = false; // and what its pixels see of lights
    bool readsAlbedoTable = false, albedoTableFilled = false;
    bool cutByError = false; // the frame follows CND_INFLUENCE_BY_ERROR (influenceOf)
    bool countPairs = false;
    bool forward = false;          // shaders of the host walk the light tree
    bool findsShadows = false;     // CndLightingDesc::shadows
    bool occludersChanged = false; // some changes are not uploaded yet
    bool refitsOccluders = false;  // some of their positions come from the device
    bool occludersInLayers = false, shadowsOff = false;
    bool hostFindsPoints = false; // CND_HOST_VISIBLE_POINTS_BIT
    bool polygons = false;        // some lights are polygons
};

class FramePasses
{
public:
    FramePasses() = default;
    explicit FramePasses(const FrameContent& content);

    bool runs(Pass pass) const { return !skipped_[size_t(pass)]; }
    // Adds the passes that had nothing to do because the GPU found their work lists to be empty.
    void addFindings(const gpu::LightingCounters& counters);
    void write(CndPassPlan (&out)[CND_MAX_PASSES], uint32_t& count) const;

private:
    void skipShadows(const FrameContent& content);
    void skip(Pass pass, const char* reason); // a pass keeps the reason that it got first

    std::array<const char*, passCount> skipped_{};
    bool findsShadows_ = false; // otherwise the passes of shadows are none of the module's
    bool listsAlone_ = true;    // there are no distant lights, which light surfaces without lists
};

} // namespace candelabra::lighting
