// SPDX-License-Identifier: Apache-2.0
#include "mock/host_steps.h"

#include <algorithm>
#include <array>
#include <cstring>

#include <gtest/gtest.h>

namespace candelabra::test
{
namespace
{

// Numbers of lights; each needs larger buffers than the one before, and so does one more light.
constexpr uint32_t firstCount = 3, secondCount = 1600, deviceCount = 4000;

CndResult setLights(Host& h, CndLightType type, uint32_t count, CndError* error)
{
    CndLight light{.type = uint32_t(type), .radius = 0.1f, .influenceRadius = 5};
    light.axisU[0] = 0.5f;
    std::vector<CndLight> lights;
    {
        const HostAllocations::Pause host;
        lights.assign(count, light);
    }
    const CndLightSet set{.structSize = sizeof set, .count = count, .lights = lights.data()};
    const CndResult result = cndSetLights(h.lighting, &set, error);
    if (result == CND_SUCCESS)
        h.lightCount = count;
    const HostAllocations::Pause host;
    lights = {};
    return result;
}

CndResult recordTubes(Host& h, CndError* error)
{
    CndLightingFrame frame = surfacesOf<CndLightingFrame>();
    frame.frameSlot = 1;
    frame.specularMethod = CND_SPECULAR_CONIC;
    return cndRecordLighting(h.view, MockVulkan::commandBuffer(), &frame, error);
}

CndLight polygonLight(uint32_t which)
{
    static constexpr CndPolygon polygons[] = {{3, {{-1, -1}, {1, -1}, {0, 1}}},
                                              {4, {{-1, -1}, {1, -1}, {1, 1}, {-1, 1}}}};
    return {.type = CND_LIGHT_POLYGON,
            .influenceRadius = 5,
            .axisU = {0.5f, 0, 0},
            .axisV = {0, 0.5f, 0},
            .polygon = &polygons[which % 2]};
}

// Adds `count` polygons and appends their ids to those that were added before.
CndResult addPolygons(Host& h, uint32_t count, CndError* error)
{
    std::array<CndLight, morePolygons> lights;
    for (uint32_t i = 0; i < count; ++i)
        lights[i] = polygonLight(i);
    CndLightId* const ids = h.polygons + (count == firstPolygons ? 0 : firstPolygons);
    const CndResult result = cndAddLights(h.lighting, count, lights.data(), ids, error);
    if (result == CND_SUCCESS)
        h.lightCount += count;
    return result;
}

// The lights of the host in this set are spheres.
CndResult setLightsOfDevice(Host& h, CndError* error)
{
    const CndDeviceLights device{.type = CND_LIGHT_POINT,
                                 .maxCount = deviceCount,
                                 .buffer = MockVulkan::hostBuffer(),
                                 .countBuffer = MockVulkan::hostBuffer(),
                                 .countOffset = 16,
                                 .influenceRadius = 2};
    const CndLight light{.type = CND_LIGHT_SPHERE, .radius = 0.1f, .influenceRadius = 5};
    const CndLightSet set{
        .structSize = sizeof set, .count = 1, .lights = &light, .deviceLights = &device};
    const CndResult result = cndSetLights(h.lighting, &set, error);
    if (result == CND_SUCCESS)
        h.lightCount = deviceCount + 1;
    return result;
}

// Creates every module.
std::vector<Step> creationSteps()
{
    return {
        {"create lighting", false,
         [](Host& h, CndError* error) {
             const CndLightingDesc desc{.structSize = sizeof desc,
                                        .framesInFlight = 2,
                                        .gbufferLayout = CND_GBUFFER_HOST,
                                        .timestamps = true,
                                        .gbuffer = {.roughness = CND_CHANNEL_NORMAL_A},
                                        .forwardStages = VK_SHADER_STAGE_FRAGMENT_BIT,
                                        .influenceByError = VK_TRUE};
             return cndCreateLighting(&h.device, &desc, &h.lighting, error);
         }},
        {"create view", false,
         [](Host& h, CndError* error) {
             const CndLightingViewDesc desc{
                 .structSize = sizeof desc, .maxWidth = 64, .maxHeight = 48, .listBudget = 1 << 16};
             return cndCreateLightingView(h.lighting, &desc, &h.view, error);
         }},
        {"create exposure", false,
         [](Host& h, CndError* error) {
             const CndExposureDesc desc{
                 .structSize = sizeof desc, .framesInFlight = 2, .timestamps = true};
             return cndCreateExposure(&h.device, &desc, &h.exposure, error);
         }},
        {"create environment", false,
         [](Host& h, CndError* error) {
             const CndEnvironmentDesc desc{.structSize = sizeof desc,
                                           .framesInFlight = 2,
                                           .gbufferLayout = CND_GBUFFER_HOST,
                                           .timestamps = true,
                                           .gbuffer = {.roughness = CND_CHANNEL_NORMAL_A}};
             return cndCreateEnvironment(&h.device, &desc, &h.environment, error);
         }},
    };
}

// Sets and edits the host's own lights, and records after each edit.
std::vector<Step> editSteps()
{
    return {
        {"set lights", false,
         [](Host& h, CndError* error) {
             return setLights(h, CND_LIGHT_SPHERE, firstCount, error);
         }},
        {"record", true,
         [](Host& h, CndError* error) {
             CndLightingFrame frame = surfacesOf<CndLightingFrame>();
             frame.specularMethod = CND_SPECULAR_CONIC;
             frame.countPairs = VK_TRUE;
             frame.influence = {.rule = CND_INFLUENCE_BY_ERROR, .maxError = 0.1f, .exposure = 1};
             return cndRecordLighting(h.view, MockVulkan::commandBuffer(), &frame, error);
         }},
        {"add pipelines", false,
         [](Host& h, CndError* error) {
             const CndLightingPipelines added{.structSize = sizeof added,
                                              .lightTypes = 1u << CND_LIGHT_POINT,
                                              .specularMethods = 1u << CND_SPECULAR_KARIS};
             return cndAddLightingPipelines(h.lighting, &added, error);
         }},
        {"record with the added pipelines", true,
         [](Host& h, CndError* error) {
             CndLightingFrame frame = surfacesOf<CndLightingFrame>();
             frame.specularMethod = CND_SPECULAR_KARIS;
             frame.countPairs = VK_TRUE;
             return cndRecordLighting(h.view, MockVulkan::commandBuffer(), &frame, error);
         }},
        {"record overlay", true,
         [](Host& h, CndError* error) {
             const CndLightingFrame frame = surfacesOf<CndLightingFrame>();
             const CndSurfaceOverlay overlay{.structSize = sizeof overlay,
                                             .image = MockVulkan::imageView()};
             return cndRecordSurfaceOverlay(h.view, MockVulkan::commandBuffer(), &frame, &overlay,
                                            error);
         }},
        {"set more lights of another type", false,
         [](Host& h, CndError* error) { return setLights(h, CND_LIGHT_TUBE, secondCount, error); }},
        {"record the other lights", true, recordTubes},
        {"update lights", false,
         [](Host& h, CndError* error) {
             const CndLight light{.type = CND_LIGHT_TUBE,
                                  .radius = 0.2f,
                                  .influenceRadius = 6,
                                  .axisU = {0.5f, 0, 0}};
             const CndLightId id = secondCount / 2;
             return cndUpdateLights(h.lighting, 1, &id, &light, error);
         }},
        {"record the updated lights", true, recordTubes},
        {"add lights of another type", false, // the buffers are full
         [](Host& h, CndError* error) {
             const CndLight light{.type = CND_LIGHT_DISC,
                                  .radius = 0.1f,
                                  .direction = {0, 0, 1},
                                  .influenceRadius = 5};
             const CndLight lights[] = {light, light};
             const CndResult result = cndAddLights(h.lighting, 2, lights, h.added, error);
             if (result == CND_SUCCESS)
                 h.lightCount += 2;
             return result;
         }},
        {"record the added lights", true, recordTubes},
        {"remove lights", false,
         [](Host& h, CndError* error) {
             const CndLightId ids[] = {0, h.added[0], secondCount / 2};
             const CndResult result = cndRemoveLights(h.lighting, 3, ids, error);
             if (result == CND_SUCCESS)
                 h.lightCount -= 3;
             return result;
         }},
        {"record what is left", true, recordTubes},
    };
}

// Adds polygons to the host's own lights, changes and removes them.
std::vector<Step> polygonSteps()
{
    return {
        {"add polygons", false,
         [](Host& h, CndError* error) { return addPolygons(h, firstPolygons, error); }},
        {"record the polygons", true, recordTubes},
        {"add more polygons than there is room for", false,
         [](Host& h, CndError* error) { return addPolygons(h, morePolygons, error); }},
        {"record all polygons", true, recordTubes},
        {"make a light a polygon and change another polygon", false,
         [](Host& h, CndError* error) {
             const CndLight lights[] = {polygonLight(2), polygonLight(3)};
             const CndLightId ids[] = {1, h.polygons[0]};
             return cndUpdateLights(h.lighting, 2, ids, lights, error);
         }},
        {"record the changed polygons", true, recordTubes},
        {"remove polygons", false,
         [](Host& h, CndError* error) {
             const CndResult result =
                 cndRemoveLights(h.lighting, firstPolygons + morePolygons, h.polygons, error);
             if (result == CND_SUCCESS)
                 h.lightCount -= firstPolygons + morePolygons;
             return result;
         }},
        {"record without the polygons", true, recordTubes},
    };
}

// Sets lights that the device writes, and edits the host's lights beside them.
std::vector<Step> deviceLightSteps()
{
    return {
        {"set lights of the device", false, setLightsOfDevice},
        {"record lights of the device", true, recordTubes},
        {"set lights of the device again", false, setLightsOfDevice}, // allocates nothing
        {"add lights beside those of the device", false,
         [](Host& h, CndError* error) {
             const CndLight light{.type = CND_LIGHT_SPHERE, .radius = 0.1f, .influenceRadius = 5};
             const CndResult result = cndAddLights(h.lighting, 1, &light, h.added, error);
             if (result == CND_SUCCESS)
                 ++h.lightCount;
             return result;
         }},
        {"record all of them", true, recordTubes},
    };
}

// Records the modules beside lighting.
std::vector<Step> moduleSteps()
{
    return {
        {"record exposure", true,
         [](Host& h, CndError* error) {
             CndExposureFrame frame{.structSize = sizeof frame,
                                    .width = 64,
                                    .height = 48,
                                    .radiance = MockVulkan::imageView(),
                                    .display = MockVulkan::imageView()};
             cndDefaultExposureSettings(&frame.settings);
             return cndRecordExposure(h.exposure, MockVulkan::commandBuffer(), &frame, error);
         }},
        {"record environment map", true,
         [](Host& h, CndError* error) {
             const CndEnvironmentMap map{.structSize = sizeof map,
                                         .width = 32,
                                         .height = 16,
                                         .equirectangular = MockVulkan::imageView()};
             return cndRecordEnvironmentMap(h.environment, MockVulkan::commandBuffer(), &map,
                                            error);
         }},
        {"record environment", true,
         [](Host& h, CndError* error) {
             CndEnvironmentFrame frame = surfacesOf<CndEnvironmentFrame>();
             for (int i = 0; i < 3; ++i)
                 frame.worldFromEnvironment[4 * i] = 1;
             frame.scale = 1;
             return cndRecordEnvironment(h.environment, MockVulkan::commandBuffer(), &frame, error);
         }},
    };
}

// Asks every module for its statistics.
std::vector<Step> statisticsSteps()
{
    return {
        {"lighting statistics", false,
         [](Host& h, CndError*) {
             CndLightingStats stats{.structSize = sizeof stats};
             return cndGetLightingStats(h.view, 1, &stats);
         }},
        {"exposure statistics", false,
         [](Host& h, CndError*) {
             CndExposureStats stats{.structSize = sizeof stats};
             return cndGetExposureStats(h.exposure, 0, &stats);
         }},
        {"environment statistics", false,
         [](Host& h, CndError*) {
             CndEnvironmentStats stats{.structSize = sizeof stats};
             return cndGetEnvironmentStats(h.environment, 0, &stats);
         }},
    };
}

// Expects that there are as many occluders as calls that succeeded have left.
void expectOccluders(Host& h)
{
    if (!h.occluderCount)
        return;
    CndError error{};
    EXPECT_EQ(cndRemoveOccluderMeshes(h.lighting, 1, &h.occluderMesh, &error),
              CND_ERROR_INVALID_ARGUMENT);
    EXPECT_EQ(std::string(error.message),
              "cndRemoveOccluderMeshes: ids[0] is " + std::to_string(h.occluderMesh) +
                  ", a mesh that has " + std::to_string(h.occluderCount) +
                  (h.occluderCount == 1 ? " occluder" : " occluders"));
}

bool reportsSentence(const std::string& step)
{
    return step.find("statistics") == std::string::npos;
}

} // namespace

void Host::destroy()
{
    cndDestroyLightingView(view);
    cndDestroyLighting(lighting);
    cndDestroyExposure(exposure);
    cndDestroyEnvironment(environment);
    view = nullptr;
    lighting = nullptr;
    exposure = nullptr;
    environment = nullptr;
    raster.reset();
    targets.reset();
    geometry.reset();
    rasterDevice.reset();
}

const std::vector<Step>& steps()
{
    static const std::vector<Step> all = [] {
        std::vector<Step> out;
        for (const auto& part : {creationSteps(), editSteps(), polygonSteps(), deviceLightSteps(),
                                 moduleSteps(), statisticsSteps()})
            out.insert(out.end(), part.begin(), part.end());
        return out;
    }();
    return all;
}

// Runs a step; what it recorded is submitted and finishes at once.
CndResult runStep(const Step& step, Host& h, CndError* error)
{
    const CndResult result = step.run(h, error);
    const HostAllocations::Pause host;
    if (step.records && result == CND_SUCCESS)
        h.vulkan.finish(h.vulkan.submit());
    return result;
}

CndResult recordAgain(const std::vector<Step>& steps, Host& h, CndError* error)
{
    const auto record = std::find_if(steps.begin(), steps.end(), [](const Step& step) {
        return std::strcmp(step.name, "record") == 0;
    });
    return runStep(*record, h, error);
}

std::string runSteps(const std::vector<Step>& steps, Host& h, CndResult expected,
                     VkResult expectedVulkan)
{
    std::string failedStep;
    for (const Step& step : steps) {
        CndError error{};
        const uint32_t lightsBefore = h.lightCount;
        CndResult result = runStep(step, h, &error);
        if (h.vulkan.failed.empty() || !failedStep.empty()) {
            EXPECT_EQ(result, CND_SUCCESS) << step.name << ": " << error.message;
            continue;
        }
        failedStep = step.name;
        EXPECT_EQ(result, expected) << step.name << ", " << h.vulkan.failed;
        if (reportsSentence(step.name)) {
            EXPECT_EQ(error.vkResult, expectedVulkan) << step.name << ", " << h.vulkan.failed;
            EXPECT_GT(std::strlen(error.message), 10u) << step.name << ", " << h.vulkan.failed;
        }
        // The previous set of lights must still exist, and be recordable.
        if (h.view && lightsBefore) {
            EXPECT_EQ(recordAgain(steps, h, &error), CND_SUCCESS) << error.message;
            CndLightingStats stats{.structSize = sizeof stats};
            EXPECT_EQ(cndGetLightingStats(h.view, 0, &stats), CND_SUCCESS);
            EXPECT_EQ(stats.lightCount, h.lightCount);
        }
        if (h.geometry) { // the previous emitters are unchanged too: everything that is drawn must
                          // be alive
            EXPECT_EQ(recordAgain(steps, h, &error), CND_SUCCESS) << error.message;
        }
        expectOccluders(h);
        result = runStep(step, h, &error);
        EXPECT_EQ(result, CND_SUCCESS) << "again: " << step.name << ": " << error.message;
    }
    return failedStep;
}

void expectClean(Host& h, const std::string& where)
{
    h.destroy();
    for (const auto& [handle, kind] : h.vulkan.alive)
        ADD_FAILURE() << kind << " " << handle << " leaked, " << where;
    for (const std::string& what : h.vulkan.misuse)
        ADD_FAILURE() << what << ", " << where;
}

} // namespace candelabra::test
