// SPDX-License-Identifier: Apache-2.0
#include "render/renderer.h"

#include <algorithm>
#include <array>
#include <atomic>
#include <cstring>
#include <utility>

#include "gbuffer/gbuffer.h"
#include "gpu/planning.h"
#include "io/error.h"
#include "render/bloom.h"
#include "render/camera.h"
#include "render/check.h"
#include "render/edge_filter.h"
#include "render/frame_stamps.h"
#include "render/image_barrier.h"
#include "render/pipeline_watch.h"
#include "render/scene_upload.h"

namespace candelabra::app
{
namespace
{

gpu::Image createDisplay(const gpu::Device& device, PixelSize size)
{
    return gpu::createImage(device, "display", VK_FORMAT_R8G8B8A8_UNORM, size.width, size.height,
                            VK_IMAGE_USAGE_STORAGE_BIT | VK_IMAGE_USAGE_TRANSFER_SRC_BIT,
                            VK_IMAGE_ASPECT_COLOR_BIT);
}

constexpr VkDeviceSize slotBytes = 256; // of CndLightingViewDesc::shadowBudget

// Returns the largest budget of a view: a buffer that the device allows, and an eighth of its
// largest memory.
VkDeviceSize largestBudget(const gpu::Device& device)
{
    VkDeviceSize heap = 0;
    for (uint32_t i = 0; i < device.memory.memoryHeapCount; ++i)
        heap = std::max(heap, device.memory.memoryHeaps[i].size);
    return std::min<VkDeviceSize>(device.limits.maxStorageBufferRange, heap / 8);
}

template <typename Stats>
Stats finishedStats(Result<std::optional<Stats>> result)
{
    const std::optional<Stats> stats = valueOrThrow(std::move(result));
    if (!stats)
        throw RunError("the statistics of a finished frame are not there");
    return *stats;
}

const std::vector<Material>& materialsOf(const Scene& scene, const RendererOptions& options)
{
    return options.materials ? *options.materials : scene.materials;
}

gbuffer::GBufferDesc gbufferDesc(const RendererOptions& o)
{
    return {.framesInFlight = o.framesInFlight, .layout = o.gbufferLayout, .timestamps = true};
}

CndLightingDesc lightingDesc(const Scene& scene, const RendererOptions& o)
{
    return {.framesInFlight = o.framesInFlight,
            .gbufferLayout = o.gbufferLayout,
            .timestamps = VK_TRUE,
            .specularMethods = o.specularMethods,
            .shading = o.shading,
            .diffuseOnlyTiles = hasDiffuseOnlySurfaces(scene, materialsOf(scene, o)),
            .lightTypes = o.lightTypes ? *o.lightTypes : lightTypesOf(scene),
            .influenceByError = o.influenceByError,
            .shadows = {.points = o.shadows}};
}

CndExposureDesc exposureDesc(const RendererOptions& o)
{
    return {.framesInFlight = o.framesInFlight, .timestamps = VK_TRUE};
}

// Returns the number of pipelines that a renderer makes before its first frame.
uint32_t countPipelines(const VulkanContext& context, const Scene& scene, const RendererOptions& o,
                        const gbuffer::Geometry& geometry)
{
    const gpu::Planning planning(context.desc());
    {
        const gpu::Device raster(planning.desc(), gpu::rasterPass);
        gbuffer::GBuffer(raster, gbufferDesc(o)).prepare(geometry);
    }
    valueOrThrow(Lighting::create(planning.desc(), lightingDesc(scene, o)));
    valueOrThrow(Exposure::create(planning.desc(), exposureDesc(o)));
    if (scene.environment)
        valueOrThrow(Environment::create(planning.desc(), {.framesInFlight = o.framesInFlight,
                                                           .gbufferLayout = o.gbufferLayout}));
    return planning.pipelineCount();
}

// Returns why there is no bloom in the frame, or null.
const char* unbloomedBecause(const FrameOptions& frame)
{
    return frame.bloom == 0                 ? "it is off"
           : frame.heatMap != HeatMap::None ? "a heat map is shown"
                                            : nullptr;
}

// Returns why the edge filter leaves the frame as it is, or null.
const char* unfilteredBecause(const FrameOptions& frame)
{
    return !frame.edgeFilter                ? "it is off"
           : frame.sample.count > 1         ? "samples are averaged"
           : frame.heatMap != HeatMap::None ? "a heat map is shown"
                                            : nullptr;
}

} // namespace

bool operator==(const CndInfluence& a, const CndInfluence& b)
{
    static_assert(sizeof a == sizeof a.rule + sizeof a.maxError + sizeof a.exposure +
                                  sizeof a.toneMap); // there is no padding
    return std::memcmp(&a, &b, sizeof a) == 0;
}

bool operator==(const CndExposureSettings& a, const CndExposureSettings& b)
{
    static_assert(sizeof a == sizeof a.manual + sizeof a.manualEv100 + sizeof a.compensation +
                                  sizeof a.middleGrey + sizeof a.minEv100 + sizeof a.maxEv100 +
                                  sizeof a.lowPercentile + sizeof a.highPercentile +
                                  sizeof a.speedUp + sizeof a.speedDown + sizeof a.metering +
                                  sizeof a.toneMap + sizeof a.dither); // there is no padding
    return std::memcmp(&a, &b, sizeof a) == 0;
}

void useKnownExposure(const Scene& scene, CndExposureSettings& settings)
{
    if (settings.manual || !scene.knownEv100)
        return;
    settings.manual = VK_TRUE;
    settings.manualEv100 = *scene.knownEv100;
}

// For its lighting frames, as shadingOf of engine/shading/shade_kernels.h.
uint32_t shadingOf(const FrameOptions& options)
{
    const bool brute = options.culling == CND_CULLING_BRUTE;
    const bool counts = options.countPairs || options.heatMap != HeatMap::None;
    return (brute ? CND_SHADING_BRUTE_BIT : CND_SHADING_CLUSTERED_BIT) |
           (counts && !brute ? CND_SHADING_COUNT_PAIRS_BIT : 0);
}

uint32_t lightTypesOf(const Scene& scene)
{
    uint32_t out = 0;
    for (const CndLight& light : scene.lights)
        out |= 1u << light.type;
    return out;
}

// Everything that decides the lit image of one scene at one size: two frames with equal values have
// the same image.
struct LitImageKey {
    Camera camera;
    FrameSample sample;
    double lightTime;
    bool lightsVisible;
    bool levels;
    CndSpecularMethod specular;
    uint32_t sampleCount, sampleSeed;
    CndCulling culling;
    uint32_t shadows;
    CndInfluenceRule influence;
    float influenceError, influenceExposure; // of CND_INFLUENCE_BY_ERROR
    CndToneMap influenceToneMap;

