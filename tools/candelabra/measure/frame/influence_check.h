// SPDX-License-Identifier: Apache-2.0
// What cutting lights (CND_INFLUENCE_BY_ERROR) has changed on the display, against all light by
// brute force.
#pragma once

#include <functional>

#include "io/report.h"
#include "render/renderer.h"

namespace candelabra::app
{

// Errors are the largest of a pixel's sRGB-encoded channels of 0..1, before rounding to levels.
struct InfluenceCheck {
    double bound = 0; // that was asked for
    double largest = 0, mean = 0;
    double cutBelow = 0; // lx
    double bruteMs = 0;  // GPU time of brute force
};

// `last`: of the frame that `renderer` made of `options` last, whose exposure both are shown with.
InfluenceCheck checkInfluence(const VulkanContext& context, Renderer& renderer,
                              const FrameOptions& options, const FrameStats& last, uint64_t lights);

std::string influenceText(const InfluenceCheck& check);
Json toJson(const InfluenceCheck& check);

} // namespace candelabra::app
