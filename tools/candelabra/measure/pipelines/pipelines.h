// SPDX-License-Identifier: Apache-2.0
// Prints what a driver's compiler reports about every pipeline that the engine makes: registers,
// spills, memory, instructions. Nothing is run.
#pragma once

#include <optional>

#include "io/report.h"
#include "measure/pipelines/compile_only_device.h"

namespace candelabra::app
{

struct PipelineSettings {
    std::string device;               // as ContextOptions::device
    std::vector<std::string> kernels; // those to compile; all if it is empty
    uint32_t lightTypes = ~0u;        // mask of 1 << CndLightType
    uint32_t methods = ~0u;           // mask of 1 << CndSpecularMethod
    bool diffuseOnlyTiles = true;     // also the kernels for tiles without a specular lobe
    uint32_t shadows = 0;             // CndShadowDesc::points
};

// The measures that drivers tell under different names, by one name each. A measure that the driver
// does not tell is empty.
struct PipelineCost {
    std::string kernel;  // "shade_tiles"
    std::string variant; // "sphere none, diffuse lobe alone", or the values of its constants
    std::string stage;   // "compute", "vertex" or "fragment"
    uint32_t subgroupSize = 0;
    std::optional<uint64_t> vectorRegisters;
    std::optional<uint64_t> scalarRegisters;
    std::optional<uint64_t> spilledRegisters;
    std::optional<uint64_t> scratchBytes;
    std::optional<uint64_t> sharedBytes; // of a work group
    std::optional<uint64_t> instructions;
    std::optional<uint64_t> subgroupsPerSimd; // how many can be resident at the same time
    std::vector<PipelineStatistic> others;    // everything else that the driver tells
};

PipelineCost costOf(const PipelineExecutable& executable);

// Creates every module, with lights of the given types, and returns the costs in the order in which
// the pipelines are created. `info` becomes the device that compiled them. Throws UsageError if no
// pipeline fits the settings.
std::vector<PipelineCost> measurePipelines(const PipelineSettings& settings, DeviceInfo& info);

std::string pipelineTable(const std::vector<PipelineCost>& costs);
// With `others`, the measures of PipelineCost::others are included.
Json pipelineJson(const std::vector<PipelineCost>& costs, bool others);

} // namespace candelabra::app