    bool operator==(const LitImageKey&) const = default;
    bool sameSurfaces(const LitImageKey& other) const
    {
        return camera == other.camera && sample == other.sample &&
               lightsVisible == other.lightsVisible && levels == other.levels;
    }
};

struct Renderer::State {
    const VulkanContext& context;
    const Scene* scene;
    RendererOptions options;
    std::vector<bool> litSlots;     // whether the slot's last frame was lit, not reused
    std::vector<bool> exposedSlots; // whether the slot has had a frame with exposure
    // Why the slot's last frame did without bloom and without the edge filter; null: it had them.
    std::vector<const char*> unbloomed, unfiltered;
    struct Unculled {
        const char *triangles, *emitters; // why they were drawn without a test; null: they were not
    };
    std::vector<Unculled> unculled; // by slot
    gbuffer::Geometry geometry;
    gbuffer::GBuffer gbuffer;
    gbuffer::Targets targets;
    gpu::Image display;
    Lighting lighting; // outlives its views
    // The cases that have pipelines: a mask of CndShadingBits by method, and a mask of light types.
    std::array<std::atomic<uint32_t>, CND_SPECULAR_METHOD_COUNT> shading{};
    std::atomic<uint32_t> lightTypes{0};
    std::shared_ptr<LightingView> view;
    std::vector<std::shared_ptr<LightingView>> slotViews; // which recorded the slot's last frame
    CndLightingViewDesc room{};                           // of `view`
    bool canGrow = true;                                  // false: a larger view could not be made
    Exposure exposure;
    Environment environment; // empty: the scene has none
    std::vector<CndLight> lights;
    std::optional<uint32_t>
        emitterLayers;           // layers of the emitters in the G-buffer; empty: no lights yet
    bool culledTriangles = true; // FrameOptions::cullTriangles of the last recorded frame
    double lightTime = 0;
    std::optional<LitImageKey> drawn; // what the images show
    bool litInBands = false; // recordBand() lit the images, so lists are those of the last band
    gpu::Image bandDepth;    // created for the first frame that is lit in bands
    std::optional<HeatMapPass> heatMaps;      // created for the first frame that shows a heat map
    std::optional<Accumulation> accumulation; // created for the first frame of several samples
    std::optional<Bloom> bloom;               // created for the first frame that has it
    std::optional<EdgeFilter> edgeFilter;     // created for the first frame that it filters
    // After surfaces and their environment, after lighting, and after exposure and edge filter.
    FrameStamps stamps;

