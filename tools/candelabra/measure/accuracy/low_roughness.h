// SPDX-License-Identifier: Apache-2.0
// Shows a sphere light mirrored by a nearly smooth ball (perceptual roughness 0.01): the effect of
// float32 on the representative point as it is usually written, and on the engine's methods.
#pragma once

#include <cstdint>
#include <vector>

#include "measure/kernels/light_kernels.h"

namespace candelabra::app
{

// The specular response of a method with F = 1, one value per pixel, rows from the top. Pixels
// beside the ball hold 0.
struct LowRoughnessImage {
    std::string method; // "naive karis" is not a method of the engine
    uint32_t size = 0;  // pixels a side
    std::vector<float> response;
};

// Returns the images of naive karis, karis and conic, in this order.
std::vector<LowRoughnessImage> measureLowRoughness(const VulkanContext& context, uint32_t size);

// Returns the images side by side as 8-bit RGB. A response equal to the light's luminance is white;
// NaN and infinity are magenta.
std::vector<uint8_t> lowRoughnessPicture(const std::vector<LowRoughnessImage>& images);

} // namespace candelabra::app
