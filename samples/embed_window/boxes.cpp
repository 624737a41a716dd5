// SPDX-License-Identifier: Apache-2.0
#include "boxes.h"

#include <span>

#include "boxes.frag.inc"
#include "boxes.vert.inc"

namespace
{

// The push constants of boxes.vert.
struct Push {
    glm::mat4 clipFromWorld;
    glm::vec4 centreRoughness, halfSizeMetalness, baseColour;
};

constexpr VkFormat colourFormats[] = {gbufferDesc.normalRoughnessFormat, gbufferDesc.albedoFormat,
                                      gbufferDesc.specularFormat};

VkShaderModule createModule(VkDevice device, std::span<const uint32_t> words)
{
    const VkShaderModuleCreateInfo info{.sType = VK_STRUCTURE_TYPE_SHADER_MODULE_CREATE_INFO,
                                        .codeSize = words.size_bytes(),
                                        .pCode = words.data()};
    VkShaderModule shader{};
    checkVulkan(vkCreateShaderModule(device, &info, nullptr, &shader), "creating a shader");
    return shader;
}

// The pipeline that draws into the G-buffer, of a vertex and a fragment stage.
VkPipeline createPipeline(VkDevice device, VkPipelineLayout layout,
                          const VkPipelineShaderStageCreateInfo (&stages)[2])
{
    const VkPipelineRenderingCreateInfo rendering{
        .sType = VK_STRUCTURE_TYPE_PIPELINE_RENDERING_CREATE_INFO,
        .colorAttachmentCount = 3,
        .pColorAttachmentFormats = colourFormats,
        .depthAttachmentFormat = gbufferDesc.depthFormat};
    const VkPipelineVertexInputStateCreateInfo noVertices{
        .sType = VK_STRUCTURE_TYPE_PIPELINE_VERTEX_INPUT_STATE_CREATE_INFO};
    const VkPipelineInputAssemblyStateCreateInfo assembly{
        .sType = VK_STRUCTURE_TYPE_PIPELINE_INPUT_ASSEMBLY_STATE_CREATE_INFO,
        .topology = VK_PRIMITIVE_TOPOLOGY_TRIANGLE_LIST};
    const VkPipelineViewportStateCreateInfo viewport{
        .sType = VK_STRUCTURE_TYPE_PIPELINE_VIEWPORT_STATE_CREATE_INFO,
        .viewportCount = 1,
        .scissorCount = 1};
    // Back faces are culled, so that every normal in the G-buffer faces the camera.
    const VkPipelineRasterizationStateCreateInfo raster{
        .sType = VK_STRUCTURE_TYPE_PIPELINE_RASTERIZATION_STATE_CREATE_INFO,
        .cullMode = VK_CULL_MODE_BACK_BIT,
        .frontFace = VK_FRONT_FACE_COUNTER_CLOCKWISE,
        .lineWidth = 1};
    const VkPipelineMultisampleStateCreateInfo samples{
        .sType = VK_STRUCTURE_TYPE_PIPELINE_MULTISAMPLE_STATE_CREATE_INFO,
        .rasterizationSamples = VK_SAMPLE_COUNT_1_BIT};
    const VkPipelineDepthStencilStateCreateInfo depth{
        .sType = VK_STRUCTURE_TYPE_PIPELINE_DEPTH_STENCIL_STATE_CREATE_INFO,
        .depthTestEnable = VK_TRUE,
        .depthWriteEnable = VK_TRUE,
        .depthCompareOp = VK_COMPARE_OP_LESS};
    VkPipelineColorBlendAttachmentState writes[3]{};
    for (VkPipelineColorBlendAttachmentState& write : writes)
        write.colorWriteMask = VK_COLOR_COMPONENT_R_BIT | VK_COLOR_COMPONENT_G_BIT |
                               VK_COLOR_COMPONENT_B_BIT | VK_COLOR_COMPONENT_A_BIT;
    const VkPipelineColorBlendStateCreateInfo blend{
        .sType = VK_STRUCTURE_TYPE_PIPELINE_COLOR_BLEND_STATE_CREATE_INFO,
        .attachmentCount = 3,
        .pAttachments = writes};
    constexpr VkDynamicState dynamicStates[] = {VK_DYNAMIC_STATE_VIEWPORT,
                                                VK_DYNAMIC_STATE_SCISSOR};
    const VkPipelineDynamicStateCreateInfo dynamic{
        .sType = VK_STRUCTURE_TYPE_PIPELINE_DYNAMIC_STATE_CREATE_INFO,
        .dynamicStateCount = 2,
        .pDynamicStates = dynamicStates};
    const VkGraphicsPipelineCreateInfo info{.sType =
                                                VK_STRUCTURE_TYPE_GRAPHICS_PIPELINE_CREATE_INFO,
                                            .pNext = &rendering,
                                            .stageCount = 2,
                                            .pStages = stages,
                                            .pVertexInputState = &noVertices,
                                            .pInputAssemblyState = &assembly,
                                            .pViewportState = &viewport,
                                            .pRasterizationState = &raster,
                                            .pMultisampleState = &samples,
                                            .pDepthStencilState = &depth,
                                            .pColorBlendState = &blend,
                                            .pDynamicState = &dynamic,
                                            .layout = layout};
    VkPipeline pipeline = VK_NULL_HANDLE;
    checkVulkan(vkCreateGraphicsPipelines(device, VK_NULL_HANDLE, 1, &info, nullptr, &pipeline),
                "creating the pipeline of the boxes");
    return pipeline;
}

} // namespace