    State(const VulkanContext& c, const Scene& s, const RendererOptions& o, gbuffer::Geometry&& g)
        : context(c),
          scene(&s),
          options(o),
          litSlots(o.framesInFlight),
          exposedSlots(o.framesInFlight),
          unbloomed(o.framesInFlight),
          unfiltered(o.framesInFlight),
          unculled(o.framesInFlight),
          geometry(std::move(g)),
          gbuffer(c.device(), gbufferDesc(o))
    {
        gbuffer.prepare(geometry);
    }
    double aspect() const { return double(options.size.width) / options.size.height; }
    CndCamera cameraOf(const FrameOptions& frame) const
    {
        CndCamera camera = makeCamera(frame.camera, aspect());
        shiftBySample(camera, frame.sample, options.size);
        return camera;
    }
    void setLights(double time);
    void moveLights(double time);
    void createSized();
    bool fitRoom(uint32_t slot);
    LitImageKey litImageKey(uint32_t slot, const FrameOptions& frame) const;
    CndInfluence influenceOf(uint32_t slot, const FrameOptions& frame) const;
    CndExposureSettings exposureOf(const FrameOptions& frame) const;
    std::vector<CndPassPlan> plan(uint32_t slot, const FrameStats& stats) const;
    void recordGBuffer(VkCommandBuffer cmd, uint32_t slot, const FrameOptions& frame);
    void recordEnvironment(VkCommandBuffer cmd, uint32_t slot, const FrameOptions& frame) const;
    void recordDisplay(VkCommandBuffer cmd, uint32_t slot, const FrameOptions& frame);
    void recordBandDepth(VkCommandBuffer cmd, uint32_t firstRow, uint32_t endRow);
    CndLightingFrame lightingFrame(uint32_t slot, const FrameOptions& frame) const;
    // The members that frames of lighting and of the environment have in common.
    template <typename Frame>
    Frame surfaceFrame(uint32_t slot, const FrameOptions& frame) const
    {
        return {.frameSlot = slot,
                .width = options.size.width,
                .height = options.size.height,
                .camera = cameraOf(frame),
                .clearDepth = clearDepth,
                .normalRoughness = targets.normalRoughness.view.get(),
                .albedo = targets.albedo.view.get(),
                .specular = targets.specular.view.get(),
                .depth = targets.depth.view.get(),
                .radiance = targets.radiance.view.get(),
                .lobes = scene->lobes,
                .energyCompensation = scene->energyCompensation};
    }
};

void Renderer::State::setLights(double time)
{
    lightsAtTime(*scene, time, lights);
    lightTime = time;
    drawn.reset();
    const glm::dvec3& at = scene->lightOrigin;
    valueOrThrow(lighting.setLights(lights, {at.x, at.y, at.z}));
    lightTypes |= lightTypesOf(*scene);
    emitterLayers.reset();
}

void Renderer::State::moveLights(double time)
{
    if (!scene->lightMotions.empty() && time != lightTime)
        setLights(time);
}

void Renderer::State::createSized()
{
    drawn.reset();
    heatMaps.reset();
    accumulation.reset();
    bloom.reset();
    edgeFilter.reset();
    const gpu::Device& device = context.device();
    const auto [width, height] = options.size;
    // The old images are destroyed first, so that old and new ones never take memory at the same
    // time.
    view.reset();
    bandDepth = {};
    slotViews.assign(options.framesInFlight, nullptr);
    targets = {};
    display = {};
    targets = gbuffer::createTargets(device, options.gbufferLayout, width, height);
    display = createDisplay(device, options.size);
    // 64 MiB, the default of the library, are 32 bytes for each of 1920x1080 pixels, and larger
    // images have more lists. fitRoom() finds what more lights need.
    const VkDeviceSize most = device.limits.maxStorageBufferRange;
    const VkDeviceSize lists = std::max<VkDeviceSize>(64 << 20, 32ull * width * height);
    room = {.maxWidth = width,
            .maxHeight = height,
            .listBudget = std::min(options.listBudget ? options.listBudget : lists, most),
            .shadowBudget = std::min(options.shadowBudget, most)};
    canGrow = true;
    view = std::make_shared<LightingView>(valueOrThrow(lighting.createView(room)));
}

// If the finished frame of the slot lacked room, replaces the view by one that has it, and returns
// false. The old view stays for as long as a slot has a frame of it. A frame in which lists are
// missing does not tell how many slots shadows need, so the next one may lack some.
bool Renderer::State::fitRoom(uint32_t slot)
{
    if (!canGrow || slotViews[slot] != view || !litSlots[slot])
        return true;
    auto known = view->stats(slot);
    if (!known || !known.value())
        return true;
    const CndLightingStats& stats = *known.value();
    const VkDeviceSize most = largestBudget(context.device());
    const auto grows = [&](VkDeviceSize& budget, VkDeviceSize wanted) {
        const bool more = std::min(wanted, most) > budget;
        budget = std::max(budget, std::min(wanted, most));
        return more;
    };
    CndLightingViewDesc wanted = room;
    if (!(stats.missingListBytes &&
          grows(wanted.listBudget, room.listBudget + stats.missingListBytes)) &&
        !(stats.missingShadowSlots &&
          grows(wanted.shadowBudget,
                (VkDeviceSize(stats.shadowSlots) + stats.missingShadowSlots) * slotBytes)))
        return true;
    auto made = lighting.createView(wanted);
    canGrow = bool(made);
    if (!made)
        return true; // the frames stay as they are, only slower
    room = wanted;
    view = std::make_shared<LightingView>(std::move(made.value()));
    drawn.reset();
    return false;
}

Renderer::Renderer(const VulkanContext& context, const Scene& scene, const RendererOptions& options)
{
    gbuffer::Geometry geometry = uploadGeometry(context, scene, materialsOf(scene, options));
    if (PipelineWatch::watches())
        PipelineWatch::announce(countPipelines(context, scene, options, geometry));
    state_ = std::make_unique<State>(context, scene, options, std::move(geometry));
    State& s = *state_;
    const CndLightingDesc lighting = lightingDesc(scene, options);
    s.lightTypes = lighting.lightTypes;
    for (uint32_t method = 0; method < CND_SPECULAR_METHOD_COUNT; ++method)
        if (lighting.specularMethods >> method & 1)
            s.shading[method] = options.shading;
    s.lighting = valueOrThrow(Lighting::create(context.desc(), lighting));
    if (options.shadows)
        addOccluders(s.lighting, scene, materialsOf(scene, options));
    s.exposure = valueOrThrow(Exposure::create(context.desc(), exposureDesc(options)));
    if (scene.environment)
        s.environment = uploadEnvironment(context, *scene.environment,
                                          {.framesInFlight = options.framesInFlight,
                                           .gbufferLayout = options.gbufferLayout,
                                           .timestamps = VK_TRUE});
    if (options.stamps)
        s.stamps =
            FrameStamps(context.device(), context.timestampValidBits(), options.framesInFlight, 1);
    if (!options.lightTypes)
        s.setLights(0);
    s.createSized();
}

Renderer::~Renderer() = default;

bool Renderer::fits(uint32_t slot)
{
    return state_->fitRoom(slot);
}

bool Renderer::canDraw(const FrameOptions& options) const
{
    const uint32_t needed = shadingOf(options);
    return (state_->shading[options.specular] & needed) == needed;
}

bool Renderer::canLightBy(uint32_t lightTypes) const
{
    return (state_->lightTypes & lightTypes) == lightTypes;
}

void Renderer::prepareToDraw(const FrameOptions& options)
{
    if (canDraw(options))
        return;
    const uint32_t needed = shadingOf(options);
    valueOrThrow(state_->lighting.addPipelines(
        {.specularMethods = 1u << options.specular, .shading = needed}));
    state_->shading[options.specular] |= needed;
}

void Renderer::prepareToLightBy(uint32_t lightTypes)
{
    valueOrThrow(state_->lighting.addPipelines({.lightTypes = lightTypes}));
    state_->lightTypes |= lightTypes;
}

void Renderer::sceneMoved(const Scene& scene)
{
    state_->scene = &scene;
}

void Renderer::lightsChanged()
{
    state_->setLights(state_->lightTime);
}

void Renderer::resize(PixelSize size)
{
    state_->options.size = size;
    state_->createSized();
}

PixelSize Renderer::size() const
{
    return state_->options.size;
}

void Renderer::State::recordGBuffer(VkCommandBuffer cmd, uint32_t slot, const FrameOptions& frame)
{
    drawn.reset();
    if (frame.lightsVisible && emitterLayers != frame.camera.layers) {
        const double origin[3] = {scene->lightOrigin.x, scene->lightOrigin.y, scene->lightOrigin.z};
        if (frame.camera.layers)
            gbuffer.setEmitters(lightsShown(lights, frame.camera), origin);
        else
            gbuffer.setEmitters(lights, origin);
        emitterLayers = frame.camera.layers;
    }
    const glm::vec3 background = environment.get() ? glm::vec3(0) : scene->background;
    culledTriangles = frame.cullTriangles;
    const auto unculledBecause = [&](bool culls, const char* otherwise) {
        const char* device =
            context.device().lanesAreCpuVector ? otherwise : "the device is not llvmpipe";
        return !culls ? device : frame.cullTriangles ? nullptr : "it is switched off";
    };
    unculled[slot] = {
        .triangles = unculledBecause(geometry.testsTriangles(), "no mesh has enough triangles"),
        .emitters =
            unculledBecause(frame.lightsVisible && gbuffer.cullsEmitters(), "no light is visible")};
    gbuffer.record(cmd, geometry,
                   {.slot = slot,
                    .camera = cameraOf(frame),
                    .clearDepth = clearDepth,
                    .background = {background.x, background.y, background.z},
                    .attachments = targets.attachments(),
                    .width = options.size.width,
                    .height = options.size.height,
                    .cullTriangles = frame.cullTriangles,
                    .maxLevelError = frame.drawsLevels() ? gbuffer::defaultMaxLevelError : 0,
                    .coverageFrame = frame.sample.index,
                    .drawEmitters = frame.lightsVisible});
    if (environment.get())
        recordEnvironment(cmd, slot, frame);
}

// The environment is added before the lights, so that frames recorded in pieces add up in the same
// order.
void Renderer::State::recordEnvironment(VkCommandBuffer cmd, uint32_t slot,
                                        const FrameOptions& frame) const
{
    auto out = surfaceFrame<CndEnvironmentFrame>(slot, frame);
    out.scale = float(scene->environment->scale);
    out.background = VK_TRUE;
    setEnvironmentRotation(scene->environment->rotation, out.worldFromEnvironment);
    valueOrThrow(environment.record(cmd, out));
}

CndLightingFrame Renderer::State::lightingFrame(uint32_t slot, const FrameOptions& frame) const
{
    auto out = surfaceFrame<CndLightingFrame>(slot, frame);
    out.specularMethod = frame.specular;
    out.sampleCount = frame.sampleCount;
    out.sampleSeed = frame.sampleSeed + frame.sample.index;
    out.culling = frame.culling;
    out.influence = influenceOf(slot, frame);
    out.countPairs = frame.countPairs;
    out.shadowsOff = frame.shadows == 0;
    out.layers = frame.camera.layers;
    return out;
}

CndExposureSettings Renderer::State::exposureOf(const FrameOptions& frame) const
{
    CndExposureSettings out = frame.exposure;
    out.compensation += scene->exposureCompensation;
    return out;
}

// The previous frame in the slot has finished, so its exposure is read without waiting and is the
// same in every run.
CndInfluence Renderer::State::influenceOf(uint32_t slot, const FrameOptions& frame) const
{
    CndInfluence out = frame.influence;
    if (out.rule != CND_INFLUENCE_BY_ERROR)
        return out;
    const CndExposureSettings e = exposureOf(frame);
    out.toneMap = e.toneMap;
    if (e.manual)
        out.exposure = cndExposureFromEv100(e.manualEv100 - e.compensation, e.middleGrey);
    else if (exposedSlots[slot])
        out.exposure = finishedStats(exposure.stats(slot)).exposure;
    return out;
}

LitImageKey Renderer::State::litImageKey(uint32_t slot, const FrameOptions& f) const
{
    const CndInfluence influence = influenceOf(slot, f);
    return {f.camera,           f.sample,         lightTime,      f.lightsVisible,
            f.drawsLevels(),    f.specular,       f.sampleCount,  f.sampleSeed,
            f.culling,          f.shadows,        influence.rule, influence.maxError,
            influence.exposure, influence.toneMap};
}

void Renderer::moveLights(double time)
{
    state_->moveLights(time);
}

void Renderer::record(VkCommandBuffer cmd, uint32_t slot, const FrameOptions& frame)
{
    prepareToDraw(frame);
    State& s = *state_;
    s.fitRoom(slot);
    s.moveLights(frame.time);
    const LitImageKey lit = s.litImageKey(slot, frame);
    const bool counts = frame.countPairs || frame.heatMap != HeatMap::None;
    const bool oneSample = frame.sample.count == 1;
    const bool kept = frame.reuse == Reuse::Lighting && oneSample && !counts && s.drawn == lit;
    if (frame.heatMap != HeatMap::None && !s.heatMaps)
        s.heatMaps.emplace(s.context.device(), s.options.size, s.options.framesInFlight);
    const bool sameSurfaces =
        frame.reuse != Reuse::None && s.drawn && !s.litInBands && s.drawn->sameSurfaces(lit);
    const VkImage radiance = s.targets.radiance.image.get();
    s.litSlots[slot] = !kept;
    s.stamps.begin(cmd, slot);
    if (kept) {
        transition(cmd, radiance, transferRead, computeRead);
    } else {
        s.recordGBuffer(cmd, slot, frame);
        CndLightingFrame lighting = s.lightingFrame(slot, frame);
        lighting.surfacesUnchanged = sameSurfaces;
        if (frame.heatMap != HeatMap::None) {
            s.heatMaps->recordClear(cmd);
            lighting.countPairs = VK_TRUE;
            (frame.heatMap == HeatMap::Shadow ? lighting.shadowImage : lighting.pairImage) =
                s.heatMaps->pairs();
        }
        valueOrThrow(s.view->record(cmd, lighting));
        s.slotViews[slot] = s.view;
        s.drawn = lit;
        s.litInBands = false;
        transition(cmd, radiance, computeWrite, computeRead);
    }
    s.recordDisplay(cmd, slot, frame);
}

// Records what follows lighting: bloom, exposure, which draws the display image, the edge filter,
// the sums of samples, and the heat map.
void Renderer::State::recordDisplay(VkCommandBuffer cmd, uint32_t slot, const FrameOptions& frame)
{
    const FrameSample& sample = frame.sample;
    const bool first = sample.index == 0; // the exposure of a frame follows from its first sample
    const bool sums = sample.count > 1, last = sample.isLast();
    if (sums && !accumulation)
        accumulation.emplace(context.device(), options.size, options.framesInFlight);
    if (last)
        transition(cmd, display.image.get(), discarded, computeWrite);
    const VkImageView drawnOn = sums ? accumulation->recordInput(cmd) : display.view.get();
    unbloomed[slot] = unbloomedBecause(frame);
    unfiltered[slot] = unfilteredBecause(frame);
    const bool filters = !unfiltered[slot];
    if (filters && !edgeFilter)
        edgeFilter.emplace(context.device(), options.size, options.framesInFlight);
    const VkImageView radiance = targets.radiance.view.get();
    if (!unbloomed[slot] && !bloom)
        bloom.emplace(context.device(), options.size, options.framesInFlight);
    valueOrThrow(exposure.record(
        cmd,
        {.frameSlot = slot,
         .width = options.size.width,
         .height = options.size.height,
         .radiance = unbloomed[slot] ? radiance : bloom->record(cmd, slot, radiance, frame.bloom),
         .meteredRadiance = radiance,
         .display = filters ? edgeFilter->recordInput(cmd) : drawnOn,
         .deltaTime = first ? frame.deltaTime : 0,
         .reset = first && frame.resetExposure,
         .ditherSeed = frame.ditherSeed + sample.index,
         .settings = exposureOf(frame)}));
    if (filters)
        edgeFilter->record(cmd, slot, drawnOn);
    stamps.stamp(cmd, slot);
    exposedSlots[slot] = true;
    if (frame.heatMap != HeatMap::None)
        heatMaps->record(cmd, slot, frame.heatMap, drawnOn);
    ImageAccess radianceUse = computeRead;
    if (sums) {
        transition(cmd, targets.radiance.image.get(), computeRead, computeWrite);
        accumulation->record(cmd, slot, sample, targets.radiance.view.get(), display.view.get(),
                             frame.exposure.dither);
        radianceUse = computeWrite;
    }
    transition(cmd, targets.radiance.image.get(), radianceUse, transferRead);
    if (last)
        transition(cmd, display.image.get(), computeWrite, transferRead);
}

void Renderer::recordUnlit(VkCommandBuffer cmd, const FrameOptions& frame, uint32_t slot)
{
    state_->moveLights(frame.time);
    state_->recordGBuffer(cmd, slot, frame);
}

// The lighting module finds work where the depth says that there is a surface. So it lights the
// rows of a depth image that has no other surfaces.
void Renderer::recordBand(VkCommandBuffer cmd, uint32_t slot, const FrameOptions& frame,
                          uint32_t firstRow, uint32_t endRow)
{
    State& s = *state_;
    s.fitRoom(slot);
    s.recordBandDepth(cmd, firstRow, endRow);
    CndLightingFrame lighting = s.lightingFrame(slot, frame);
    lighting.depth = s.bandDepth.view.get();
    valueOrThrow(s.view->record(cmd, lighting));
    s.slotViews[slot] = s.view;
    s.litSlots[slot] = true;
    s.litInBands = true;
    if (endRow != s.options.size.height)
        return;
    s.drawn = s.litImageKey(slot, frame);
    transition(cmd, s.targets.radiance.image.get(), computeWrite, computeRead);
    s.recordDisplay(cmd, slot, frame);
}

// Copies rows of the depth of the frame to bandDepth, in which all other rows are empty.
void Renderer::State::recordBandDepth(VkCommandBuffer cmd, uint32_t firstRow, uint32_t endRow)
{
    constexpr VkImageAspectFlags aspect = VK_IMAGE_ASPECT_DEPTH_BIT;
    const auto [width, height] = options.size;
    if (!bandDepth.image.get())
        bandDepth = gpu::createImage(
            context.device(), "depth of a band", VK_FORMAT_D32_SFLOAT, width, height,
            VK_IMAGE_USAGE_SAMPLED_BIT | VK_IMAGE_USAGE_TRANSFER_DST_BIT, aspect);
    // The band before may still read the image, whose content is not kept.
    constexpr ImageAccess read{VK_PIPELINE_STAGE_2_COMPUTE_SHADER_BIT, VK_ACCESS_2_NONE,
                               VK_IMAGE_LAYOUT_UNDEFINED};
    const VkImage from = targets.depth.image.get(), to = bandDepth.image.get();
    transition(cmd, from, computeRead, transferRead, aspect);
    transition(cmd, to, read, transferWrite, aspect);
    const VkClearDepthStencilValue empty{clearDepth, 0};
    const VkImageSubresourceRange all{aspect, 0, 1, 0, 1};
    vkCmdClearDepthStencilImage(cmd, to, VK_IMAGE_LAYOUT_TRANSFER_DST_OPTIMAL, &empty, 1, &all);
    transition(cmd, to, transferWrite, transferWrite, aspect);
    const VkImageCopy rows{.srcSubresource = {aspect, 0, 0, 1},
                           .srcOffset = {0, int32_t(firstRow), 0},
                           .dstSubresource = {aspect, 0, 0, 1},
                           .dstOffset = {0, int32_t(firstRow), 0},
                           .extent = {width, endRow - firstRow, 1}};
    vkCmdCopyImage(cmd, from, VK_IMAGE_LAYOUT_TRANSFER_SRC_OPTIMAL, to,
                   VK_IMAGE_LAYOUT_TRANSFER_DST_OPTIMAL, 1, &rows);
    transition(cmd, from, transferRead, computeRead, aspect);
    transition(cmd, to, transferWrite, computeRead, aspect);
}

void Renderer::recordBruteRect(VkCommandBuffer cmd, const FrameOptions& frame, const VkRect2D& rect)
{
    FrameOptions brute = frame;
    brute.culling = CND_CULLING_BRUTE;
    brute.countPairs = false;
    brute.heatMap = HeatMap::None;
    prepareToDraw(brute);
    CndLightingFrame lighting = state_->lightingFrame(0, brute);
    lighting.bruteRect = rect;
    valueOrThrow(state_->view->record(cmd, lighting));
    state_->slotViews[0] = state_->view;
}

void Renderer::recordBruteEnd(VkCommandBuffer cmd)
{
    transition(cmd, state_->targets.radiance.image.get(), computeWrite, transferRead);
}

void Renderer::recordBlack(VkCommandBuffer cmd)
{
    clearForCompute(cmd, state_->targets.radiance.image.get(), computeWrite);
}

void Renderer::setLights(const std::vector<CndLight>& lights)
{
    const glm::dvec3& at = state_->scene->lightOrigin;
    state_->drawn.reset();
    valueOrThrow(state_->lighting.setLights(lights, {at.x, at.y, at.z}));
}

CndLightingFrame Renderer::lightingFrame(uint32_t slot, const FrameOptions& frame) const
{
    return state_->lightingFrame(slot, frame);
}

CndLightingStats Renderer::lightingStats(uint32_t slot) const
{
    return finishedStats(state_->slotViews[slot]->stats(slot));
}

CndExposureStats Renderer::exposureStats(uint32_t slot) const
{
    return finishedStats(state_->exposure.stats(slot));
}

std::vector<CndPassPlan> Renderer::State::plan(uint32_t slot, const FrameStats& stats) const
{
    const char* kept = stats.lit ? nullptr : "nothing has changed";
    const char* noMeshes = geometry.counts().instances ? nullptr : "no meshes";
    const char* noEnvironment = environment.get() ? nullptr : "no environment";
    std::vector<CndPassPlan> out{{"cull_instances", kept ? kept : noMeshes},
                                 {"compact_instances", kept ? kept : noMeshes},
                                 {"cull_emitters", kept ? kept : unculled[slot].emitters},
                                 {"cull_triangles", kept ? kept : unculled[slot].triangles},
                                 {"gbuffer_raster", kept},
                                 {"shade_environment", noEnvironment ? noEnvironment : kept}};
    const auto add = [&](const CndPassPlan* passes, uint32_t count) {
        out.insert(out.end(), passes, passes + count);
    };
    if (kept)
        out.push_back({"lighting", kept});
    else
        add(stats.lighting.passes, stats.lighting.passCount);
    out.push_back({"bloom_down", unbloomed[slot]});
    out.push_back({"bloom_up", unbloomed[slot]});
    add(stats.exposure.passes, stats.exposure.passCount);
    out.push_back({"edge_filter", unfiltered[slot]});
    return out;
}

FrameStats Renderer::stats(uint32_t slot) const
{
    FrameStats out{.lit = state_->litSlots[slot]};
    const std::vector<double> ends = state_->stamps.read(slot);
    out.gpuMs = ends.empty() ? 0 : ends.back();
    out.stamps = state_->stamps.count(slot);
    const auto addModule = [&](FramePart part, const CndKernelTime* rows, uint32_t count) {
        const std::vector<PassTime> passes = passesOf({rows, count}, part);
        out.passes.insert(out.passes.end(), passes.begin(), passes.end());
        out.stamps += count ? count + 1 : 0; // one more at the beginning of the module
    };
    std::vector<CndKernelTime> rows(CND_MAX_KERNEL_TIMES);
    uint32_t count = 0;
    if (out.lit) {
        out.lighting = lightingStats(slot);
        if (state_->gbuffer.times(slot, rows.data(), count))
            addModule(FramePart::Raster, rows.data(), count);
        if (state_->environment.get()) {
            const CndEnvironmentStats environment = finishedStats(state_->environment.stats(slot));
            addModule(FramePart::Rest, environment.kernelTimes, environment.kernelTimeCount);
        }
        const size_t first = out.passes.size();
        addModule(FramePart::Lighting, out.lighting.kernelTimes, out.lighting.kernelTimeCount);
        // Shading passes run once for every type of light in the scene.
        const uint32_t types = uint32_t(
            std::ranges::count_if(out.lighting.lightTypeCounts, [](uint32_t n) { return n; }));
        for (PassTime& pass : std::span(out.passes).subspan(first))
            if (pass.name.starts_with("shade_") && types) {
                pass.runs = types;
                out.stamps += types - 1;
            }
    }
    out.exposure = exposureStats(slot);
    if (!state_->unbloomed[slot] &&
        state_->bloom->timer().read(slot, rows.data(), count) == CND_SUCCESS)
        addModule(FramePart::Rest, rows.data(), count);
    addModule(FramePart::Rest, out.exposure.kernelTimes, out.exposure.kernelTimeCount);
    if (!state_->unfiltered[slot] &&
        state_->edgeFilter->timer().read(slot, rows.data(), count) == CND_SUCCESS)
        addModule(FramePart::Rest, rows.data(), count);
    out.plan = state_->plan(slot, out);
    return out;
}

const gpu::Image& Renderer::radiance() const
{
    return state_->targets.radiance;
}

const gpu::Image& Renderer::display() const
{
    return state_->display;
}

const gbuffer::Targets& Renderer::targets() const
{
    return state_->targets;
}

const gpu::Image& Renderer::pairs() const
{
    return state_->heatMaps->pairImage();
}

uint64_t Renderer::triangleCount() const
{
    return state_->geometry.counts().triangles;
}

std::vector<gbuffer::DrawRange> Renderer::draws() const
{
    return state_->geometry.draws(state_->culledTriangles);
}

} // namespace candelabra::app
