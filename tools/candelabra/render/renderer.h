// SPDX-License-Identifier: Apache-2.0
// Renderer draws one scene at one image size, from the G-buffer to the display image. It uses the
// lighting, environment and exposure modules through the engine's public face only.
#pragma once

#include <memory>
#include <optional>
#include <vector>

#include "candelabra/candelabra.h"
#include "gbuffer/geometry.h"
#include "gbuffer/targets.h"
#include "gpu/memory.h"
#include "io/parse.h"
#include "render/accumulation.h"
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
    // Masks of 1 << CndSpecularMethod and of CndShadingBits, for which the constructor makes
    // pipelines. Frames may ask for others: what is missing is made by prepareToDraw(), or else by
    // the first frame that needs it, which then takes longer to record.
    uint32_t specularMethods = 1u << CND_SPECULAR_CONIC;
    uint32_t shading = CND_SHADING_CLUSTERED_BIT;
    // How many points of each light shadows are found for: 0 (no shadows), 32 or 64.
    uint32_t shadows = 0;
    // Bytes for lists and shadows at first, as in CndLightingViewDesc; 0: by the size. Frames that
    // lack room get more (fits).
    VkDeviceSize listBudget = 0, shadowBudget = 0;
    bool influenceByError = false; // FrameOptions::influence may be CND_INFLUENCE_BY_ERROR
    // Measures FrameStats::gpuMs, and when passes begin, with four more timestamps per frame.
    bool stamps = false;
    // Drawn in place of Scene::materials, if it is not null. Only the constructor uses it.
    const std::vector<Material>* materials = nullptr;
    // If this is set, the constructor reads nothing of the scene that an edit of its lights
    // changes: it makes pipelines for light types of this mask (1 << CndLightType), and there are
    // no lights until lightsChanged() is called.
    std::optional<uint32_t> lightTypes;
};

// The parts of the previous frame that a frame reuses if nothing has changed. The image is the
// same, but the GPU time is not, so callers that measure times choose explicitly.
enum class Reuse {
    None,    // nothing: every frame does all the work
    Lists,   // the prepared lights, clusters and lists, if camera and lights have not changed
    Lighting // the lit image as well, if nothing that decides it has changed
};

// Compare bits, so that settings which are not numbers equal themselves.
bool operator==(const CndInfluence& a, const CndInfluence& b);
bool operator==(const CndExposureSettings& a, const CndExposureSettings& b);

struct FrameOptions {
    Camera camera;
    // The samples of a frame are recorded one after the other. Each is lit separately, so with
    // several, Reuse::Lighting reuses nothing. The display image keeps its earlier content until
    // the last sample. After that, it and the radiance are the means of all samples.
    FrameSample sample;
    double time = 0;           // s; decides where moving lights are
    float deltaTime = 0;       // s since the previous frame, for the adaptation of exposure
    bool resetExposure = true; // jump to the converged exposure
    bool lightsVisible = true;
    bool levels = true;        // draw distant meshes by coarser levels of detail
    bool cullTriangles = true; // and visible lights: gbuffer::FrameInputs::cullTriangles
    bool countPairs = false;
    uint32_t ditherSeed = 0;
    CndSpecularMethod specular = CND_SPECULAR_CONIC;
    uint32_t sampleCount = 0; // of CND_SPECULAR_SAMPLED; 0: the module's default
    uint32_t sampleSeed = 0;
    CndCulling culling = CND_CULLING_CLUSTERED;
    uint32_t shadows = 0; // 0, or RendererOptions::shadows
    // The renderer fills in the exposure and the tone map. The exposure is the manual one, or that
    // of the previous frame in the same slot; in a slot's first frame no light is cut.
    CndInfluence influence{};
    Reuse reuse = Reuse::None;
    // The share of the light of every pixel that is spread over the display image, as an eye
    // scatters it: 0..1; 0: none. Neither the radiance nor the metering of exposure knows of it.
    // Heat maps have none.
    float bloom = 0;
    HeatMap heatMap = HeatMap::None; // painted over the display image; needs clustered culling
    // Smooths the edges of the display image. Has no effect on frames of several samples, whose
    // edges are smooth, and on heat maps, which show single pixels.
    bool edgeFilter = false;
    CndExposureSettings exposure{}; // Scene::exposureCompensation is added

    // Coarser levels lie in part below the full meshes, which cast the shadows, and would be dark.
    bool drawsLevels() const { return levels && !shadows; }
    bool operator==(const FrameOptions&) const = default;
};

// Returns what frames with these options ask of pipelines, as a mask of CndShadingBits.
uint32_t shadingOf(const FrameOptions& options);
// Returns the types of the lights of a scene, as a mask of 1 << CndLightType.
uint32_t lightTypesOf(const Scene& scene);

