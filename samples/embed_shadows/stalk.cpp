// SPDX-License-Identifier: Apache-2.0
#include "stalk.h"

#include <cmath>

#include "stalk_comp.h"

constexpr uint32_t sides = 12, rings = 24, vertexCount = sides * (rings + 1);
constexpr float length = 1.8f, radius = 0.22f;

struct StalkPush {
    uint32_t count, sides, rings;
    float length, radius, bend;
};

// Returns the stalk that the shader writes for a bend of 0.
Mesh straightStalk()
{
    Mesh mesh;
    for (uint32_t i = 0; i < vertexCount; ++i) {
        const float along = float(i / sides) / float(rings);
        const float around = 6.2831853f * float(i % sides) / float(sides);
        const glm::vec3 normal(std::cos(around), 0, std::sin(around));
        mesh.vertices.push_back(
            {glm::vec3(0, length * along, 0) + radius * (1 - along) * normal, normal});
    }
    for (uint32_t i = 0; i < sides * rings; ++i) {
        const uint32_t next = i % sides == sides - 1 ? i + 1 - sides : i + 1;
        for (const uint32_t corner : {i, next, i + sides, i + sides, next, next + sides})
            mesh.indices.push_back(corner);
    }
    return mesh;
}

StalkBender::StalkBender(const Host& host, VkBuffer vertices) : device_(host.device)
{
    const VkDescriptorSetLayoutBinding binding{0, VK_DESCRIPTOR_TYPE_STORAGE_BUFFER, 1,
                                               VK_SHADER_STAGE_COMPUTE_BIT, nullptr};
    const VkDescriptorSetLayoutCreateInfo setLayout{
        .sType = VK_STRUCTURE_TYPE_DESCRIPTOR_SET_LAYOUT_CREATE_INFO,
        .bindingCount = 1,
        .pBindings = &binding};
    checkVulkan(vkCreateDescriptorSetLayout(device_, &setLayout, nullptr, &setLayout_),
                "creating a set layout");
    const VkDescriptorPoolSize size{VK_DESCRIPTOR_TYPE_STORAGE_BUFFER, 1};
    const VkDescriptorPoolCreateInfo pool{.sType = VK_STRUCTURE_TYPE_DESCRIPTOR_POOL_CREATE_INFO,
                                          .maxSets = 1,
                                          .poolSizeCount = 1,
                                          .pPoolSizes = &size};
    checkVulkan(vkCreateDescriptorPool(device_, &pool, nullptr, &pool_), "creating a pool");
    const VkDescriptorSetAllocateInfo set{.sType = VK_STRUCTURE_TYPE_DESCRIPTOR_SET_ALLOCATE_INFO,
                                          .descriptorPool = pool_,
                                          .descriptorSetCount = 1,
                                          .pSetLayouts = &setLayout_};
    checkVulkan(vkAllocateDescriptorSets(device_, &set, &set_), "allocating a set");
    const VkDescriptorBufferInfo buffer{vertices, 0, VK_WHOLE_SIZE};
    const VkWriteDescriptorSet write{.sType = VK_STRUCTURE_TYPE_WRITE_DESCRIPTOR_SET,
                                     .dstSet = set_,
                                     .descriptorCount = 1,
                                     .descriptorType = VK_DESCRIPTOR_TYPE_STORAGE_BUFFER,
                                     .pBufferInfo = &buffer};
    vkUpdateDescriptorSets(device_, 1, &write, 0, nullptr);

    const VkPushConstantRange constants{VK_SHADER_STAGE_COMPUTE_BIT, 0, sizeof(StalkPush)};
    const VkPipelineLayoutCreateInfo layout{.sType = VK_STRUCTURE_TYPE_PIPELINE_LAYOUT_CREATE_INFO,
                                            .setLayoutCount = 1,
                                            .pSetLayouts = &setLayout_,
                                            .pushConstantRangeCount = 1,
                                            .pPushConstantRanges = &constants};
    checkVulkan(vkCreatePipelineLayout(device_, &layout, nullptr, &layout_),
                "creating a pipeline layout");
    const VkShaderModuleCreateInfo module{.sType = VK_STRUCTURE_TYPE_SHADER_MODULE_CREATE_INFO,
                                          .codeSize = sizeof stalk_comp,
                                          .pCode = stalk_comp};
    VkComputePipelineCreateInfo pipeline{
        .sType = VK_STRUCTURE_TYPE_COMPUTE_PIPELINE_CREATE_INFO,
        .stage = {.sType = VK_STRUCTURE_TYPE_PIPELINE_SHADER_STAGE_CREATE_INFO,
                  .stage = VK_SHADER_STAGE_COMPUTE_BIT,
                  .pName = "main"},
        .layout = layout_};
    checkVulkan(vkCreateShaderModule(device_, &module, nullptr, &pipeline.stage.module),
                "creating a shader");
    checkVulkan(
        vkCreateComputePipelines(device_, VK_NULL_HANDLE, 1, &pipeline, nullptr, &pipeline_),
        "creating a pipeline");
    vkDestroyShaderModule(device_, pipeline.stage.module, nullptr);
}

StalkBender::~StalkBender()
{
    vkDestroyPipeline(device_, pipeline_, nullptr);
    vkDestroyPipelineLayout(device_, layout_, nullptr);
    vkDestroyDescriptorPool(device_, pool_, nullptr);
    vkDestroyDescriptorSetLayout(device_, setLayout_, nullptr);
}

void StalkBender::record(VkCommandBuffer cmd, float bend) const
{
    // After the previous frame has read them: drawn them, and fitted their shadow.
    constexpr VkPipelineStageFlags readers =
        VK_PIPELINE_STAGE_VERTEX_INPUT_BIT | VK_PIPELINE_STAGE_COMPUTE_SHADER_BIT;
    vkCmdPipelineBarrier(cmd, readers, VK_PIPELINE_STAGE_COMPUTE_SHADER_BIT, 0, 0, nullptr, 0,
                         nullptr, 0, nullptr);
    const StalkPush push{vertexCount, sides, rings, length, radius, bend};
    vkCmdBindPipeline(cmd, VK_PIPELINE_BIND_POINT_COMPUTE, pipeline_);
    vkCmdBindDescriptorSets(cmd, VK_PIPELINE_BIND_POINT_COMPUTE, layout_, 0, 1, &set_, 0, nullptr);
    vkCmdPushConstants(cmd, layout_, VK_SHADER_STAGE_COMPUTE_BIT, 0, sizeof push, &push);
    vkCmdDispatch(cmd, (vertexCount + 63) / 64, 1, 1);
    const VkMemoryBarrier written{.sType = VK_STRUCTURE_TYPE_MEMORY_BARRIER,
                                  .srcAccessMask = VK_ACCESS_SHADER_WRITE_BIT,
                                  .dstAccessMask = VK_ACCESS_VERTEX_ATTRIBUTE_READ_BIT |
                                                   VK_ACCESS_SHADER_READ_BIT};
    vkCmdPipelineBarrier(cmd, VK_PIPELINE_STAGE_COMPUTE_SHADER_BIT, readers, 0, 1, &written, 0,
                         nullptr, 0, nullptr);
}
