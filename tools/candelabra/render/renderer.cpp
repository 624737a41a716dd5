// SPDX-License-Identifier: Apache-2.0
#include "render/renderer.h"

#include <algorithm>
#include <optional>
#include <utility>

#include "gbuffer/gbuffer.h"
#include "render/camera.h"
#include "render/error.h"
#include "render/image_barrier.h"
#include "render/scene_environment.h"
#include "render/scene_geometry.h"

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

template <typename Stats>
Stats finished(Result<std::optional<Stats>> result)
{
    const std::optional<Stats> stats = take(std::move(result));
    if (!stats)
        throw RunError("the statistics of a finished frame are not there");
    return *stats;
}

void append(std::vector<PassTime>& out, const CndKernelTime* times, uint32_t count)
{
    for (uint32_t i = 0; i < count; ++i)
        out.push_back({passName(times[i].name), times[i].ms});
}

} // namespace

struct Renderer::State {
    const VulkanContext& context;
    const Scene& scene;
    RendererOptions options;
    gbuffer::Geometry geometry;
    gbuffer::GBuffer gbuffer;
    gbuffer::Targets targets;
    gpu::Image display;
    Lighting lighting; // outlives its view
    LightingView view;
    Exposure exposure;
    Environment environment; // empty: the scene has none
    std::vector<CndLight> lights;
    double lightTime = 0;

    State(const VulkanContext& c, const Scene& s, const RendererOptions& o)
        : context(c),
          scene(s),
          options(o),
          geometry(uploadGeometry(c, s)),
          gbuffer(
              c.device(),
              {.framesInFlight = o.framesInFlight, .layout = o.gbufferLayout, .timestamps = true})
    {
    }
    double aspect() const { return double(options.size.width) / options.size.height; }
    void setLights(double time);
    void createSized();
    void recordGBuffer(VkCommandBuffer cmd, uint32_t slot, const FrameOptions& frame);
    void recordEnvironment(VkCommandBuffer cmd, uint32_t slot, const FrameOptions& frame) const;
    CndLightingFrame lightingFrame(uint32_t slot, const FrameOptions& frame) const;
    // What lighting and environment are told alike.
    template <typename Frame>
    Frame surfaceFrame(uint32_t slot, const FrameOptions& frame) const
    {
        return {.frameSlot = slot,
                .width = options.size.width,
                .height = options.size.height,
                .camera = makeCamera(frame.camera, aspect()),
                .clearDepth = clearDepth,
                .normalRoughness = targets.normalRoughness.view.get(),
                .albedo = targets.albedo.view.get(),
                .specular = targets.specular.view.get(),
                .depth = targets.depth.view.get(),
                .radiance = targets.radiance.view.get(),
                .lobes = scene.lobes,
                .energyCompensation = scene.energyCompensation};
    }
};

void Renderer::State::setLights(double time)
{
    lightsAtTime(scene, time, lights);
    lightTime = time;
    const double origin[3] = {scene.lightOrigin.x, scene.lightOrigin.y, scene.lightOrigin.z};
    take(lighting.setLights(lights, origin));
    gbuffer.setEmitters(lights, origin);
}

void Renderer::State::createSized()
{
    const gpu::Device& device = context.device();
    const auto [width, height] = options.size;
    // The old ones go first, so that both never take memory at once.
    view = LightingView();
    targets = {};
    display = {};
    targets = gbuffer::createTargets(device, options.gbufferLayout, width, height);
    display = createDisplay(device, options.size);
    view = take(lighting.createView({.maxWidth = width, .maxHeight = height}));
}

uint32_t maxLightsOf(const DeviceInfo& device)
{
    VkPhysicalDeviceProperties properties{};
    vkGetPhysicalDeviceProperties(device.handle, &properties);
    return cndMaxLightCount(&properties.limits);
}

Renderer::Renderer(const VulkanContext& context, const Scene& scene, const RendererOptions& options)
    : state_(std::make_unique<State>(context, scene, options))
{
    State& s = *state_;
    constexpr uint32_t allMethods = (1u << CND_SPECULAR_METHOD_COUNT) - 1;
    const uint32_t methods = options.specularMethods ? options.specularMethods : allMethods;
    s.lighting = take(Lighting::create(context.desc(), {.framesInFlight = options.framesInFlight,
                                                        .gbufferLayout = options.gbufferLayout,
                                                        .timestamps = VK_TRUE,
                                                        .specularMethods = methods}));
    s.exposure = take(Exposure::create(
        context.desc(), {.framesInFlight = options.framesInFlight, .timestamps = VK_TRUE}));
    if (scene.environment)
        s.environment = uploadEnvironment(
            context, *scene.environment,
            {.gbufferLayout = options.gbufferLayout, .framesInFlight = options.framesInFlight});
    s.setLights(0);
    s.createSized();
}

