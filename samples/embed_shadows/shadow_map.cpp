// SPDX-License-Identifier: Apache-2.0
#include "shadow_map.h"

#include "bar_vert.h"

struct BarParameters {
    float clipFromWorld[16];
    Bar bar;
    float z;
};

static constexpr VkFormat depthFormat = VK_FORMAT_D32_SFLOAT;
static constexpr ImageUse undefined{VK_IMAGE_LAYOUT_UNDEFINED,
                                    VK_PIPELINE_STAGE_2_COMPUTE_SHADER_BIT, 0};
static constexpr ImageUse drawn{
    VK_IMAGE_LAYOUT_DEPTH_ATTACHMENT_OPTIMAL,
    VK_PIPELINE_STAGE_2_EARLY_FRAGMENT_TESTS_BIT | VK_PIPELINE_STAGE_2_LATE_FRAGMENT_TESTS_BIT,
    VK_ACCESS_2_DEPTH_STENCIL_ATTACHMENT_READ_BIT | VK_ACCESS_2_DEPTH_STENCIL_ATTACHMENT_WRITE_BIT};
static constexpr ImageUse compared{VK_IMAGE_LAYOUT_SHADER_READ_ONLY_OPTIMAL,
                                   VK_PIPELINE_STAGE_2_COMPUTE_SHADER_BIT,
                                   VK_ACCESS_2_SHADER_SAMPLED_READ_BIT};

// Outside the map everything is lit.
static VkSampler createSampler(VkDevice device)
{
    const VkSamplerCreateInfo info{.sType = VK_STRUCTURE_TYPE_SAMPLER_CREATE_INFO,
                                   .addressModeU = VK_SAMPLER_ADDRESS_MODE_CLAMP_TO_BORDER,
                                   .addressModeV = VK_SAMPLER_ADDRESS_MODE_CLAMP_TO_BORDER,
                                   .addressModeW = VK_SAMPLER_ADDRESS_MODE_CLAMP_TO_BORDER,
                                   .compareEnable = VK_TRUE,
                                   .compareOp = VK_COMPARE_OP_LESS_OR_EQUAL,
                                   .borderColor = VK_BORDER_COLOR_FLOAT_OPAQUE_WHITE};
    VkSampler sampler{};
    checkVulkan(vkCreateSampler(device, &info, nullptr, &sampler), "vkCreateSampler failed");
    return sampler;
}

static void createParameters(const Host& host, ShadowMap& map)
{
    const VkBufferCreateInfo info{.sType = VK_STRUCTURE_TYPE_BUFFER_CREATE_INFO,
                                  .size = sizeof(ShadowParameters),
                                  .usage = VK_BUFFER_USAGE_UNIFORM_BUFFER_BIT};
    checkVulkan(vkCreateBuffer(host.device, &info, nullptr, &map.buffer), "vkCreateBuffer failed");
    VkMemoryRequirements needs;
    vkGetBufferMemoryRequirements(host.device, map.buffer, &needs);
    map.memory = allocateHostMemory(
        &host, needs, VK_MEMORY_PROPERTY_HOST_VISIBLE_BIT | VK_MEMORY_PROPERTY_HOST_COHERENT_BIT);
    checkVulkan(vkBindBufferMemory(host.device, map.buffer, map.memory, 0),
                "vkBindBufferMemory failed");
    void* mapped = nullptr;
    checkVulkan(vkMapMemory(host.device, map.memory, 0, VK_WHOLE_SIZE, 0, &mapped),
                "vkMapMemory failed");
    map.parameters = static_cast<ShadowParameters*>(mapped);
}

