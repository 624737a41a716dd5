// SPDX-License-Identifier: Apache-2.0
// The barriers around the raster pass, which implement what gbuffer.h promises on entry and exit.
#pragma once

#include "gbuffer/targets.h"
#include "gpu/device.h"

namespace candelabra::gbuffer
{

// Makes culling, which overwrites draw data, wait for earlier draws that read it.
void waitForEarlierDraws(const gpu::Device& device, VkCommandBuffer cmd) noexcept;
// Moves the attachments from any state to attachment layouts, and makes culling results visible to
// draws.
void prepareAttachments(const gpu::Device& device, VkCommandBuffer cmd,
                        const Attachments& attachments) noexcept;
// Makes what was drawn visible to further draws into the same attachments.
void betweenDraws(const gpu::Device& device, VkCommandBuffer cmd) noexcept;
// Moves the attachments to the state that CndLightingFrame requires.
void handToCompute(const gpu::Device& device, VkCommandBuffer cmd,
                   const Attachments& attachments) noexcept;

} // namespace candelabra::gbuffer
