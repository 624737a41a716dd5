// SPDX-License-Identifier: Apache-2.0
// A host that draws a small scene into a G-buffer of its own in the ways in which real hosts do: by
// dynamic rendering or in a render pass, with several kinds of depth, in a right-handed or a
// mirrored world.
#pragma once

#include <array>
#include <vector>

#include <glm/glm.hpp>

#include "gpu/kernel.h"
#include "harness/gpu_fixture.h"

namespace candelabra::test
{

enum class HostPass { DynamicRendering, RenderPass };
// The content of the depth image, and the projection with which the scene is drawn.
enum class HostDepth {
    Reversed, // with an infinite far plane
    Standard, // 0 at the near plane, 1 at the far one
    OpenGl,   // the clip space of OpenGL: depth -1..1, y up, and a viewport of negative height
    Linear,
    PositionView,
    PositionWorld
};
// The world of the host, against that of the native path: right-handed, y up.
enum class HostWorld {
    RightHanded,
    YDown,     // y points down, in the world and in view space
    LeftHanded // z is negated, in the world and in view space, which looks along +z
};

struct HostCase {
    HostPass pass = HostPass::DynamicRendering;
    HostDepth depth = HostDepth::Reversed;
    HostWorld world = HostWorld::RightHanded;
    bool native = false; // the layout CND_GBUFFER_FULL instead of the host's own
};

// Returns the host's description of its G-buffer for the module.
CndGBufferDesc gbufferOf(const HostCase& host);
// The lights of the scene, in the host's world: a sphere, a rectangle that emits from its front
// alone, and a spot. With `turned`, the rectangle faces the other way.
std::vector<CndLight> lightsOf(const HostCase& host, bool turned = false);

class RasterHost
{
public:
    RasterHost(const gpu::Device& device, const HostCase& host, uint32_t width, uint32_t height);
    ~RasterHost();
    RasterHost(const RasterHost&) = delete;
    RasterHost& operator=(const RasterHost&) = delete;

    // Records the drawing of the scene, after which compute shaders can read the images, in the
    // layouts that frame() names.
    void draw(VkCommandBuffer cmd) const;
    // Returns a frame with this host's images and camera, without radiance and specular method.
    CndLightingFrame frame() const;

private:
    void createRenderPass();
    void createPipeline();
    void drawDynamic(VkCommandBuffer cmd) const;
    void drawInRenderPass(VkCommandBuffer cmd) const;
    void drawWalls(VkCommandBuffer cmd) const;
    std::array<VkClearValue, 4> clearValues() const;

    const gpu::Device& device_;
    HostCase case_;
    uint32_t width_, height_;
    std::array<gpu::Image, 3> colour_;
    gpu::Image depth_; // with stencil in a render pass; the view is of the depth aspect
    gpu::Buffer scene_;
    gpu::Bindings bindings_;
    gpu::Handle<VkPipelineLayout> layout_;
    gpu::Handle<VkPipeline> pipeline_;
    VkRenderPass renderPass_ = VK_NULL_HANDLE;
    VkFramebuffer framebuffer_ = VK_NULL_HANDLE;
};

} // namespace candelabra::test
