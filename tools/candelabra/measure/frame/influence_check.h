// SPDX-License-Identifier: Apache-2.0
// Checks how much cutting lights (CND_INFLUENCE_BY_ERROR) has changed on the display, by comparison
// with all lights by brute force.
#pragma once

#include "io/report.h"
#include "render/renderer.h"

namespace candelabra::app
{

// The error of a pixel is that of its worst channel. Channels are sRGB-encoded values of 0..1,
// before they are rounded to 8-bit levels.
struct InfluenceCheck {
    double bound = 0; // the largest error that was asked for
    double largest = 0, mean = 0;
    double cutBelow = 0; // lx; lights are cut where their illuminance is below it
    double bruteMs = 0;  // GPU time of brute force
};

// `last` holds the statistics of the last frame, which `renderer` made of `options`. Both images
// are compared under the exposure of that frame.
InfluenceCheck checkInfluence(const VulkanContext& context, Renderer& renderer,
                              const FrameOptions& options, const FrameStats& last, uint64_t lights);

std::string influenceText(const InfluenceCheck& check);
Json toJson(const InfluenceCheck& check);

} // namespace candelabra::app
