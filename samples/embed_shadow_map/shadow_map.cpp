// SPDX-License-Identifier: Apache-2.0
#include "shadow_map.h"

#include "bar_vert.h"

struct BarParameters {
    float clipFromWorld[16];
    Bar bar;
    float z;
};

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
    const VkDescriptorImageInfo image{map.sampler, map.depth.view, sampledRead.layout};
    const VkDescriptorBufferInfo buffer{map.buffer.buffer, 0, VK_WHOLE_SIZE};
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

ShadowMap createShadowMap(const Host& host)
{
    ShadowMap map{
        .depth = createHostImage(&host, VK_FORMAT_D32_SFLOAT, shadowMapSize, shadowMapSize,
                                 VK_IMAGE_USAGE_DEPTH_STENCIL_ATTACHMENT_BIT |
                                     VK_IMAGE_USAGE_SAMPLED_BIT),
        .sampler = createSampler(host.device),
        .buffer =
            createHostBuffer(&host, sizeof(ShadowParameters), VK_BUFFER_USAGE_UNIFORM_BUFFER_BIT),
        .raster = createRaster(host.device,
                               {.vertex = bar_vert,
                                .constants = {VK_SHADER_STAGE_VERTEX_BIT, 0, sizeof(BarParameters)},
                                .topology = VK_PRIMITIVE_TOPOLOGY_TRIANGLE_STRIP})};
    map.parameters = static_cast<ShadowParameters*>(map.buffer.mapped);
    createSet(host, map);
    return map;
}

void destroyShadowMap(const Host& host, const ShadowMap& map)
{
    destroyRaster(host.device, map.raster);
    vkDestroyDescriptorPool(host.device, map.pool, nullptr);
    vkDestroyDescriptorSetLayout(host.device, map.setLayout, nullptr);
    destroyHostBuffer(&host, map.buffer);
    vkDestroySampler(host.device, map.sampler, nullptr);
    destroyHostImage(&host, map.depth);
}

void drawShadowMap(const Host& host, const ShadowMap& map)
{
    imageBarrier(host.cmd, &map.depth, overwritten, depthAttachment);
    beginRaster(host.cmd, map.raster, {shadowMapSize, shadowMapSize}, {},
                attachment(map.depth, depthAttachment.layout, VK_ATTACHMENT_LOAD_OP_CLEAR,
                           VK_ATTACHMENT_STORE_OP_STORE, {.depthStencil = {.depth = 1}}));
    for (const Bar& bar : bars) {
        BarParameters parameters{.bar = bar, .z = frameZ};
        for (int i = 0; i < 16; ++i)
            parameters.clipFromWorld[i] = map.parameters->shadowFromView[i];
        vkCmdPushConstants(host.cmd, map.raster.layout, VK_SHADER_STAGE_VERTEX_BIT, 0,
                           sizeof parameters, &parameters);
        vkCmdDraw(host.cmd, 4, 1, 0, 0);
    }
    vkCmdEndRendering(host.cmd);
    imageBarrier(host.cmd, &map.depth, depthAttachment, sampledRead);
}