Renderer::~Renderer() = default;

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
    if (!scene.lightMotions.empty() && frame.time != lightTime)
        setLights(frame.time);
    const glm::vec3 background = environment.get() ? glm::vec3(0) : scene.background;
    gbuffer.record(cmd, geometry,
                   {.slot = slot,
                    .camera = makeCamera(frame.camera, aspect()),
                    .clearDepth = clearDepth,
                    // The environment is the background where there is one.
                    .background = {background.x, background.y, background.z},
                    .attachments = targets.attachments(),
                    .width = options.size.width,
                    .height = options.size.height,
                    .drawEmitters = frame.lightsVisible});
    if (environment.get())
        recordEnvironment(cmd, slot, frame);
}

// Before the lights, so that frames drawn in pieces add up in the same order.
void Renderer::State::recordEnvironment(VkCommandBuffer cmd, uint32_t slot,
                                        const FrameOptions& frame) const
{
    auto out = surfaceFrame<CndEnvironmentFrame>(slot, frame);
    out.scale = float(scene.environment->scale);
    out.background = VK_TRUE;
    setEnvironmentRotation(scene.environment->rotation, out.worldFromEnvironment);
    take(environment.record(cmd, out));
}

CndLightingFrame Renderer::State::lightingFrame(uint32_t slot, const FrameOptions& frame) const
{
    auto out = surfaceFrame<CndLightingFrame>(slot, frame);
    out.specularMethod = frame.specular;
    out.sampleCount = frame.sampleCount;
    out.sampleSeed = frame.sampleSeed;
    out.errorBudget = frame.errorBudget;
    out.culling = frame.culling;
    out.countPairs = frame.countPairs;
    return out;
}

void Renderer::record(VkCommandBuffer cmd, uint32_t slot, const FrameOptions& frame)
{
    State& s = *state_;
    s.recordGBuffer(cmd, slot, frame);

    take(s.view.record(cmd, s.lightingFrame(slot, frame)));

    const VkImage radiance = s.targets.radiance.image.get(), display = s.display.image.get();
    transition(cmd, radiance, computeWrite, computeRead);
    transition(cmd, display, discarded, computeWrite);
    take(s.exposure.record(cmd, {.frameSlot = slot,
                                 .width = s.options.size.width,
                                 .height = s.options.size.height,
                                 .radiance = s.targets.radiance.view.get(),
                                 .display = s.display.view.get(),
                                 .deltaTime = frame.deltaTime,
                                 .reset = frame.resetExposure,
                                 .ditherSeed = frame.ditherSeed,
                                 .settings = frame.exposure}));

    transition(cmd, radiance, computeRead, transferRead);
    transition(cmd, display, computeWrite, transferRead);
}

void Renderer::recordUnlit(VkCommandBuffer cmd, const FrameOptions& frame)
{
    state_->recordGBuffer(cmd, 0, frame);
}

void Renderer::recordBruteRect(VkCommandBuffer cmd, const FrameOptions& frame, const VkRect2D& rect)
{
    CndLightingFrame lighting = state_->lightingFrame(0, frame);
    lighting.culling = CND_CULLING_BRUTE;
    lighting.bruteRect = rect;
    lighting.countPairs = VK_FALSE;
    take(state_->view.record(cmd, lighting));
}

void Renderer::recordBruteEnd(VkCommandBuffer cmd)
{
    transition(cmd, state_->targets.radiance.image.get(), computeWrite, transferRead);
}

CndLightingFrame Renderer::lightingFrame(uint32_t slot, const FrameOptions& frame) const
{
    return state_->lightingFrame(slot, frame);
}

CndLightingStats Renderer::lightingStats(uint32_t slot) const
{
    return finished(state_->view.stats(slot));
}

FrameStats Renderer::stats(uint32_t slot) const
{
    FrameStats out;
    out.lighting = lightingStats(slot);
    std::vector<CndKernelTime> raster(CND_MAX_KERNEL_TIMES);
    uint32_t count = 0;
    if (state_->gbuffer.times(slot, raster.data(), count))
        append(out.passes, raster.data(), count);
    if (state_->environment.get()) {
        const CndEnvironmentStats environment = finished(state_->environment.stats(slot));
        append(out.passes, environment.kernelTimes, environment.kernelTimeCount);
    }
    out.exposure = finished(state_->exposure.stats(slot));
    append(out.passes, out.lighting.kernelTimes, out.lighting.kernelTimeCount);
    append(out.passes, out.exposure.kernelTimes, out.exposure.kernelTimeCount);
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

uint64_t Renderer::triangleCount() const
{
    return state_->geometry.counts().triangles;
}

} // namespace candelabra::app
