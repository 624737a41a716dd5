// SPDX-License-Identifier: Apache-2.0
// A hand-made host of the lighting module: fills G-buffers on the CPU, takes lights and returns
// radiance.
#pragma once

#include <cstdint>
#include <functional>
#include <vector>

#include <glm/glm.hpp>

#include "harness/gpu_fixture.h"

namespace candelabra::test
{

// A G-buffer of the FULL layout on the CPU, rows from the top, with its camera.
struct CpuGBuffer {
    uint32_t width = 0, height = 0;
    CndCamera camera{};
    float clearDepth = 0;
    std::vector<glm::uvec2> normalRoughness, albedo, specular;
    std::vector<float> depth; // clearDepth where there is no surface
    // The image that `albedo` is uploaded to. With R16G16B16A16_SFLOAT, which layout COMPACT can
    // read, it holds four half floats per pixel.
    VkFormat albedoFormat = VK_FORMAT_R32G32_UINT;
};

// Sets a perspective projection, reversed by default; infinite if farPlane is 0. View space looks
// along -z, y is up.
void setPerspective(CndCamera& camera, double verticalFov, double aspect, double nearPlane,
                    double farPlane = 0, bool reversed = true);
void setOrthographic(CndCamera& camera, double height, double aspect, double nearPlane,
                     double farPlane, bool reversed = true);

// Returns the depth of a point `distance` metres along -z under the camera's projection.
float depthAt(const CndCamera& camera, double distance);
// Returns the view-space position of a pixel from its depth, in double precision.
glm::dvec3 viewPosition(const CpuGBuffer& g, uint32_t x, uint32_t y);
// Return what is stored of the surface; storedSpecular F0 in rgb and F90 in a.
glm::dvec3 storedNormal(const CpuGBuffer& g, size_t pixel);
double storedRoughness(const CpuGBuffer& g, size_t pixel);
glm::dvec3 storedAlbedo(const CpuGBuffer& g, size_t pixel);
glm::dvec4 storedSpecular(const CpuGBuffer& g, size_t pixel);
// Packs colours as the FULL layout does; F0F90 as in CpuSurface.
glm::uvec2 packAlbedo(const glm::dvec3& albedo);
glm::uvec2 packSpecular(const glm::dvec4& F0F90);

// The next pixel of a G-buffer, in rows from the top. `normal` need not be a unit vector. F0F90: F0
// in rgb, F90 in a.
struct CpuSurface {
    float depth = 0;
    glm::dvec3 normal{0, 0, 1};
    double perceptualRoughness = 1;
    glm::dvec3 albedo{0};
    glm::dvec4 F0F90{0};
};
void addPixel(CpuGBuffer& g, const CpuSurface& surface);

// Returns bumpy walls at several depths with random materials, and holes through which the
// background shows.
CpuGBuffer randomGBuffer(uint32_t width, uint32_t height, const CndCamera& camera, float clearDepth,
                         uint32_t seed);
// The same with a perspective camera, 1 radian high, square pixels, reversed and infinite depth.
CpuGBuffer randomGBuffer(uint32_t width, uint32_t height, uint32_t seed);

// Returns lights near the surfaces of `g` (world space is view space if viewFromWorld is the
// identity).
std::vector<CndLight> randomSpheres(const CpuGBuffer& g, uint32_t count, uint32_t seed);

// Returns random lights of any type, made from randomSpheres(); some uncut, some two-sided.
std::vector<CndLight> lightsOf(CndLightType type, const CpuGBuffer& g, uint32_t count,
                               uint32_t seed);

struct LightingResult {
    std::vector<glm::vec4> radiance;
    CndLightingStats stats{};
};

struct RunOptions {
    CndSpecularMethod specular = CND_SPECULAR_KARIS;
    CndCulling culling = CND_CULLING_CLUSTERED;
    VkDeviceSize listBudget = 0, shadowBudget = 0;
    uint32_t maxWidth = 0; // of the view; 0: the width of the surfaces
    bool countPairs = false;
    const CndDeviceDesc* host = nullptr; // instead of the fixture's device, for interposed
                                         // functions
    CndLighting lighting = nullptr;      // an existing one with two frames in flight
    bool ownLighting = false; // one for this run alone, instead of the one that tests share
    double lightOrigin[3] = {0, 0, 0};
    const CndDeviceLights* deviceLights = nullptr;
    uint32_t sampleCount = 0;
    CndLobeJoining lobes = CND_LOBES_SUM;
    bool energyCompensation = false;
    CndInfluence influence{};
    int frames = 1; // number of recordings; the last one is read back
    uint32_t layers = 0;
    CndGBufferLayout layout = CND_GBUFFER_FULL;
    CndGBufferDesc gbuffer{}; // with CND_GBUFFER_HOST; withFrame sets the images
    CndHostKernels hostKernels{};
    VkDescriptorSet hostSet = VK_NULL_HANDLE;
    bool unchanged = false; // all frames but the first promise unchanged surfaces
    bool diffuseOnlyTiles = false;
    std::function<void()> beforeFrame = [] {};
    std::function<void(CndLightingFrame&)> withFrame = [](CndLightingFrame&) {};
    std::function<void(CndLightingFrame&)> changeFrame = [](CndLightingFrame&) {}; // each of them
};

class LightingTest : public GpuTest
{
protected:
    void TearDown() override;