// Descriptor set 1 of the kernels: its bindings have the compute stage.
static void createSet(const Host& host, ShadowMap& map)
{
    const VkDescriptorSetLayoutBinding bindings[] = {
        {0, VK_DESCRIPTOR_TYPE_COMBINED_IMAGE_SAMPLER, 1, VK_SHADER_STAGE_COMPUTE_BIT, nullptr},
        {1, VK_DESCRIPTOR_TYPE_UNIFORM_BUFFER, 1, VK_SHADER_STAGE_COMPUTE_BIT, nullptr}};
    const VkDescriptorSetLayoutCreateInfo layout{
        .sType = VK_STRUCTURE_TYPE_DESCRIPTOR_SET_LAYOUT_CREATE_INFO,
        .bindingCount = 2,
        .pBindings = bindings};
    checkVulkan(vkCreateDescriptorSetLayout(host.device, &layout, nullptr, &map.setLayout),
                "vkCreateDescriptorSetLayout failed");
    const VkDescriptorPoolSize sizes[] = {{VK_DESCRIPTOR_TYPE_COMBINED_IMAGE_SAMPLER, 1},
                                          {VK_DESCRIPTOR_TYPE_UNIFORM_BUFFER, 1}};
    const VkDescriptorPoolCreateInfo pool{.sType = VK_STRUCTURE_TYPE_DESCRIPTOR_POOL_CREATE_INFO,
                                          .maxSets = 1,
                                          .poolSizeCount = 2,
                                          .pPoolSizes = sizes};
    checkVulkan(vkCreateDescriptorPool(host.device, &pool, nullptr, &map.pool),
                "vkCreateDescriptorPool failed");
    const VkDescriptorSetAllocateInfo allocation{.sType =
                                                     VK_STRUCTURE_TYPE_DESCRIPTOR_SET_ALLOCATE_INFO,
                                                 .descriptorPool = map.pool,
                                                 .descriptorSetCount = 1,
                                                 .pSetLayouts = &map.setLayout};
    checkVulkan(vkAllocateDescriptorSets(host.device, &allocation, &map.set),
                "vkAllocateDescriptorSets failed");
    const VkDescriptorImageInfo image{map.sampler, map.depth.view, compared.layout};
    const VkDescriptorBufferInfo buffer{map.buffer, 0, VK_WHOLE_SIZE};
    const VkWriteDescriptorSet writes[] = {
        {.sType = VK_STRUCTURE_TYPE_WRITE_DESCRIPTOR_SET,
         .dstSet = map.set,
         .dstBinding = 0,
         .descriptorCount = 1,
         .descriptorType = VK_DESCRIPTOR_TYPE_COMBINED_IMAGE_SAMPLER,
         .pImageInfo = &image},
        {.sType = VK_STRUCTURE_TYPE_WRITE_DESCRIPTOR_SET,
         .dstSet = map.set,
         .dstBinding = 1,
         .descriptorCount = 1,
         .descriptorType = VK_DESCRIPTOR_TYPE_UNIFORM_BUFFER,
         .pBufferInfo = &buffer}};
    vkUpdateDescriptorSets(host.device, 2, writes, 0, nullptr);
}

static void createPipeline(const Host& host, ShadowMap& map)
{
    const VkPushConstantRange constants{VK_SHADER_STAGE_VERTEX_BIT, 0, sizeof(BarParameters)};
    const VkPipelineLayoutCreateInfo layout{.sType = VK_STRUCTURE_TYPE_PIPELINE_LAYOUT_CREATE_INFO,
                                            .pushConstantRangeCount = 1,
                                            .pPushConstantRanges = &constants};
    checkVulkan(vkCreatePipelineLayout(host.device, &layout, nullptr, &map.layout),
                "vkCreatePipelineLayout failed");
    const VkShaderModuleCreateInfo code{.sType = VK_STRUCTURE_TYPE_SHADER_MODULE_CREATE_INFO,
                                        .codeSize = sizeof bar_vert,
                                        .pCode = bar_vert};
    VkShaderModule vertex{};
    checkVulkan(vkCreateShaderModule(host.device, &code, nullptr, &vertex),
                "vkCreateShaderModule failed");
    const VkPipelineShaderStageCreateInfo stage{
        .sType = VK_STRUCTURE_TYPE_PIPELINE_SHADER_STAGE_CREATE_INFO,
        .stage = VK_SHADER_STAGE_VERTEX_BIT,
        .module = vertex,
        .pName = "main"};
    const VkPipelineVertexInputStateCreateInfo input{
        .sType = VK_STRUCTURE_TYPE_PIPELINE_VERTEX_INPUT_STATE_CREATE_INFO};
    const VkPipelineInputAssemblyStateCreateInfo assembly{
        .sType = VK_STRUCTURE_TYPE_PIPELINE_INPUT_ASSEMBLY_STATE_CREATE_INFO,
        .topology = VK_PRIMITIVE_TOPOLOGY_TRIANGLE_STRIP};
    const VkViewport area{0, 0, float(shadowMapSize), float(shadowMapSize), 0, 1};
    const VkRect2D all{{0, 0}, {shadowMapSize, shadowMapSize}};
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
        .depthCompareOp = VK_COMPARE_OP_LESS};
    const VkPipelineRenderingCreateInfo rendering{
        .sType = VK_STRUCTURE_TYPE_PIPELINE_RENDERING_CREATE_INFO,
        .depthAttachmentFormat = depthFormat};
    const VkGraphicsPipelineCreateInfo info{.sType =
                                                VK_STRUCTURE_TYPE_GRAPHICS_PIPELINE_CREATE_INFO,
                                            .pNext = &rendering,
                                            .stageCount = 1,
                                            .pStages = &stage,
                                            .pVertexInputState = &input,
                                            .pInputAssemblyState = &assembly,
                                            .pViewportState = &viewport,
                                            .pRasterizationState = &raster,
                                            .pMultisampleState = &samples,
                                            .pDepthStencilState = &depth,
                                            .layout = map.layout};
    checkVulkan(
        vkCreateGraphicsPipelines(host.device, VK_NULL_HANDLE, 1, &info, nullptr, &map.pipeline),
        "vkCreateGraphicsPipelines failed");
    vkDestroyShaderModule(host.device, vertex, nullptr);
}

