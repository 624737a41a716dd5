// SPDX-License-Identifier: Apache-2.0
// A host on the mock driver that creates all modules, sets lights of several kinds, edits them,
// records and asks for statistics, step by step; and one that draws with the raster pass.
#pragma once

#include <functional>
#include <string>
#include <vector>

#include "gbuffer/gbuffer.h"
#include "mock/mock_vulkan.h"

namespace candelabra::test
{

struct Host {
    MockVulkan vulkan;
    CndDeviceDesc device = vulkan.desc(); // what all modules are created from
    CndLighting lighting = nullptr;
    CndLightingView view = nullptr;
    CndExposure exposure = nullptr;
    CndEnvironment environment = nullptr;
    uint32_t lightCount = 0; // of the set that succeeded last
    CndLightId added[2] = {};

    // Of rasterSteps().
    std::unique_ptr<gpu::Device> rasterDevice;
    std::unique_ptr<gbuffer::GBuffer> raster;
    std::unique_ptr<gbuffer::Targets> targets;
    std::unique_ptr<gbuffer::Geometry> geometry;

    ~Host() { destroy(); }
    void destroy();
};

struct Step {
    const char* name;
    bool records; // may allocate nothing, and call only what records
    std::function<CndResult(Host&, CndError*)> run;
};

const std::vector<Step>& steps();
const std::vector<Step>& rasterSteps(); // mock/raster_steps.cpp

// A step, and on a device that is infinitely fast what it recorded.
CndResult runStep(const Step& step, Host& h, CndError* error);
// The step of steps(), or of rasterSteps(), that is called "record" once more.
CndResult recordAgain(const std::vector<Step>& steps, Host& h, CndError* error);

// Runs all steps. One of them fails when h.vulkan.failed gets a name: it must report `expected`,
// leave the lights as they were, and succeed when it is tried again. Returns that step's name.
std::string runSteps(const std::vector<Step>& steps, Host& h, CndResult expected,
                     VkResult expectedVulkan);

// Destroys the host's objects: nothing may be left of them, nor have been misused.
void expectClean(Host& h, const std::string& where);

} // namespace candelabra::test