void GBuffer::create(const Host& host, VkExtent2D size)
{
    const auto image = [&](VkFormat format, VkImageUsageFlags usage) {
        return createHostImage(&host, format, size.width, size.height, usage);
    };
    constexpr VkImageUsageFlags drawn =
        VK_IMAGE_USAGE_COLOR_ATTACHMENT_BIT | VK_IMAGE_USAGE_SAMPLED_BIT;
    normal = image(gbufferDesc.normalRoughnessFormat, drawn);
    baseColour = image(gbufferDesc.albedoFormat, drawn);
    roughnessMetalness = image(gbufferDesc.specularFormat, drawn);
    depth = image(gbufferDesc.depthFormat,
                  VK_IMAGE_USAGE_DEPTH_STENCIL_ATTACHMENT_BIT | VK_IMAGE_USAGE_SAMPLED_BIT);
    radiance = image(VK_FORMAT_R32G32B32A32_SFLOAT,
                     VK_IMAGE_USAGE_STORAGE_BIT | VK_IMAGE_USAGE_SAMPLED_BIT);
    display = image(VK_FORMAT_R8G8B8A8_UNORM, VK_IMAGE_USAGE_STORAGE_BIT);
}

void GBuffer::destroy(const Host& host)
{
    for (const HostImage& image :
         {normal, baseColour, roughnessMetalness, depth, radiance, display})
        destroyHostImage(&host, image);
}

Boxes::Boxes(const Host& host) : device_(host.device)
{
    const VkPushConstantRange push{VK_SHADER_STAGE_VERTEX_BIT | VK_SHADER_STAGE_FRAGMENT_BIT, 0,
                                   sizeof(Push)};
    const VkPipelineLayoutCreateInfo layout{.sType = VK_STRUCTURE_TYPE_PIPELINE_LAYOUT_CREATE_INFO,
                                            .pushConstantRangeCount = 1,
                                            .pPushConstantRanges = &push};
    checkVulkan(vkCreatePipelineLayout(device_, &layout, nullptr, &layout_),
                "creating a pipeline layout");
    const VkShaderModule vertex = createModule(device_, boxes_vert);
    const VkShaderModule fragment = createModule(device_, boxes_frag);
    const VkPipelineShaderStageCreateInfo stages[] = {
        {.sType = VK_STRUCTURE_TYPE_PIPELINE_SHADER_STAGE_CREATE_INFO,
         .stage = VK_SHADER_STAGE_VERTEX_BIT,
         .module = vertex,
         .pName = "main"},
        {.sType = VK_STRUCTURE_TYPE_PIPELINE_SHADER_STAGE_CREATE_INFO,
         .stage = VK_SHADER_STAGE_FRAGMENT_BIT,
         .module = fragment,
         .pName = "main"}};
    pipeline_ = createPipeline(device_, layout_, stages);
    vkDestroyShaderModule(device_, vertex, nullptr);
    vkDestroyShaderModule(device_, fragment, nullptr);
}

