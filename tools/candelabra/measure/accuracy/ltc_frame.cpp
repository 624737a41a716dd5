// SPDX-License-Identifier: Apache-2.0
#include "measure/accuracy/ltc_frame.h"

#include <cstring>

#include "candelabra_bench_shaders.h"
#include "lights/abi_vectors.h"
#include "lights/light_limits.h"
#include "measure/kernels/vectors.h"

namespace candelabra::app
{
namespace
{

// Returns the light in view space.
CndLight inView(CndLight light, const glm::dmat4& viewFromWorld, const glm::dvec3& lightOrigin)
{
    const auto turned = [&](const float(&v)[3]) {
        return glm::dmat3(viewFromWorld) * lighting::dvec3From(v);
    };
    set(light.position,
        glm::dvec3(viewFromWorld *
                   glm::dvec4(lightOrigin + lighting::dvec3From(light.position), 1)));
    set(light.direction, turned(light.direction));
    set(light.axisU, turned(light.axisU));
    set(light.axisV, turned(light.axisV));
    return light;
}

} // namespace

LtcFrame::LtcFrame(const VulkanContext& context, Renderer& renderer, const Scene& scene,
                   const FrameOptions& options)
    : context_(context),
      renderer_(renderer),
      options_(options),
      frame_(renderer.lightingFrame(0, options)),
      gbuffer_(context.device(), CND_GBUFFER_FULL, {}),
      timer_(context.device(), "rival", 1, true),
      dfg_(context.device()),
      ltcTable_(uploadLtcTable(context.device())),
      uniforms_(context.device(), 1)
{
    uniforms_.write(0, surfaces::frameParams(frame_, gbuffer_, VK_FORMAT_R32G32B32A32_SFLOAT));
    glm::dmat4 viewFromWorld;
    std::memcpy(&viewFromWorld, frame_.camera.viewFromWorld, sizeof viewFromWorld);
    std::vector<CndLight> lights;
    lightsAtTime(scene, 0, lights);
    std::vector<CndLight> ofType[CND_LIGHT_TYPE_COUNT];
    for (const CndLight& light : lights)
        if (cndIsPunctual(light.type))
            punctual_.push_back(light);
        else
            ofType[light.type].push_back(inView(light, viewFromWorld, scene.lightOrigin));
    for (uint32_t type = 0; type < CND_LIGHT_TYPE_COUNT; ++type)
        if (!ofType[type].empty())
            add(type, ofType[type]);
}

void LtcFrame::add(uint32_t lightType, const std::vector<CndLight>& lights)
{
    using namespace gpu;
    const Device& device = context_.device();
    OfType out{.lights = uploadLights(device, lights),
               .kernel = {device,
                          spirv::shade_frame_comp,
                          {{SPEC_FOR_CPU, lighting::forCpu(device)},
                           {SPEC_SPECULAR_METHOD, options_.specular},
                           {SPEC_LIGHT_TYPE, lightType},
                           {SPEC_GBUFFER, gbuffer_.code()}}},
               .bindings = {}};
    out.bindings = out.kernel.createBindings(1);
    out.bindings.write(
        0,
        {Binding::ofTexels(LIGHT_CORE_TEXELS, out.lights.core),
         Binding::of(LIGHT_CORE, out.lights.core), Binding::of(SHADE_SHAPES, out.lights.shapes),
         Binding::of(SHADE_LIGHT_IDS, out.lights.shapes), // bound, but not read
         uniforms_.at(0), Binding::sampled(SHADE_DEPTH, frame_.depth),
         Binding::storage(RADIANCE_IMAGE, frame_.radiance),
         Binding::ofTexels(SHADE_DFG, dfg_.buffer()), Binding::ofTexels(BENCH_LTC, ltcTable_)},
        gbuffer_.views(frame_).bindings());
    types_.push_back(std::move(out));
}

double LtcFrame::draw()
{
    if (!punctual_.empty())
        renderer_.setLights(punctual_);
    context_.submitAndWait([&](VkCommandBuffer cmd) {
        renderer_.recordUnlit(cmd, options_);
        if (!punctual_.empty())
            renderer_.recordBruteRect(cmd, options_, {{0, 0}, {frame_.width, frame_.height}});
        gpu::Timer untimed(context_.device(), "table", 1, false);
        dfg_.recordFill({context_.device(), cmd, untimed, 0});
        timer_.begin(cmd, 0);
        const gpu::Frame f{context_.device(), cmd, timer_, 0};
        f.barrier();
        for (const OfType& t : types_) {
            t.kernel.dispatch(f, t.bindings.set(0), {.first = 0, .count = t.lights.count},
                              gpu::divideUp(frame_.width, gpu::TILE_SIZE),
                              gpu::divideUp(frame_.height, gpu::TILE_SIZE));
            f.barrier();
        }
        renderer_.recordBruteEnd(cmd);
    });
    if (!punctual_.empty())
        renderer_.lightsChanged();
    CndKernelTime times[CND_MAX_KERNEL_TIMES];
    uint32_t count = 0;
    return timer_.read(0, times, count) == CND_SUCCESS && count ? times[0].ms : 0;
}

} // namespace candelabra::app
