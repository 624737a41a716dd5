// SPDX-License-Identifier: Apache-2.0
#include "pass.h"

#include <initializer_list>

#include "wall_frag.h"
#include "wall_vert.h"

static constexpr uint32_t colourCount = 3;
static constexpr VkPipelineStageFlags attachmentStages =
    VK_PIPELINE_STAGE_COLOR_ATTACHMENT_OUTPUT_BIT | VK_PIPELINE_STAGE_EARLY_FRAGMENT_TESTS_BIT |
    VK_PIPELINE_STAGE_LATE_FRAGMENT_TESTS_BIT;
static constexpr VkAccessFlags attachmentWrites =
    VK_ACCESS_COLOR_ATTACHMENT_WRITE_BIT | VK_ACCESS_DEPTH_STENCIL_ATTACHMENT_WRITE_BIT;

// In place of the barriers before the G-buffer pass: what Candelabra has read in the previous frame
// may be overwritten, and radiance, which it has written, too.
static constexpr VkSubpassDependency beforePass{
    .srcSubpass = VK_SUBPASS_EXTERNAL,
    .dstSubpass = 0,
    .srcStageMask = VK_PIPELINE_STAGE_COMPUTE_SHADER_BIT,
    .dstStageMask = attachmentStages,
    .srcAccessMask = VK_ACCESS_SHADER_WRITE_BIT,
    .dstAccessMask = attachmentWrites | VK_ACCESS_DEPTH_STENCIL_ATTACHMENT_READ_BIT};
// In place of the barriers after it: compute shaders may read the G-buffer, and add to radiance.
static constexpr VkSubpassDependency afterPass{.srcSubpass = 0,
                                               .dstSubpass = VK_SUBPASS_EXTERNAL,
                                               .srcStageMask = attachmentStages,
                                               .dstStageMask = VK_PIPELINE_STAGE_COMPUTE_SHADER_BIT,
                                               .srcAccessMask = attachmentWrites,
                                               .dstAccessMask = VK_ACCESS_SHADER_READ_BIT |
                                                                VK_ACCESS_SHADER_WRITE_BIT};

GBuffer createGBuffer(const Host& host)
{
    const VkImageUsageFlags colour =
        VK_IMAGE_USAGE_COLOR_ATTACHMENT_BIT | VK_IMAGE_USAGE_SAMPLED_BIT;
    const auto create = [&](VkFormat format, VkImageUsageFlags usage) {
        return createHostImage(&host, format, host.width, host.height, usage);
    };
    return {create(VK_FORMAT_R16G16B16A16_SFLOAT, colour), create(VK_FORMAT_R8G8B8A8_UNORM, colour),
            create(VK_FORMAT_R16G16B16A16_SFLOAT, colour | VK_IMAGE_USAGE_STORAGE_BIT),
            create(VK_FORMAT_D32_SFLOAT_S8_UINT,
                   VK_IMAGE_USAGE_DEPTH_STENCIL_ATTACHMENT_BIT | VK_IMAGE_USAGE_SAMPLED_BIT)};
}

void destroyGBuffer(const Host& host, const GBuffer& gbuffer)
{
    for (const HostImage& image : {gbuffer.normal, gbuffer.albedo, gbuffer.radiance, gbuffer.depth})
        destroyHostImage(&host, image);
}

// Returns an attachment that is cleared, and left in the layout in which Candelabra takes it.
static VkAttachmentDescription attachment(const HostImage& image, VkImageLayout left)
{
    return {.format = image.format,
            .samples = VK_SAMPLE_COUNT_1_BIT,
            .loadOp = VK_ATTACHMENT_LOAD_OP_CLEAR,
            .storeOp = VK_ATTACHMENT_STORE_OP_STORE,
            .stencilLoadOp = VK_ATTACHMENT_LOAD_OP_CLEAR,
            .stencilStoreOp = VK_ATTACHMENT_STORE_OP_STORE,
            .initialLayout = VK_IMAGE_LAYOUT_UNDEFINED,
            .finalLayout = left};
}

