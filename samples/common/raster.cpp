// SPDX-License-Identifier: Apache-2.0
#include <vector>

#include "host.hpp"

static VkPipelineShaderStageCreateInfo createStage(VkDevice device, VkShaderStageFlagBits stage,
                                                   std::span<const uint32_t> words)
{
    const VkShaderModuleCreateInfo info{.sType = VK_STRUCTURE_TYPE_SHADER_MODULE_CREATE_INFO,
                                        .codeSize = words.size_bytes(),
                                        .pCode = words.data()};
    VkPipelineShaderStageCreateInfo result{.sType =
                                               VK_STRUCTURE_TYPE_PIPELINE_SHADER_STAGE_CREATE_INFO,
                                           .stage = stage,
                                           .pName = "main"};
    checkVulkan(vkCreateShaderModule(device, &info, nullptr, &result.module), "creating a shader");
    return result;
}

Raster createRaster(VkDevice device, const RasterDesc& desc)
{
    Raster raster{};
    const VkPipelineLayoutCreateInfo layout{.sType = VK_STRUCTURE_TYPE_PIPELINE_LAYOUT_CREATE_INFO,
                                            .setLayoutCount = desc.setLayout ? 1u : 0u,
                                            .pSetLayouts = &desc.setLayout,
                                            .pushConstantRangeCount = desc.constants.size ? 1u : 0u,
                                            .pPushConstantRanges = &desc.constants};
    checkVulkan(vkCreatePipelineLayout(device, &layout, nullptr, &raster.layout),
                "creating a pipeline layout");
    std::vector stages{createStage(device, VK_SHADER_STAGE_VERTEX_BIT, desc.vertex)};
    if (!desc.fragment.empty())
        stages.push_back(createStage(device, VK_SHADER_STAGE_FRAGMENT_BIT, desc.fragment));

    const VkVertexInputBindingDescription buffer{0, desc.vertexBytes, VK_VERTEX_INPUT_RATE_VERTEX};
    const VkPipelineVertexInputStateCreateInfo vertices{
        .sType = VK_STRUCTURE_TYPE_PIPELINE_VERTEX_INPUT_STATE_CREATE_INFO,
        .vertexBindingDescriptionCount = desc.vertexBytes ? 1u : 0u,
        .pVertexBindingDescriptions = &buffer,
        .vertexAttributeDescriptionCount = uint32_t(desc.attributes.size()),
        .pVertexAttributeDescriptions = desc.attributes.data()};
    const VkPipelineInputAssemblyStateCreateInfo assembly{
        .sType = VK_STRUCTURE_TYPE_PIPELINE_INPUT_ASSEMBLY_STATE_CREATE_INFO,
        .topology = desc.topology};
    const VkPipelineViewportStateCreateInfo viewport{
        .sType = VK_STRUCTURE_TYPE_PIPELINE_VIEWPORT_STATE_CREATE_INFO,
        .viewportCount = 1,
        .scissorCount = 1};
    const VkPipelineRasterizationStateCreateInfo rasterization{
        .sType = VK_STRUCTURE_TYPE_PIPELINE_RASTERIZATION_STATE_CREATE_INFO,
        .cullMode = desc.cullMode,
        .frontFace = VK_FRONT_FACE_COUNTER_CLOCKWISE,
        .lineWidth = 1};
    const VkPipelineMultisampleStateCreateInfo samples{
        .sType = VK_STRUCTURE_TYPE_PIPELINE_MULTISAMPLE_STATE_CREATE_INFO,
        .rasterizationSamples = VK_SAMPLE_COUNT_1_BIT};
    const VkPipelineDepthStencilStateCreateInfo depth{
        .sType = VK_STRUCTURE_TYPE_PIPELINE_DEPTH_STENCIL_STATE_CREATE_INFO,
        .depthTestEnable = VK_TRUE,
        .depthWriteEnable = desc.depthWrite,
        .depthCompareOp = desc.depthTest};
    const std::vector blends(desc.colours.size(), desc.blend);
    const VkPipelineColorBlendStateCreateInfo blend{
        .sType = VK_STRUCTURE_TYPE_PIPELINE_COLOR_BLEND_STATE_CREATE_INFO,
        .attachmentCount = uint32_t(blends.size()),
        .pAttachments = blends.data()};
    constexpr VkDynamicState states[] = {VK_DYNAMIC_STATE_VIEWPORT, VK_DYNAMIC_STATE_SCISSOR};
    const VkPipelineDynamicStateCreateInfo dynamic{
        .sType = VK_STRUCTURE_TYPE_PIPELINE_DYNAMIC_STATE_CREATE_INFO,
        .dynamicStateCount = 2,
        .pDynamicStates = states};
    const VkPipelineRenderingCreateInfo rendering{
        .sType = VK_STRUCTURE_TYPE_PIPELINE_RENDERING_CREATE_INFO,
        .colorAttachmentCount = uint32_t(desc.colours.size()),
        .pColorAttachmentFormats = desc.colours.data(),
        .depthAttachmentFormat = desc.depth};
    const VkGraphicsPipelineCreateInfo info{.sType =
                                                VK_STRUCTURE_TYPE_GRAPHICS_PIPELINE_CREATE_INFO,
                                            .pNext = desc.renderPass ? nullptr : &rendering,
                                            .stageCount = uint32_t(stages.size()),
                                            .pStages = stages.data(),
                                            .pVertexInputState = &vertices,
                                            .pInputAssemblyState = &assembly,
                                            .pViewportState = &viewport,
                                            .pRasterizationState = &rasterization,
                                            .pMultisampleState = &samples,
                                            .pDepthStencilState = &depth,
                                            .pColorBlendState = &blend,
                                            .pDynamicState = &dynamic,
                                            .layout = raster.layout,
                                            .renderPass = desc.renderPass};
    checkVulkan(
        vkCreateGraphicsPipelines(device, VK_NULL_HANDLE, 1, &info, nullptr, &raster.pipeline),
        "creating a pipeline");
    for (const VkPipelineShaderStageCreateInfo& stage : stages)
        vkDestroyShaderModule(device, stage.module, nullptr);
    return raster;
}

void destroyRaster(VkDevice device, const Raster& raster)
{
    vkDestroyPipeline(device, raster.pipeline, nullptr);
    vkDestroyPipelineLayout(device, raster.layout, nullptr);
}

void bindRaster(VkCommandBuffer cmd, const Raster& raster, VkExtent2D size)
{
    const VkViewport viewport{0, 0, float(size.width), float(size.height), 0, 1};
    const VkRect2D all{{0, 0}, size};
    vkCmdBindPipeline(cmd, VK_PIPELINE_BIND_POINT_GRAPHICS, raster.pipeline);
    vkCmdSetViewport(cmd, 0, 1, &viewport);
    vkCmdSetScissor(cmd, 0, 1, &all);
}

void beginRaster(VkCommandBuffer cmd, const Raster& raster, VkExtent2D size,
                 std::span<const VkRenderingAttachmentInfo> colours,
                 const VkRenderingAttachmentInfo& depth)
{
    const VkRenderingInfo rendering{.sType = VK_STRUCTURE_TYPE_RENDERING_INFO,
                                    .renderArea = {{0, 0}, size},
                                    .layerCount = 1,
                                    .colorAttachmentCount = uint32_t(colours.size()),
                                    .pColorAttachments = colours.data(),
                                    .pDepthAttachment = &depth};
    vkCmdBeginRendering(cmd, &rendering);
    bindRaster(cmd, raster, size);
}
