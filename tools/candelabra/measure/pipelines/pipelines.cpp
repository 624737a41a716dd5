// SPDX-License-Identifier: Apache-2.0
#include "measure/pipelines/pipelines.h"

#include <algorithm>

#include <fmt/format.h>

#include "gbuffer/gbuffer.h"
#include "generate/generators.h"
#include "io/table.h"
#include "render/check.h"
#include "render/setting_names.h"
#include "scene/light_types.h"
#include "shared/lighting_data.h"
#include "shared/raster.h"

namespace candelabra::app
{
namespace
{

struct MeasureNames {
    std::optional<uint64_t> PipelineCost::*measure;
    std::vector<const char*> names; // of Mesa's drivers for AMD and Intel, and of NVIDIA's
};

const MeasureNames measureNames[] = {
    {&PipelineCost::vectorRegisters, {"VGPRs", "Register Count", "Max live registers"}},
    {&PipelineCost::scalarRegisters, {"SGPRs"}},
    {&PipelineCost::spilledRegisters, {"Spilled VGPRs", "Spilled SGPRs", "Spill Count"}},
    {&PipelineCost::scratchBytes,
     {"Scratch size", "Scratch Memory Size", "Stack Size", "Local Memory Size"}},
    {&PipelineCost::sharedBytes,
     {"LDS size", "LDS Size", "Shared Memory Size", "Workgroup Memory Size"}},
    {&PipelineCost::instructions, {"Instructions", "Instruction Count"}},
    {&PipelineCost::subgroupsPerSimd, {"Subgroups per SIMD"}}};

// Values of one measure under several names, such as spills of both kinds of registers, add up.
// NVIDIA's driver 580.159 tells 2^36 bytes of local memory more than there are (2^36, 2^36 + 16 and
// 2^36 + 32 in 434 pipelines). No lane has 4 GiB of it, so higher bits are left out.
bool recognise(PipelineCost& cost, const PipelineStatistic& s)
{
    for (const MeasureNames& m : measureNames)
        for (const char* name : m.names)
            if (s.name == name) {
                uint64_t value = uint64_t(s.value);
                if (m.measure == &PipelineCost::scratchBytes)
                    value &= 0xffffffff;
                cost.*m.measure = (cost.*m.measure).value_or(0) + value;
                return true;
            }
    return false;
}

const char* stageName(VkShaderStageFlags stages)
{
    switch (stages) {
    case VK_SHADER_STAGE_COMPUTE_BIT:
        return "compute";
    case VK_SHADER_STAGE_VERTEX_BIT:
        return "vertex";
    case VK_SHADER_STAGE_FRAGMENT_BIT:
        return "fragment";
    default:
        return "several stages";
    }
}

std::string variantOf(const PipelineRequest& request)
{
    const auto& constants = request.constants;
    const auto value = [&](const char* name) {
        const auto found = constants.find(name);
        return found == constants.end() ? 0 : found->second;
    };
    if (constants.contains("pairKind")) {
        constexpr const char* kinds[gpu::SLOT_KINDS] = {"walked", "listed"};
        return fmt::format("{} {}", lightTypeName(value("lightType")), kinds[value("pairKind")]);
    }
    if (constants.contains("lightType")) {
        const uint32_t tileClass = value("tileClass");
        return fmt::format("{} {}{}", lightTypeName(value("lightType")),
                           specularName(CndSpecularMethod(value("specularMethod"))),
                           tileClass == gpu::CLASS_DIFFUSE ? ", diffuse lobe alone" : "");
    }
    if (request.kernel == "tone_map")
        return nameOf(CndToneMap(value("curve")), toneMapChoices);
    if (request.kernel == "emitter")
        return lightTypeName(value("shape"));
    std::string out;
    for (const auto& [name, v] : constants)
        if (name != "gbufferCode" && name != "gbufferLayout" && name != "forCpu" &&
            name != "tileHeight")
            out += fmt::format("{}{} {}", out.empty() ? "" : ", ", name, v);
    return out;
}

bool isWanted(const PipelineSettings& settings, const PipelineRequest& request)
{
    const auto& constants = request.constants;
    const auto allowed = [&](const char* name, uint32_t mask) {
        const auto found = constants.find(name);
        return found == constants.end() || (mask >> found->second & 1);
    };
    const auto& kernels = settings.kernels;
    return (kernels.empty() || std::ranges::count(kernels, request.kernel)) &&
           allowed("lightType", settings.lightTypes) &&
           (settings.diffuseOnlyTiles || allowed("tileClass", 1u << gpu::CLASS_ANY));
}

std::string cell(const std::optional<uint64_t>& value)
{
    return value ? std::to_string(*value) : "-";
}

Json json(const std::optional<uint64_t>& value)
{
    return value ? Json(*value) : Json();
}

} // namespace

PipelineCost costOf(const PipelineExecutable& executable)
{
    PipelineCost out{.kernel = executable.request.kernel,
                     .variant = variantOf(executable.request),
                     .stage = stageName(executable.stages),
                     .subgroupSize = executable.subgroupSize};
    for (const PipelineStatistic& s : executable.statistics)
        if (!recognise(out, s))
            out.others.push_back(s);
    return out;
}

std::vector<PipelineCost> measurePipelines(const PipelineSettings& settings, DeviceInfo& info)
{
    CompileOnlyDevice device(settings.device, [&](const PipelineRequest& request) {
        return isWanted(settings, request);
    });
    info = device.info();
    const Scene showcase = generateShowcase({});
    std::vector<CndLight> lights;
    lightsAtTime(showcase, 0, lights);
    std::erase_if(lights,
                  [&](const CndLight& light) { return !(settings.lightTypes >> light.type & 1); });
    Lighting lighting = valueOrThrow(Lighting::create(
        device.desc(), {.framesInFlight = 1,
                        .specularMethods = settings.methods & gpu::ALL_SPECULAR_METHODS,
                        .diffuseOnlyTiles = VK_TRUE,
                        .influenceByError = VK_TRUE,
                        .shadows = {.points = settings.shadows}}));
    valueOrThrow(lighting.setLights(lights, {0, 0, 0}));
    valueOrThrow(Environment::create(device.desc(), {.framesInFlight = 1}));
    valueOrThrow(Exposure::create(device.desc(), {.framesInFlight = 1}));
    const gpu::Device raster(device.desc(), gpu::rasterPass);
    constexpr uint32_t allTextures = (1u << gpu::TEXTURES_PER_MATERIAL) - 1;
    const gbuffer::MeshVariant meshes[] = {
        {},
        {.colored = true},
        {.textures = allTextures & ~(1u << gpu::TEXTURE_EMISSIVE)},
        {.emissive = true, .textures = allTextures},
        {.coverage = gbuffer::Coverage::Masked, .textures = 1u << gpu::TEXTURE_BASE_COLOR},
        {.coverage = gbuffer::Coverage::Dithered, .textures = 1u << gpu::TEXTURE_BASE_COLOR}};
    gbuffer::GBuffer(raster, {.framesInFlight = 1}).prepare(meshes);

    std::vector<PipelineCost> out;
    for (const PipelineExecutable& executable : device.executables())
        out.push_back(costOf(executable));
    if (out.empty())
        throw UsageError("no pipeline of the engine fits these options");
    return out;
}

std::string pipelineTable(const std::vector<PipelineCost>& costs)
{
    Table table({"kernel", "lanes", "registers", "scalar", "spilled", "scratch bytes",
                 "shared bytes", "instructions", "waves per SIMD"});
    for (const PipelineCost& c : costs) {
        std::string name = c.kernel;
        if (c.stage != "compute")
            name += " " + c.stage;
        if (!c.variant.empty())
            name += ", " + c.variant;
        table.add({name, c.subgroupSize ? std::to_string(c.subgroupSize) : "-",
                   cell(c.vectorRegisters), cell(c.scalarRegisters), cell(c.spilledRegisters),
                   cell(c.scratchBytes), cell(c.sharedBytes), cell(c.instructions),
                   cell(c.subgroupsPerSimd)});
    }
    return table.text();
}

Json pipelineJson(const std::vector<PipelineCost>& costs, bool others)
{
    Json out = Json::array();
    for (const PipelineCost& c : costs) {
        Json row{{"kernel", c.kernel},
                 {"variant", c.variant},
                 {"stage", c.stage},
                 {"subgroupSize", c.subgroupSize},
                 {"vectorRegisters", json(c.vectorRegisters)},
                 {"scalarRegisters", json(c.scalarRegisters)},
                 {"spilledRegisters", json(c.spilledRegisters)},
                 {"scratchBytes", json(c.scratchBytes)},
                 {"sharedBytes", json(c.sharedBytes)},
                 {"instructions", json(c.instructions)},
                 {"subgroupsPerSimd", json(c.subgroupsPerSimd)}};
        if (others)
            for (const PipelineStatistic& s : c.others)
                row["others"][s.name] = s.value;
        out.push_back(row);
    }
    return out;
}

} // namespace candelabra::app
