// SPDX-License-Identifier: Apache-2.0
// Renderer: one scene at one image size, from G-buffer to display image. Uses the lighting and
// exposure modules through their public C ABI only.
#pragma once

#include <memory>
#include <string>
#include <vector>

#include "candelabra/candelabra.h"
#include "gbuffer/targets.h"
#include "gpu/memory.h"
#include "io/parse.h"
#include "render/heat_map.h"
#include "render/pass_times.h"
#include "render/vulkan_context.h"
#include "scene/scene.h"

namespace candelabra::app
{

struct RendererOptions {
    PixelSize size{1280, 720};
    CndGBufferLayout gbufferLayout = CND_GBUFFER_FULL;
    uint32_t framesInFlight = 2;
    uint32_t specularMethods = 0;  // mask of 1 << CndSpecularMethod that frames may use; 0: all
    bool influenceByError = false; // FrameOptions::influence may be BY_ERROR
    bool stamps = false;           // FrameStats::gpuMs, and when passes began: four more timestamps
};

// What a frame takes over from the one before it where nothing has changed: the image is the same,
// the time is not, so what is timed asks for it by name.
enum class Reuse {
    None,    // everything is done again
    Lists,   // prepared lights, clusters and lists: camera and lights have not changed
    Lighting // the lit image as well: nothing that shapes it has changed
};

struct FrameOptions {
    Camera camera;
    double time = 0;           // s: where moving lights are
    float deltaTime = 0;       // s since the previous frame, for exposure
    bool resetExposure = true; // jump to the converged exposure
    bool lightsVisible = true;
    bool countPairs = false;
    uint32_t ditherSeed = 0;
    CndSpecularMethod specular = CND_SPECULAR_CONIC;
    uint32_t sampleCount = 0; // CND_SPECULAR_SAMPLED; 0: the module's default
    uint32_t sampleSeed = 0;
    float errorBudget = 0; // as CndLightingFrame::errorBudget
    CndCulling culling = CND_CULLING_CLUSTERED;
    // Exposure and tone map are filled in: those of the slot's frame before, which is when lights
    // are first cut, or of manual exposure.
    CndInfluence influence{};
    Reuse reuse = Reuse::None;
    HeatMap heatMap = HeatMap::None; // on the display image; clustered culling only
    CndExposureSettings exposure{};
};

// Of one finished frame.
struct FrameStats {
    std::vector<PassTime> passes;  // in order; empty without timestamps
    std::vector<CndPassPlan> plan; // of all modules, in order
    double gpuStartMs = 0;         // with RendererOptions::stamps: on the device's clock
    double gpuMs = 0;              // likewise: from the frame's first stamp to its last
    uint32_t stamps = 0;           // timestamps taken, those of the modules included
    bool lit = true;               // false: Reuse kept the image, and `lighting` is empty
    CndLightingStats lighting{};
    CndExposureStats exposure{};
};

class Renderer
{
public:
    // `context` and `scene` must outlive it. Throws UsageError, RunError or gpu::Failure.
    Renderer(const VulkanContext& context, const Scene& scene, const RendererOptions& options);
    ~Renderer();
    Renderer(const Renderer&) = delete;
    Renderer& operator=(const Renderer&) = delete;

    // Keeps the history of exposure. The GPU must be done with all frames.
    void resize(PixelSize size);
    PixelSize size() const;

    // The scene's lights are others than they were: frames recorded from now on have them. Throws
    // UsageError for lights that the module refuses.
    void lightsChanged();
    // Lights of a moving scene go to where they are at `time` (s). record() does it too.
    void moveLights(double time);
    // A whole frame; the GPU must be done with the slot's previous one. Leaves radiance and display
    // in TRANSFER_SRC_OPTIMAL, visible to transfers.
    void record(VkCommandBuffer cmd, uint32_t slot, const FrameOptions& options);
    // A frame in pieces, for checks that spread it over many submissions: the G-buffer and the
    // environment; lighting of rectangles that do not overlap, by brute force; the end, which
    // leaves radiance (not display) like record(). Slot 0 only.
    void recordUnlit(VkCommandBuffer cmd, const FrameOptions& options);
    void recordBruteRect(VkCommandBuffer cmd, const FrameOptions& options, const VkRect2D& rect);
    void recordBruteEnd(VkCommandBuffer cmd);
    // Between those: forgets what radiance holds.
    void recordBlack(VkCommandBuffer cmd);
    // Lights of the frames recorded from now on, instead of the scene's, which come back when they
    // move. The GPU must be done with all frames.
    void setLights(const std::vector<CndLight>& lights);

    // What the lighting module is told of such a frame; images change with resize().
    CndLightingFrame lightingFrame(uint32_t slot, const FrameOptions& options) const;

    // Of the last frame recorded in `slot`, which the GPU must have finished.
    FrameStats stats(uint32_t slot) const;
    // Of the last lighting recorded in `slot`.
    CndLightingStats lightingStats(uint32_t slot) const;

    const gpu::Image& radiance() const;      // R32G32B32A32_SFLOAT, cd/m^2
    const gpu::Image& display() const;       // R8G8B8A8_UNORM, sRGB-encoded
    const gbuffer::Targets& targets() const; // SHADER_READ_ONLY_OPTIMAL but for radiance
    const gpu::Image& pairs() const; // GENERAL, CndLightingFrame::pairImage of the last heat map

    uint64_t triangleCount() const; // of all instances

private:
    struct State;
    std::unique_ptr<State> state_;
};

} // namespace candelabra::app
