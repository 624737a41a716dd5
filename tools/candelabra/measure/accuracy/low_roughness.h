// SPDX-License-Identifier: Apache-2.0
// A sphere light mirrored by a nearly smooth ball (perceptual roughness 0.01): what float32 does to
// the representative point as usually written, and to the methods here.
#pragma once

#include <cstdint>
#include <vector>

#include "measure/kernels/light_kernels.h"

namespace candelabra::app
{

// Specular response with F = 1 of a method, one value per pixel, rows from the top; 0 beside the
// ball.
struct LowRoughnessImage {
    std::string method; // "naive karis" is not among the engine's
    uint32_t size = 0;  // pixels, of a side
    std::vector<float> response;
};

// Naive karis, karis and conic, in this order.
std::vector<LowRoughnessImage> measureLowRoughness(const VulkanContext& context, uint32_t size);

// The images side by side as 8-bit RGB: the light's luminance is white, NaN and infinity are
// magenta.
std::vector<uint8_t> lowRoughnessPicture(const std::vector<LowRoughnessImage>& images);

} // namespace candelabra::app