    // Draws with a view of its own.
    LightingResult run(const CpuGBuffer& g, const std::vector<CndLight>& lights,
                       const RunOptions& options = {});
    // Creates a lighting for RunOptions::lighting, which the caller must destroy.
    CndLighting createFor(const RunOptions& options);
    struct LightingAndView {
        CndLighting lighting = nullptr;
        CndLightingView view = nullptr;
    };
    // Creates a lighting and a view for `g`, which TearDown destroys.
    LightingAndView createLighting(const CpuGBuffer& g, CndLightingDesc desc);
    // Creates them for the specular method of RunOptions.
    LightingAndView createLighting(const CpuGBuffer& g, uint32_t framesInFlight);
    static void setLights(CndLighting lighting, const std::vector<CndLight>& lights);
    static CndLightingStats statsOf(CndLightingView view, uint32_t frameSlot = 0);

    // The images of one G-buffer on the device.
    struct Images {
        gpu::Image normalRoughness, albedo, specular, depth, radiance;
    };
    Images uploadImages(const CpuGBuffer& g);
    // Fills in what the frames of all modules that shade surfaces have in common.
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
    // Tells whether two images agree that different pipelines have made of one frame: with lists,
    // without lists, by brute force, of a layout of the host or ours. A driver may round each
    // pipeline in its own way, and what the engine promises is acrossPipelines. llvmpipe compiles
    // the functions that pipelines share alike, so there the bits are the same, or as near as
    // `onLlvmpipe` if lights are summed in batches (DECISIONS 12).
    static constexpr double acrossPipelines = 1e-5; // relative to the largest radiance
    ::testing::AssertionResult agree(const std::vector<glm::vec4>& a,
                                     const std::vector<glm::vec4>& b, double onLlvmpipe = 0) const;
    static constexpr double batchesOnLlvmpipe = 1e-6; // what other sums of batches may change
    std::vector<glm::vec4> readRadiance(const Images& images) const;
    void clearRadiance(VkCommandBuffer cmd, const Images& images);
    // Clears the radiance, draws a frame and returns the radiance.
    std::vector<glm::vec4> drawFrame(CndLightingView view, const CndLightingFrame& frame,
                                     const Images& images);
    // Expects that the frame is refused with a message that contains `word`.
    void expectRefused(CndLightingView view, const CndLightingFrame& frame, const char* word);
    CndLightingFrame frameOf(const CpuGBuffer& g, const Images& images, const RunOptions& options);

private:
    std::vector<LightingAndView> created_; // by createLighting

    // Without a GPU, making the pipelines of a lighting takes longer than the frame. So the tests
    // of a process share one for each layout of the G-buffer, number of material classes, and use
    // of influence by error. Runs with functions or devices of hosts have lightings of their own.
    CndLighting lightingFor(const RunOptions& options);
    static bool shares(const RunOptions& options)
    {
        return !options.ownLighting && !options.host && !options.hostKernels.count &&
               options.layout != CND_GBUFFER_HOST;
    }
};

bool sameBits(const std::vector<glm::vec4>& a, const std::vector<glm::vec4>& b);
inline bool sameBits(const LightingResult& a, const LightingResult& b)
{
    return sameBits(a.radiance, b.radiance);
}

// Returns the largest |a - b| over all channels, divided by the largest value of b.
double maxRelativeDifference(const std::vector<glm::vec4>& a, const std::vector<glm::vec4>& b);

} // namespace candelabra::test