Boxes::~Boxes()
{
    vkDestroyPipeline(device_, pipeline_, nullptr);
    vkDestroyPipelineLayout(device_, layout_, nullptr);
}

void Boxes::record(VkCommandBuffer cmd, const GBuffer& g, VkExtent2D size,
                   const glm::mat4& clipFromWorld) const
{
    // The compute shaders of the previous frame have read the same images.
    const ImageUse before{VK_IMAGE_LAYOUT_UNDEFINED, VK_PIPELINE_STAGE_2_COMPUTE_SHADER_BIT, 0};
    const HostImage* colours[] = {&g.normal, &g.baseColour, &g.roughnessMetalness};
    VkRenderingAttachmentInfo attachments[3];
    for (int i = 0; i < 3; ++i) {
        imageBarrier(cmd, colours[i], before, colourAttachment);
        attachments[i] = {.sType = VK_STRUCTURE_TYPE_RENDERING_ATTACHMENT_INFO,
                          .imageView = colours[i]->view,
                          .imageLayout = colourAttachment.layout,
                          .loadOp = VK_ATTACHMENT_LOAD_OP_DONT_CARE, // depth tells which pixels are
                                                                     // drawn
                          .storeOp = VK_ATTACHMENT_STORE_OP_STORE};
    }
    imageBarrier(cmd, &g.depth, before, depthAttachment);
    const VkRenderingAttachmentInfo depth{.sType = VK_STRUCTURE_TYPE_RENDERING_ATTACHMENT_INFO,
                                          .imageView = g.depth.view,
                                          .imageLayout = depthAttachment.layout,
                                          .loadOp = VK_ATTACHMENT_LOAD_OP_CLEAR,
                                          .storeOp = VK_ATTACHMENT_STORE_OP_STORE,
                                          .clearValue = {.depthStencil = {.depth = 1}}};
    const VkRenderingInfo rendering{.sType = VK_STRUCTURE_TYPE_RENDERING_INFO,
                                    .renderArea = {{0, 0}, size},
                                    .layerCount = 1,
                                    .colorAttachmentCount = 3,
                                    .pColorAttachments = attachments,
                                    .pDepthAttachment = &depth};
    vkCmdBeginRendering(cmd, &rendering);
    const VkViewport viewport{0, 0, float(size.width), float(size.height), 0, 1};
    const VkRect2D scissor{{0, 0}, size};
    vkCmdSetViewport(cmd, 0, 1, &viewport);
    vkCmdSetScissor(cmd, 0, 1, &scissor);
    vkCmdBindPipeline(cmd, VK_PIPELINE_BIND_POINT_GRAPHICS, pipeline_);
    const auto draw = [&](glm::vec3 centre, glm::vec3 halfSize, glm::vec3 colour,
                          float perceptualRoughness, float metalness) {
        const Push push{
            clipFromWorld, {centre, perceptualRoughness}, {halfSize, metalness}, {colour, 1}};
        vkCmdPushConstants(cmd, layout_, VK_SHADER_STAGE_VERTEX_BIT | VK_SHADER_STAGE_FRAGMENT_BIT,
                           0, sizeof push, &push);
        vkCmdDraw(cmd, 36, 1, 0, 0);
    };
    draw({0, -0.1f, 0}, {8, 0.1f, 8}, {0.5f, 0.5f, 0.5f}, 0.35f, 0); // the floor
    for (int x = -3; x <= 3; ++x)
        for (int z = -3; z <= 3; ++z) {
            const int k = (x + 3) * 7 + z + 3;
            const float height = 0.25f + 0.15f * float(k * 5 % 7);
            const glm::vec3 colour = glm::mix(glm::vec3(0.8f, 0.25f, 0.15f),
                                              glm::vec3(0.2f, 0.45f, 0.8f), float(k % 5) / 4);
            draw({2 * x, height, 2 * z}, {0.4f, height, 0.4f}, colour, 0.15f + 0.1f * float(k % 8),
                 k % 3 == 0 ? 1.0f : 0.0f);
        }
    vkCmdEndRendering(cmd);

    for (const HostImage* colour : colours)
        imageBarrier(cmd, colour, colourAttachment, sampledInCompute);
    imageBarrier(cmd, &g.depth, depthAttachment, sampledInCompute);
}
