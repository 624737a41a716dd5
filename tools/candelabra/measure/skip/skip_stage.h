// SPDX-License-Identifier: Apache-2.0
// Frames of one scene for bench/skip.h: ways to draw it that share a G-buffer.
#pragma once

#include <functional>
#include <memory>
#include <vector>

#include "render/renderer.h"

namespace candelabra::app
{

// A frame that can be drawn again and again.
struct Drawing {
    std::function<std::vector<PassTime>()> draw; // times of the passes that are compared
    // What was drawn last: radiance, and display (0..255) where whole frames are drawn.
    std::function<std::vector<float>()> image;
};

// How a lighting is used.
struct LightingWay {
    std::function<void(FrameOptions&)> edit = [](FrameOptions&) {};
    bool surfacesUnchanged = false; // promised from the second frame on
    std::vector<CndLight> before{}; // a set that it has had first
    uint32_t materialClasses = 0;   // CndLightingDesc
    CndInfluence influence{};
};

class SkipStage
{
public:
    // Both must outlive it and its drawings.
    SkipStage(const VulkanContext& context, const Scene& scene, PixelSize size);

    using Lights = std::vector<CndLight>;
    const Lights& lights() const { return scene_.lights; }
    const VulkanContext& context() const { return context_; }

    // The lighting alone, with lights of its own.
    Drawing lighting(const Lights& lights, const LightingWay& way = {});

    // Options of a frame that has been drawn so often.
    using Edit = std::function<void(FrameOptions&, uint32_t drawn)>;
    // Whole frames; of their passes those that `counts`.
    Drawing frames(const Edit& edit, const std::function<bool(const std::string& pass)>& counts);
    CndExposureStats exposureStats() const { return renderer_.stats(0).exposure; }

private:
    const VulkanContext& context_;
    const Scene& scene_;
    FrameOptions options_;
    Renderer renderer_;
};

} // namespace candelabra::app
