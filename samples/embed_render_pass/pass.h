// SPDX-License-Identifier: Apache-2.0
// The G-buffer pass of a renderer that draws in a VkRenderPass.
#pragma once

#include "host.hpp"

// World-space normals (half floats), colour (8 bits), radiance (half floats), depth with stencil.
struct GBuffer {
    HostImage normal, albedo, radiance, depth;
};

struct GBufferPass {
    VkRenderPass renderPass;
    VkFramebuffer framebuffer;
    Raster raster;
};

GBuffer createGBuffer(const Host& host);
void destroyGBuffer(const Host& host, const GBuffer& gbuffer);
GBufferPass createPass(const Host& host, const GBuffer& gbuffer);
void destroyPass(const Host& host, const GBufferPass& pass);
// Records the pass. Its dependencies are all the synchronisation that the images of the G-buffer
// need, before it and after it.
void drawPass(const Host& host, const GBufferPass& pass);
