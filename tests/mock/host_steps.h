// SPDX-License-Identifier: Apache-2.0
// A host on the mock driver that, step by step, creates all modules, sets lights of several kinds,
// edits them, records and asks for statistics; a host that draws with the raster pass; and one with
// shadows.
#pragma once

#include <functional>
#include <string>
#include <vector>

#include "gbuffer/gbuffer.h"
#include "mock/mock_vulkan.h"

namespace candelabra::test
{

// The second number of polygons is more than there is room for after the first one.
constexpr uint32_t firstPolygons = 2, morePolygons = 70;

struct Host {
    MockVulkan vulkan;
    CndDeviceDesc device = vulkan.desc(); // all modules are created from it
    CndLighting lighting = nullptr;
    CndLightingView view = nullptr;
    CndExposure exposure = nullptr;
    CndEnvironment environment = nullptr;
    uint32_t lightCount = 0; // size of the last set that was accepted
    CndLightId added[2] = {}, polygons[firstPolygons + morePolygons] = {};

    // Used by rasterSteps() only. Shared pointers can be destroyed in builds without the raster
    // pass.
    std::shared_ptr<gpu::Device> rasterDevice;
    std::shared_ptr<gbuffer::GBuffer> raster;
    std::shared_ptr<gbuffer::Targets> targets;
    std::shared_ptr<gbuffer::Geometry> geometry;

    // Used by occluderSteps() only.
    CndOccluderMeshId occluderMesh = 0; // that all occluders use
    uint32_t occluderCount = 0;         // as the calls that succeeded leave it

    ~Host() { destroy(); }
    void destroy();
};

// Returns a frame of 64x48 pixels with images of the mock driver.
template <typename Frame>
Frame surfacesOf()
{
    const VkImageView any = MockVulkan::imageView();
    return {.structSize = sizeof(Frame),
            .width = 64,
            .height = 48,
            .camera = MockVulkan::camera(),
            .normalRoughness = any,
            .albedo = any,
            .specular = any,
            .depth = any,
            .radiance = any};
}

struct Step {
    const char* name;
    bool records; // such a step may allocate nothing and may call recording functions only
    std::function<CndResult(Host&, CndError*)> run;
};

const std::vector<Step>& steps();
const std::vector<Step>& rasterSteps();   // mock/raster_steps.cpp
const std::vector<Step>& occluderSteps(); // mock/occluder_steps.cpp

// Runs a step; what it recorded is submitted and finishes at once.
CndResult runStep(const Step& step, Host& h, CndError* error);
// Runs again the step named "record".
CndResult recordAgain(const std::vector<Step>& steps, Host& h, CndError* error);

// Runs all steps. If one of them fails, which sets h.vulkan.failed, it must report `expected`,
// leave lights and occluders as they were, and succeed when it is run again. Returns the name of
// the failed step.
std::string runSteps(const std::vector<Step>& steps, Host& h, CndResult expected,
                     VkResult expectedVulkan);

// Destroys the host's objects and expects that nothing leaked or was misused.
void expectClean(Host& h, const std::string& where);

} // namespace candelabra::test
