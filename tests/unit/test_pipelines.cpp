// SPDX-License-Identifier: Apache-2.0
// Tests how the statistics of different drivers become the same measures (measure/pipelines).
#include <gtest/gtest.h>

#include "measure/pipelines/pipelines.h"
#include "shared/lighting_data.h"

using namespace candelabra;
using app::PipelineCost;
using app::PipelineExecutable;

namespace
{

PipelineExecutable executable(const std::string& kernel,
                              std::vector<app::PipelineStatistic> statistics,
                              std::map<std::string, uint32_t> constants = {})
{
    return {.request = {.kernel = kernel, .constants = std::move(constants)},
            .stages = VK_SHADER_STAGE_COMPUTE_BIT,
            .subgroupSize = 32,
            .statistics = std::move(statistics)};
}

} // namespace

TEST(Pipelines, MeasuresOfAmdDriversAreFound)
{
    const PipelineCost cost = app::costOf(executable("cluster_lists", {{"VGPRs", 64},
                                                                       {"SGPRs", 128},
                                                                       {"Spilled VGPRs", 3},
                                                                       {"Spilled SGPRs", 4},
                                                                       {"Scratch size", 512},
                                                                       {"LDS size", 1024},
                                                                       {"Instructions", 1014},
                                                                       {"Subgroups per SIMD", 16},
                                                                       {"Latency", 7}}));
    EXPECT_EQ(cost.kernel, "cluster_lists");
    EXPECT_EQ(cost.variant, "");
    EXPECT_EQ(cost.stage, "compute");
    EXPECT_EQ(cost.subgroupSize, 32u);
    EXPECT_EQ(cost.vectorRegisters, 64u);
    EXPECT_EQ(cost.scalarRegisters, 128u);
    EXPECT_EQ(cost.spilledRegisters, 7u);
    EXPECT_EQ(cost.scratchBytes, 512u);
    EXPECT_EQ(cost.sharedBytes, 1024u);
    EXPECT_EQ(cost.instructions, 1014u);
    EXPECT_EQ(cost.subgroupsPerSimd, 16u);
    ASSERT_EQ(cost.others.size(), 1u);
    EXPECT_EQ(cost.others[0].name, "Latency");
}

TEST(Pipelines, WhatADriverDoesNotTellIsEmpty)
{
    const PipelineCost cost =
        app::costOf(executable("light_tree", {{"Register Count", 40}, {"Stack Size", 0}}));
    EXPECT_EQ(cost.vectorRegisters, 40u);
    EXPECT_EQ(cost.scratchBytes, 0u);
    EXPECT_FALSE(cost.instructions);
    EXPECT_FALSE(cost.spilledRegisters);
    const app::Json json = app::pipelineJson({cost}, false);
    EXPECT_TRUE(json[0]["instructions"].is_null());
    EXPECT_EQ(json[0]["vectorRegisters"], 40);
    EXPECT_NE(app::pipelineTable({cost}).find("light_tree"), std::string::npos);
}

TEST(Pipelines, VariantsAreNamedByWhatTheyShade)
{
    const auto variant = [](const std::string& kernel, std::map<std::string, uint32_t> constants) {
        return app::costOf(executable(kernel, {}, std::move(constants))).variant;
    };
    const std::map<std::string, uint32_t> shading{{"lightType", CND_LIGHT_SPHERE},
                                                  {"specularMethod", CND_SPECULAR_CONIC},
                                                  {"tileClass", gpu::CLASS_ANY},
                                                  {"forCpu", 1}};
    EXPECT_EQ(variant("shade_tiles", shading), "sphere conic");
    auto changed = shading;
    changed["tileClass"] = gpu::CLASS_DIFFUSE;
    EXPECT_EQ(variant("shade_tiles", changed), "sphere conic, diffuse lobe alone");
    EXPECT_EQ(variant("tone_map", {{"curve", CND_TONEMAP_ACES}}), "aces");
    EXPECT_EQ(variant("mesh", {{"detailed", 1}, {"gbufferLayout", 0}}), "detailed 1");
}
