// SPDX-License-Identifier: Apache-2.0
// The plan of a frame: which passes its content asks for, and why it does without the others.
#pragma once

#include <array>

#include "candelabra/candelabra.h"
#include "shared/lighting.h"

namespace candelabra::lighting
{

enum class Pass : uint8_t {
    DeviceLights,
    LightOrder,
    DfgTable,
    PrepareLights,
    MeasureInfluence,
    CutLights,
    TileClusters,
    SplitTiles,
    BlockClusters,
    LightTree,
    ClusterLists,
    ShadeTiles,
    ShadeUnlisted,
    ShadeBrute,
    CountPairs
};
inline constexpr size_t passCount = size_t(Pass::CountPairs) + 1;
static_assert(passCount <= CND_MAX_PASSES);

// What the host knows of a frame before it is recorded.
struct FrameContent {
    bool lights = false;   // there are any
    bool inLayers = false; // some may have a layer of the view's
    // Some reach the view: of the types that have a place, of the distant ones.
    bool placedInView = false, distantInView = false;
    bool lightsChanged = false; // since the frame before
    bool deviceLights = false;  // some come from the device
    bool deviceLightsChanged = false;
    bool brute = false;
    bool listsKept = false; // those of the frame before are this frame's
    bool readsAlbedoTable = false, albedoTableFilled = false;
    bool cutByError = false; // CND_INFLUENCE_BY_ERROR, and it can be measured
    bool countPairs = false;
    bool forward = false; // shaders of the host's walk the light tree
};

class FramePasses
{
public:
    FramePasses() = default;
    explicit FramePasses(const FrameContent& content);

    bool runs(Pass pass) const { return !skipped_[size_t(pass)]; }
    // What the GPU found to be empty: its indirect dispatches had no groups.
    void addFindings(const gpu::LightingCounters& counters);
    void write(CndPassPlan (&out)[CND_MAX_PASSES], uint32_t& count) const;

private:
    void skip(Pass pass, const char* reason); // the first reason stays

    std::array<const char*, passCount> skipped_{};
    bool listsAlone_ = true; // no distant lights, which every surface has
};

} // namespace candelabra::lighting
