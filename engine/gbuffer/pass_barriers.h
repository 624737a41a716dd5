// SPDX-License-Identifier: Apache-2.0
// The barriers around the raster pass: its side of the contract in gbuffer.h.
#pragma once

#include "gbuffer/targets.h"
#include "gpu/device.h"

namespace candelabra::gbuffer
{

// Culling may overwrite what earlier draws read.
void waitForEarlierDraws(const gpu::Device& device, VkCommandBuffer cmd) noexcept;
// From any state to attachments, and culling's results to draws.
void prepareAttachments(const gpu::Device& device, VkCommandBuffer cmd,
                        const Attachments& attachments) noexcept;
// To what CndLightingFrame wants.
void handToCompute(const gpu::Device& device, VkCommandBuffer cmd,
                   const Attachments& attachments) noexcept;

} // namespace candelabra::gbuffer