static VkRenderPass createRenderPass(VkDevice device, const GBuffer& gbuffer)
{
    const VkAttachmentDescription attachments[] = {
        attachment(gbuffer.normal, VK_IMAGE_LAYOUT_SHADER_READ_ONLY_OPTIMAL),
        attachment(gbuffer.albedo, VK_IMAGE_LAYOUT_SHADER_READ_ONLY_OPTIMAL),
        attachment(gbuffer.radiance, VK_IMAGE_LAYOUT_GENERAL),
        attachment(gbuffer.depth, VK_IMAGE_LAYOUT_DEPTH_STENCIL_READ_ONLY_OPTIMAL)};
    const VkAttachmentReference colours[colourCount] = {
        {0, VK_IMAGE_LAYOUT_COLOR_ATTACHMENT_OPTIMAL},
        {1, VK_IMAGE_LAYOUT_COLOR_ATTACHMENT_OPTIMAL},
        {2, VK_IMAGE_LAYOUT_COLOR_ATTACHMENT_OPTIMAL}};
    // Without the feature separateDepthStencilLayouts, depth and stencil share a layout.
    const VkAttachmentReference depth{3, VK_IMAGE_LAYOUT_DEPTH_STENCIL_ATTACHMENT_OPTIMAL};
    const VkSubpassDescription subpass{.pipelineBindPoint = VK_PIPELINE_BIND_POINT_GRAPHICS,
                                       .colorAttachmentCount = colourCount,
                                       .pColorAttachments = colours,
                                       .pDepthStencilAttachment = &depth};
    const VkSubpassDependency dependencies[] = {beforePass, afterPass};
    const VkRenderPassCreateInfo info{.sType = VK_STRUCTURE_TYPE_RENDER_PASS_CREATE_INFO,
                                      .attachmentCount = 4,
                                      .pAttachments = attachments,
                                      .subpassCount = 1,
                                      .pSubpasses = &subpass,
                                      .dependencyCount = 2,
                                      .pDependencies = dependencies};
    VkRenderPass pass{};
    checkVulkan(vkCreateRenderPass(device, &info, nullptr, &pass), "vkCreateRenderPass failed");
    return pass;
}

GBufferPass createPass(const Host& host, const GBuffer& gbuffer)
{
    GBufferPass pass{.renderPass = createRenderPass(host.device, gbuffer)};
    // As an attachment, the view of the depth aspect stands for stencil too.
    const VkImageView views[] = {gbuffer.normal.view, gbuffer.albedo.view, gbuffer.radiance.view,
                                 gbuffer.depth.view};
    const VkFramebufferCreateInfo framebuffer{.sType = VK_STRUCTURE_TYPE_FRAMEBUFFER_CREATE_INFO,
                                              .renderPass = pass.renderPass,
                                              .attachmentCount = 4,
                                              .pAttachments = views,
                                              .width = host.width,
                                              .height = host.height,
                                              .layers = 1};
    checkVulkan(vkCreateFramebuffer(host.device, &framebuffer, nullptr, &pass.framebuffer),
                "vkCreateFramebuffer failed");
    const VkFormat colours[] = {gbuffer.normal.format, gbuffer.albedo.format,
                                gbuffer.radiance.format};
    pass.raster = createRaster(host.device, {.vertex = wall_vert,
                                             .fragment = wall_frag,
                                             .depthTest = VK_COMPARE_OP_GREATER, // reversed depth
                                             .colours = colours,
                                             .renderPass = pass.renderPass});
    return pass;
}

void destroyPass(const Host& host, const GBufferPass& pass)
{
    destroyRaster(host.device, pass.raster);
    vkDestroyFramebuffer(host.device, pass.framebuffer, nullptr);
    vkDestroyRenderPass(host.device, pass.renderPass, nullptr);
}

void drawPass(const Host& host, const GBufferPass& pass)
{
    const VkClearValue clears[4] = {}; // depth is reversed, so that 0 is far away
    const VkRenderPassBeginInfo begin{.sType = VK_STRUCTURE_TYPE_RENDER_PASS_BEGIN_INFO,
                                      .renderPass = pass.renderPass,
                                      .framebuffer = pass.framebuffer,
                                      .renderArea = {{0, 0}, {host.width, host.height}},
                                      .clearValueCount = 4,
                                      .pClearValues = clears};
    vkCmdBeginRenderPass(host.cmd, &begin, VK_SUBPASS_CONTENTS_INLINE);
    bindRaster(host.cmd, pass.raster, {host.width, host.height});
    vkCmdDraw(host.cmd, 3, 1, 0, 0);
    vkCmdEndRenderPass(host.cmd);
}
