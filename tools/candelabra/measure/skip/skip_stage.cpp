// SPDX-License-Identifier: Apache-2.0
#include "measure/skip/skip_stage.h"

#include "render/camera.h"
#include "render/check.h"
#include "render/readback.h"

namespace candelabra::app
{

SkipStage::SkipStage(const VulkanContext& context, const Scene& scene, PixelSize size)
    : context_(context),
      scene_(scene),
      options_{.camera = selectCamera(scene, ""), .lightsVisible = false},
      renderer_(context, scene, {.size = size, .specularMethods = 1u << CND_SPECULAR_CONIC})
{
    cndDefaultExposureSettings(&options_.exposure);
}

Drawing SkipStage::lighting(const Lights& lights, const LightingWay& way)
{
    struct Own {
        Lighting lighting; // outlives its view
        LightingView view;
        bool drawn = false;
    };
    const auto own = std::make_shared<Own>();
    own->lighting = take(Lighting::create(
        context_.desc(), {.framesInFlight = 1,
                          .timestamps = VK_TRUE,
                          .materialClasses = way.materialClasses,
                          .influenceByError = way.influence.rule == CND_INFLUENCE_BY_ERROR}));
    const auto [width, height] = renderer_.size();
    own->view = take(own->lighting.createView({.maxWidth = width, .maxHeight = height}));
    const glm::dvec3& o = scene_.lightOrigin;
    for (const Lights* set : {&way.before, &lights})
        take(own->lighting.setLights(*set, {o.x, o.y, o.z}));
    FrameOptions options = options_;
    way.edit(options);
    const auto draw = [this, own, options, influence = way.influence,
                       promise = way.surfacesUnchanged] {
        CndLightingFrame frame = renderer_.lightingFrame(0, options);
        frame.influence = influence;
        frame.surfacesUnchanged = promise && std::exchange(own->drawn, true);
        context_.submitAndWait([&](VkCommandBuffer cmd) {
            renderer_.recordUnlit(cmd, options);
            take(own->view.record(cmd, frame));
            renderer_.recordBruteEnd(cmd);
        });
        const std::optional<CndLightingStats> stats = take(own->view.stats(0));
        std::vector<PassTime> out;
        for (uint32_t i = 0; stats && i < stats->kernelTimeCount; ++i)
            out.push_back({passName(stats->kernelTimes[i].name), stats->kernelTimes[i].ms});
        return out;
    };
    return {.draw = draw, .image = [this] { return readRadiance(context_, renderer_).pixels; }};
}

Drawing SkipStage::frames(const Edit& edit,
                          const std::function<bool(const std::string& pass)>& counts)
{
    const auto drawn = std::make_shared<uint32_t>(0);
    const auto draw = [this, edit, counts, drawn] {
        FrameOptions options = options_;
        edit(options, (*drawn)++);
        context_.submitAndWait([&](VkCommandBuffer cmd) { renderer_.record(cmd, 0, options); });
        std::vector<PassTime> out;
        for (const PassTime& pass : renderer_.stats(0).passes)
            if (counts(pass.name))
                out.push_back(pass);
        return out;
    };
    const auto image = [this] {
        std::vector<float> out = readRadiance(context_, renderer_).pixels;
        const std::vector<uint8_t> display = readDisplay(context_, renderer_);
        out.insert(out.end(), display.begin(), display.end());
        return out;
    };
    return {.draw = draw, .image = image};
}

} // namespace candelabra::app