ShadowMap createShadowMap(const Host& host)
{
    ShadowMap map{.depth = createHostImage(&host, depthFormat, shadowMapSize, shadowMapSize,
                                           VK_IMAGE_USAGE_DEPTH_STENCIL_ATTACHMENT_BIT |
                                               VK_IMAGE_USAGE_SAMPLED_BIT),
                  .sampler = createSampler(host.device)};
    createParameters(host, map);
    createSet(host, map);
    createPipeline(host, map);
    return map;
}

void destroyShadowMap(const Host& host, const ShadowMap& map)
{
    vkDestroyPipeline(host.device, map.pipeline, nullptr);
    vkDestroyPipelineLayout(host.device, map.layout, nullptr);
    vkDestroyDescriptorPool(host.device, map.pool, nullptr);
    vkDestroyDescriptorSetLayout(host.device, map.setLayout, nullptr);
    vkDestroyBuffer(host.device, map.buffer, nullptr);
    vkFreeMemory(host.device, map.memory, nullptr);
    vkDestroySampler(host.device, map.sampler, nullptr);
    destroyHostImage(&host, map.depth);
}

void drawShadowMap(const Host& host, const ShadowMap& map)
{
    imageBarrier(host.cmd, &map.depth, undefined, drawn);
    const VkRenderingAttachmentInfo depth{.sType = VK_STRUCTURE_TYPE_RENDERING_ATTACHMENT_INFO,
                                          .imageView = map.depth.view,
                                          .imageLayout = drawn.layout,
                                          .loadOp = VK_ATTACHMENT_LOAD_OP_CLEAR,
                                          .storeOp = VK_ATTACHMENT_STORE_OP_STORE,
                                          .clearValue = {.depthStencil = {.depth = 1}}};
    const VkRenderingInfo rendering{.sType = VK_STRUCTURE_TYPE_RENDERING_INFO,
                                    .renderArea = {{0, 0}, {shadowMapSize, shadowMapSize}},
                                    .layerCount = 1,
                                    .pDepthAttachment = &depth};
    vkCmdBeginRendering(host.cmd, &rendering);
    vkCmdBindPipeline(host.cmd, VK_PIPELINE_BIND_POINT_GRAPHICS, map.pipeline);
    for (const Bar& bar : bars) {
        BarParameters parameters{.bar = bar, .z = frameZ};
        for (int i = 0; i < 16; ++i)
            parameters.clipFromWorld[i] = map.parameters->shadowFromView[i];
        vkCmdPushConstants(host.cmd, map.layout, VK_SHADER_STAGE_VERTEX_BIT, 0, sizeof parameters,
                           &parameters);
        vkCmdDraw(host.cmd, 4, 1, 0, 0);
    }
    vkCmdEndRendering(host.cmd);
    imageBarrier(host.cmd, &map.depth, drawn, compared);
}