// Statistics of one finished frame.
struct FrameStats {
    std::vector<PassTime> passes;  // in order; empty if the device has no timestamps
    std::vector<CndPassPlan> plan; // passes of all modules, in order
    double gpuMs = 0; // with RendererOptions::stamps: from the frame's first timestamp to its last
    uint32_t stamps = 0; // timestamps taken, including those of the modules
    bool lit = true;     // false: the image was reused (Reuse::Lighting), and `lighting` is empty
    CndLightingStats lighting{};
    CndExposureStats exposure{};
};

// Replaces automatic exposure by Scene::knownEv100, if the scene has one.
void useKnownExposure(const Scene& scene, CndExposureSettings& settings);

class Renderer
{
public:
    // `context` and `scene` must outlive the renderer. Throws UsageError, RunError or gpu::Failure.
    Renderer(const VulkanContext& context, const Scene& scene, const RendererOptions& options);
    ~Renderer();
    Renderer(const Renderer&) = delete;
    Renderer& operator=(const Renderer&) = delete;

    // Tells whether there are pipelines for frames with these options.
    bool canDraw(const FrameOptions& options) const;
    // Tells whether there are pipelines for lights of these types (a mask of 1 << CndLightType).
    bool canLightBy(uint32_t lightTypes) const;
    // These two make the pipelines that are missing. They may be called on another thread while
    // this one calls the functions below, such as record(), resize() and lightsChanged(), for the
    // reasons that cndAddLightingPipelines gives. Throw RunError.
    void prepareToDraw(const FrameOptions& options);
    void prepareToLightBy(uint32_t lightTypes);

    // Tells whether the last frame in `slot`, which the GPU must have finished, had room for its
    // lists of lights and for their shadows, or cannot have more. Otherwise the next frame has
    // more. record() does the same for its slot. Pictures do not depend on it.
    bool fits(uint32_t slot);

    // Changes the image size and keeps the history of exposure. The GPU must have finished all
    // frames.
    void resize(PixelSize size);
    PixelSize size() const;

    // Call it after the scene has been moved to another object, which now takes its place.
    void sceneMoved(const Scene& scene);
    // Call it after the lights of the scene have changed: frames recorded from now on show the new
    // ones. Makes pipelines if canLightBy() is not true of the lights. Throws RunError for lights
    // that the lighting module refuses.
    void lightsChanged();
    // Moves the lights of a moving scene to where they are at `time` (s). record() does so too.
    void moveLights(double time);
    // Records a whole frame. The GPU must have finished the slot's previous frame. Radiance and
    // display image end in TRANSFER_SRC_OPTIMAL, visible to transfers.
    void record(VkCommandBuffer cmd, uint32_t slot, const FrameOptions& options);
    // These record a frame in pieces, which may be spread over many submissions. recordUnlit comes
    // first, and records the G-buffer and the environment. One of two ways lights it then.
    //
    // recordBand lights rows, from the top to the bottom. With the last row it ends the frame as
    // record() does. The options have no heat map and no influence by error. Of the statistics of
    // the slot, only the exposure describes the whole frame.
    //
    // For checks, in slot 0, recordBruteRect lights a rectangle that overlaps no other by brute
    // force. recordBruteEnd then leaves the radiance, but not the display image, as record() does.
    void recordUnlit(VkCommandBuffer cmd, const FrameOptions& options, uint32_t slot = 0);
    void recordBand(VkCommandBuffer cmd, uint32_t slot, const FrameOptions& options,
                    uint32_t firstRow, uint32_t endRow);
    void recordBruteRect(VkCommandBuffer cmd, const FrameOptions& options, const VkRect2D& rect);
    void recordBruteEnd(VkCommandBuffer cmd);
    // Between those calls: sets the radiance to 0.
    void recordBlack(VkCommandBuffer cmd);
    // Replaces the scene's lights in the frames recorded from now on. The scene's lights come back
    // when they move, or with lightsChanged(). The GPU must have finished all frames.
    void setLights(const std::vector<CndLight>& lights);

    // Returns what the lighting module is told about a frame. The images in it change with
    // resize().
    CndLightingFrame lightingFrame(uint32_t slot, const FrameOptions& options) const;

    // Statistics of the last frame recorded in `slot`, which the GPU must have finished.
    FrameStats stats(uint32_t slot) const;
    // Statistics of the last lighting recorded in `slot`, which the GPU must have finished, and of
    // the last exposure.
    CndLightingStats lightingStats(uint32_t slot) const;
    CndExposureStats exposureStats(uint32_t slot) const;

    const gpu::Image& radiance() const; // R32G32B32A32_SFLOAT, cd/m^2
    const gpu::Image& display() const;  // R8G8B8A8_UNORM, sRGB-encoded
    // The G-buffer; all images but the radiance are in SHADER_READ_ONLY_OPTIMAL.
    const gbuffer::Targets& targets() const;
    // CndLightingFrame::pairImage of the last heat map, in GENERAL.
    const gpu::Image& pairs() const;

    uint64_t triangleCount() const; // of all instances
    // The draws of meshes in the last recorded frame.
    std::vector<gbuffer::DrawRange> draws() const;

private:
    struct State;
    std::unique_ptr<State> state_;
};

} // namespace candelabra::app
