// SPDX-License-Identifier: Apache-2.0
// A hand-made host of the lighting module: G-buffers filled on the CPU, lights in, radiance out.
#pragma once

#include <cstdint>
#include <functional>
#include <random>
#include <utility>
#include <vector>

#include <glm/glm.hpp>

#include "harness/gpu_fixture.h"

namespace candelabra::test
{

// A FULL layout G-buffer on the CPU, rows from the top, and the camera it belongs to.
struct CpuGBuffer {
    uint32_t width = 0, height = 0;
    CndCamera camera{};
    float clearDepth = 0;
    std::vector<glm::uvec2> normalRoughness;
    std::vector<glm::uvec2> albedo, specular; // 4 x half
    std::vector<float> depth;                 // clearDepth: no surface
};

// Perspective with reversed depth; infinite when farPlane is 0. View looks down -z, y up.
void setPerspective(CndCamera& camera, double verticalFov, double aspect, double nearPlane,
                    double farPlane = 0, bool reversed = true);
void setOrthographic(CndCamera& camera, double height, double aspect, double nearPlane,
                     double farPlane, bool reversed = true);

// Depth of a point `distance` metres along -z under the camera's projection.
float depthAt(const CndCamera& camera, double distance);
// The view-space position that a pixel and its depth stand for, in double.
glm::dvec3 viewPosition(const CpuGBuffer& g, uint32_t x, uint32_t y);
// The surface normal and roughness as stored.
glm::dvec3 storedNormal(const CpuGBuffer& g, size_t pixel);
double storedRoughness(const CpuGBuffer& g, size_t pixel);
glm::vec4 storedHalf4(glm::uvec2 packed);

// One more pixel of a G-buffer, in rows from the top. `normal` need not be unit; F0F90: rgb F0, a
// F90.
struct CpuSurface {
    float depth = 0;
    glm::dvec3 normal{0, 0, 1};
    double perceptualRoughness = 1;
    glm::vec3 albedo{0};
    glm::vec4 F0F90{0};
};
void addPixel(CpuGBuffer& g, const CpuSurface& surface);

// Bumpy walls at several depths with random materials, holes to the background among them.
CpuGBuffer randomGBuffer(uint32_t width, uint32_t height, const CndCamera& camera, float clearDepth,
                         uint32_t seed);
// The same in perspective, 1 radian high, of square pixels, with reversed and infinite depth.
CpuGBuffer randomGBuffer(uint32_t width, uint32_t height, uint32_t seed);

// Lights near the surfaces of `g` (world = view when viewFromWorld is the identity).
std::vector<CndLight> randomSpheres(const CpuGBuffer& g, uint32_t count, uint32_t seed);

// Random spheres turned into another type, some uncut, some two-sided.
std::vector<CndLight> lightsOf(CndLightType type, const CpuGBuffer& g, uint32_t count,
                               uint32_t seed);

struct LightingResult {
    std::vector<glm::vec4> radiance;
    CndLightingStats stats{};
};

struct RunOptions {
    CndSpecularMethod specular = CND_SPECULAR_KARIS;
    CndCulling culling = CND_CULLING_CLUSTERED;
    VkDeviceSize listBudget = 0;
    bool countPairs = false;
    const CndDeviceDesc* host = nullptr; // instead of the fixture's, for interposed functions
    CndLighting lighting = nullptr; // of two frames in flight, instead of one for this run alone
    double lightOrigin[3] = {0, 0, 0};
    const CndDeviceLights* deviceLights = nullptr;
    uint32_t sampleCount = 0;
    float errorBudget = 0;
    CndLobeJoining lobes = CND_LOBES_SUM;
    bool energyCompensation = false;
    CndInfluence influence{};
    int frames = 1; // record this many times; the last one is read back
    uint32_t layers = 0;
    CndGBufferLayout layout = CND_GBUFFER_FULL;
    CndGBufferDesc gbuffer{}; // of CND_GBUFFER_HOST, whose images withFrame puts in
    CndHostKernels hostKernels{};
    VkDescriptorSet hostSet = VK_NULL_HANDLE;
    bool unchanged = false; // frames after the first promise unchanged surfaces
    uint32_t materialClasses = 0;
    std::function<void()> beforeFrame = [] {};
    std::function<void(CndLightingFrame&)> withFrame = [](CndLightingFrame&) {};
};

class LightingTest : public GpuTest
{
protected:
    LightingResult run(const CpuGBuffer& g, const std::vector<CndLight>& lights,
                       const RunOptions& options = {});

    // A lighting and a view for `g`; to be destroyed by the caller.
    std::pair<CndLighting, CndLightingView> createLighting(const CpuGBuffer& g,
                                                           CndLightingDesc desc);
    // With the method of RunOptions.
    std::pair<CndLighting, CndLightingView> createLighting(const CpuGBuffer& g,
                                                           uint32_t framesInFlight);
    static void setLights(CndLighting lighting, const std::vector<CndLight>& lights);

    // The images of one G-buffer on the device.
    struct Images {
        gpu::Image normalRoughness, albedo, specular, depth, radiance;
    };
    Images uploadImages(const CpuGBuffer& g);
    // What the frames of all modules that shade surfaces have in common.
    template <typename Frame>
    static Frame surfaceFrame(const CpuGBuffer& g, const Images& images)
    {
        return {.structSize = sizeof(Frame),
                .width = g.width,
                .height = g.height,
                .camera = g.camera,
                .clearDepth = g.clearDepth,
                .normalRoughness = images.normalRoughness.view.get(),
                .albedo = images.albedo.view.get(),
                .specular = images.specular.view.get(),
                .depth = images.depth.view.get(),
                .radiance = images.radiance.view.get()};
    }
    std::vector<glm::vec4> readRadiance(const Images& images) const;
    void clearRadiance(VkCommandBuffer cmd, const Images& images);
    CndLightingFrame frameOf(const CpuGBuffer& g, const Images& images, const RunOptions& options);
};

bool sameBits(const std::vector<glm::vec4>& a, const std::vector<glm::vec4>& b);
inline bool sameBits(const LightingResult& a, const LightingResult& b)
{
    return sameBits(a.radiance, b.radiance);
}

// Largest |a - b| over all channels, divided by the largest value of b.
double maxRelativeDifference(const std::vector<glm::vec4>& a, const std::vector<glm::vec4>& b);

} // namespace candelabra::test
