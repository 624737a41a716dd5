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

template <size_t Count>
static VkShaderModule createShader(VkDevice device, const uint32_t (&words)[Count])
{
    const VkShaderModuleCreateInfo info{.sType = VK_STRUCTURE_TYPE_SHADER_MODULE_CREATE_INFO,
                                        .codeSize = sizeof words,
                                        .pCode = words};
    VkShaderModule shader{};
    checkVulkan(vkCreateShaderModule(device, &info, nullptr, &shader),
                "vkCreateShaderModule failed");
    return shader;
}

static VkPipeline createPipeline(const Host& host, const GBufferPass& pass)
{
    const VkShaderModule vertex = createShader(host.device, wall_vert);
    const VkShaderModule fragment = createShader(host.device, wall_frag);
    const VkPipelineShaderStageCreateInfo stages[] = {
        {.sType = VK_STRUCTURE_TYPE_PIPELINE_SHADER_STAGE_CREATE_INFO,
         .stage = VK_SHADER_STAGE_VERTEX_BIT,
         .module = vertex,
         .pName = "main"},
        {.sType = VK_STRUCTURE_TYPE_PIPELINE_SHADER_STAGE_CREATE_INFO,
         .stage = VK_SHADER_STAGE_FRAGMENT_BIT,
         .module = fragment,
         .pName = "main"}};
    const VkPipelineVertexInputStateCreateInfo input{
        .sType = VK_STRUCTURE_TYPE_PIPELINE_VERTEX_INPUT_STATE_CREATE_INFO};
    const VkPipelineInputAssemblyStateCreateInfo assembly{
        .sType = VK_STRUCTURE_TYPE_PIPELINE_INPUT_ASSEMBLY_STATE_CREATE_INFO,
        .topology = VK_PRIMITIVE_TOPOLOGY_TRIANGLE_LIST};
    const VkViewport area{0, 0, float(host.width), float(host.height), 0, 1};
    const VkRect2D all{{0, 0}, {host.width, host.height}};
    const VkPipelineViewportStateCreateInfo viewport{
        .sType = VK_STRUCTURE_TYPE_PIPELINE_VIEWPORT_STATE_CREATE_INFO,
        .viewportCount = 1,
        .pViewports = &area,
        .scissorCount = 1,
        .pScissors = &all};
    const VkPipelineRasterizationStateCreateInfo raster{
        .sType = VK_STRUCTURE_TYPE_PIPELINE_RASTERIZATION_STATE_CREATE_INFO, .lineWidth = 1};
    const VkPipelineMultisampleStateCreateInfo samples{
        .sType = VK_STRUCTURE_TYPE_PIPELINE_MULTISAMPLE_STATE_CREATE_INFO,
        .rasterizationSamples = VK_SAMPLE_COUNT_1_BIT};
    const VkPipelineDepthStencilStateCreateInfo depth{
        .sType = VK_STRUCTURE_TYPE_PIPELINE_DEPTH_STENCIL_STATE_CREATE_INFO,
        .depthTestEnable = VK_TRUE,
        .depthWriteEnable = VK_TRUE,
        .depthCompareOp = VK_COMPARE_OP_GREATER}; // reversed depth
    const VkPipelineColorBlendAttachmentState written{.colorWriteMask = 0xF};
    const VkPipelineColorBlendAttachmentState colours[colourCount] = {written, written, written};
    const VkPipelineColorBlendStateCreateInfo blend{
        .sType = VK_STRUCTURE_TYPE_PIPELINE_COLOR_BLEND_STATE_CREATE_INFO,
        .attachmentCount = colourCount,
        .pAttachments = colours};
    const VkGraphicsPipelineCreateInfo info{.sType =
                                                VK_STRUCTURE_TYPE_GRAPHICS_PIPELINE_CREATE_INFO,
                                            .stageCount = 2,
                                            .pStages = stages,
                                            .pVertexInputState = &input,
                                            .pInputAssemblyState = &assembly,
                                            .pViewportState = &viewport,
                                            .pRasterizationState = &raster,
                                            .pMultisampleState = &samples,
                                            .pDepthStencilState = &depth,
                                            .pColorBlendState = &blend,
                                            .layout = pass.layout,
                                            .renderPass = pass.renderPass};
    VkPipeline pipeline{};
    checkVulkan(
        vkCreateGraphicsPipelines(host.device, VK_NULL_HANDLE, 1, &info, nullptr, &pipeline),
        "vkCreateGraphicsPipelines failed");
    vkDestroyShaderModule(host.device, vertex, nullptr);
    vkDestroyShaderModule(host.device, fragment, nullptr);
    return pipeline;
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
    const VkPipelineLayoutCreateInfo layout{.sType = VK_STRUCTURE_TYPE_PIPELINE_LAYOUT_CREATE_INFO};
    checkVulkan(vkCreatePipelineLayout(host.device, &layout, nullptr, &pass.layout),
                "vkCreatePipelineLayout failed");
    pass.pipeline = createPipeline(host, pass);
    return pass;
}

void destroyPass(const Host& host, const GBufferPass& pass)
{
    vkDestroyPipeline(host.device, pass.pipeline, nullptr);
    vkDestroyPipelineLayout(host.device, pass.layout, nullptr);
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
    vkCmdBindPipeline(host.cmd, VK_PIPELINE_BIND_POINT_GRAPHICS, pass.pipeline);
    vkCmdDraw(host.cmd, 3, 1, 0, 0);
    vkCmdEndRenderPass(host.cmd);
}
