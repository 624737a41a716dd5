// SPDX-License-Identifier: Apache-2.0
#include "gpu/raster_host.h"

#include <glm/gtc/matrix_transform.hpp>

#include "candelabra_probes.h"
#include "measure/kernels/vectors.h"
#include "render/check.h"
#include "render/image_barrier.h"
#include "shared/host_scene.h"

namespace candelabra::test
{
namespace
{

using app::set;

constexpr double nearEnd = 0.5, farEnd = 60; // metres
constexpr float linearUnit = 60;             // metres per unit of linear depth
constexpr VkFormat nativeFormat = VK_FORMAT_R32G32_UINT;
constexpr VkFormat hostFormats[] = {VK_FORMAT_R32G32B32A32_SFLOAT, VK_FORMAT_R8G8B8A8_UNORM,
                                    VK_FORMAT_R32G32B32A32_SFLOAT};

bool isProjected(HostDepth depth)
{
    return depth < HostDepth::Linear;
}

// Maps the right-handed world, and its view space, to those of the host.
glm::dmat4 mirrorOf(HostWorld world)
{
    return glm::scale(glm::dmat4(1), glm::dvec3(1, world == HostWorld::YDown ? -1 : 1,
                                                world == HostWorld::LeftHanded ? -1 : 1));
}

glm::dmat4 viewFromWorld(const HostCase& host)
{
    const glm::dmat4 mirror = mirrorOf(host.world);
    return mirror *
           glm::lookAt(glm::dvec3(0.4, 1.7, 4), glm::dvec3(-0.2, 1, -3), glm::dvec3(0, 1, 0)) *
           mirror;
}

// Returns the matrix with which the host draws. Its y points up with HostDepth::OpenGl, otherwise
// down.
glm::dmat4 projectionOf(const HostCase& host, double aspect)
{
    constexpr double cotangent = 1.6; // of half the vertical field of view
    constexpr double n = nearEnd, f = farEnd;
    glm::dmat4 m(0);
    m[0][0] = cotangent / aspect;
    m[1][1] = -cotangent;
    m[2][3] = -1;
    if (host.depth == HostDepth::Reversed) {
        m[3][2] = n;
    } else if (host.depth == HostDepth::OpenGl) {
        m[1][1] = cotangent;
        m[2][2] = (f + n) / (n - f);
        m[3][2] = 2 * f * n / (n - f);
        glm::dmat4 halved(1); // depth -1..1 to 0..1
        halved[2][2] = halved[3][2] = 0.5;
        m = halved * m;
    } else {
        m[2][2] = f / (n - f);
        m[3][2] = f * n / (n - f);
    }
    return m * mirrorOf(host.world);
}

CndCamera cameraOf(const HostCase& host, uint32_t width, uint32_t height)
{
    const glm::dmat4 view = viewFromWorld(host);
    glm::dmat4 clip = projectionOf(host, double(width) / height);
    if (host.depth == HostDepth::OpenGl) // what the viewport of negative height does
        clip = glm::scale(glm::dmat4(1), glm::dvec3(1, -1, 1)) * clip;
    CndCamera camera;
    std::memcpy(camera.viewFromWorld, &view, sizeof view);
    const glm::mat4 rounded(clip);
    std::memcpy(camera.clipFromView, &rounded, sizeof rounded);
    return camera;
}

// Returns the depth value of pixels without a surface.
float clearOf(const HostCase& host)
{
    switch (host.depth) {
    case HostDepth::Standard:
    case HostDepth::OpenGl:
        return 1;
    case HostDepth::Linear:
        return 1000;
    default:
        return 0;
    }
}

gpu::HostSceneWall wallOf(const HostCase& host, const glm::dvec3& corner, const glm::dvec3& edgeU,
                          const glm::dvec3& edgeV, float facing, uint32_t material)
{
    const glm::dmat3 mirror(mirrorOf(host.world));
    return {.corner = glm::vec3(mirror * corner),
            .edgeU = glm::vec3(mirror * edgeU),
            .edgeV = glm::vec3(mirror * edgeV),
            .facing = facing * float(glm::determinant(mirror)),
            .material = material};
}

gpu::HostScene sceneOf(const HostCase& host, uint32_t width, uint32_t height)
{
    const glm::dmat4 view = viewFromWorld(host);
    return {.clipFromWorld = glm::mat4(projectionOf(host, double(width) / height) * view),
            .viewFromWorld = glm::mat3(glm::dmat3(view)),
            .originView = glm::vec3(view[3]),
            .placeKind = host.depth == HostDepth::Linear         ? gpu::HOST_SCENE_LINEAR
                         : host.depth == HostDepth::PositionView ? gpu::HOST_SCENE_VIEW
                                                                 : gpu::HOST_SCENE_WORLD,
            .linearUnit = linearUnit,
            .walls = {wallOf(host, {-4, 0, -6}, {8, 0, 0}, {0, 0, 10}, -1, 0), // floor
                      wallOf(host, {-4, 0, -6}, {6, 0, 0}, {0, 3, 0}, 1, 1),
                      wallOf(host, {-4, 0, -6}, {0, 0, 10}, {0, 4, 0}, -1, 2),
                      wallOf(host, {-1, 0, -2}, {1.5, 0, 0.7}, {0, 1.5, -0.4}, 1, 3), // leans
                      wallOf(host, {1.5, 0.8, -3}, {1.2, 0, 0}, {0, 0, 1.2}, -1, 0),  // a box
                      wallOf(host, {1.5, 0, -1.8}, {1.2, 0, 0}, {0, 0.8, 0}, 1, 1)}};
}

constexpr VkPipelineStageFlags2 depthTests =
    VK_PIPELINE_STAGE_2_EARLY_FRAGMENT_TESTS_BIT | VK_PIPELINE_STAGE_2_LATE_FRAGMENT_TESTS_BIT;
constexpr VkPipelineStageFlags2 computeShader = VK_PIPELINE_STAGE_2_COMPUTE_SHADER_BIT;

} // namespace

CndGBufferDesc gbufferOf(const HostCase& host)
{
    if (host.native)
        return {};
    CndGBufferDesc desc{.normalEncoding = CND_NORMAL_SNORM,
                        .normalSpace = CND_NORMALS_WORLD,
                        .roughness = CND_CHANNEL_NORMAL_A,
                        .metalness = CND_CHANNEL_ALBEDO_A,
                        .normalRoughnessFormat = hostFormats[0],
                        .albedoFormat = hostFormats[1]};
    if (!isProjected(host.depth))
        desc.depthFormat = hostFormats[2];
    if (host.depth == HostDepth::Linear) {
        desc.depthKind = CND_DEPTH_LINEAR;
        desc.depthUnit = linearUnit;
    } else if (host.depth == HostDepth::PositionView) {
        desc.depthKind = CND_DEPTH_POSITION_VIEW;
    } else if (host.depth == HostDepth::PositionWorld) {
        desc.depthKind = CND_DEPTH_POSITION_WORLD;
    }
    return desc;
}

std::vector<CndLight> lightsOf(const HostCase& host, bool turned)
{
    CndLight sphere{.type = CND_LIGHT_SPHERE,
                    .radius = 0.15f,
                    .emission = {9000, 8000, 6000},
                    .influenceRadius = 14};
    CndLight rectangle{
        .type = CND_LIGHT_RECTANGLE, .emission = {3000, 4000, 5000}, .influenceRadius = 14};
    CndLight spot{.type = CND_LIGHT_SPOT,
                  .emission = {400, 300, 200},
                  .influenceRadius = 14,
                  .innerConeAngle = 0.3f,
                  .outerConeAngle = 0.7f};
    const glm::dmat3 mirror(mirrorOf(host.world));
    const bool isMirror = glm::determinant(mirror) < 0;
    set(sphere.position, mirror * glm::dvec3(-1, 2, -3));
    set(rectangle.position, mirror * glm::dvec3(1.2, 2.4, -3));
    // axisU x axisV points down. A mirror turns a cross product around, so it swaps the axes.
    const glm::dvec3 along(0.7, 0, 0), across(0, 0, 0.5);
    set(rectangle.axisU, mirror * (isMirror != turned ? across : along));
    set(rectangle.axisV, mirror * (isMirror != turned ? along : across));
    set(spot.position, mirror * glm::dvec3(2, 3, 1));
    set(spot.direction, mirror * glm::normalize(glm::dvec3(-0.5, -0.8, -0.6)));
    return {sphere, rectangle, spot};
}

RasterHost::RasterHost(const gpu::Device& device, const HostCase& host, uint32_t width,
                       uint32_t height)
    : device_(device), case_(host), width_(width), height_(height)
{
    constexpr VkImageUsageFlags colour =
        VK_IMAGE_USAGE_COLOR_ATTACHMENT_BIT | VK_IMAGE_USAGE_SAMPLED_BIT;
    for (int i = 0; i < 3; ++i)
        colour_[i] =
            gpu::createImage(device, "host G-buffer", host.native ? nativeFormat : hostFormats[i],
                             width, height, colour, VK_IMAGE_ASPECT_COLOR_BIT);
    depth_ = gpu::createImage(
        device, "host depth",
        host.pass == HostPass::RenderPass ? VK_FORMAT_D32_SFLOAT_S8_UINT : VK_FORMAT_D32_SFLOAT,
        width, height, VK_IMAGE_USAGE_DEPTH_STENCIL_ATTACHMENT_BIT | VK_IMAGE_USAGE_SAMPLED_BIT,
        VK_IMAGE_ASPECT_DEPTH_BIT);
    scene_ = gpu::createBuffer(device, "host scene", sizeof(gpu::HostScene),
                               VK_BUFFER_USAGE_STORAGE_BUFFER_BIT, gpu::MemoryUse::Upload);
    scene_.as<gpu::HostScene>()[0] = sceneOf(host, width, height);
    constexpr VkShaderStageFlags stages = VK_SHADER_STAGE_VERTEX_BIT | VK_SHADER_STAGE_FRAGMENT_BIT;
    bindings_ =
        gpu::Bindings(device, "host scene",
                      {{gpu::HOST_SCENE_BINDING, VK_DESCRIPTOR_TYPE_STORAGE_BUFFER, 1}}, stages, 1);
    bindings_.write(0, {gpu::Binding::of(gpu::HOST_SCENE_BINDING, scene_)});
    const VkDescriptorSetLayout set = bindings_.layout();
    layout_ = gpu::createPipelineLayout(device, "host scene", {&set, 1}, stages, 0);
    if (host.pass == HostPass::RenderPass)
        createRenderPass();
    createPipeline();
}

RasterHost::~RasterHost()
{
    vkDestroyFramebuffer(device_.handle, framebuffer_, nullptr);
    vkDestroyRenderPass(device_.handle, renderPass_, nullptr);
}

// Follows INTEGRATION.md for render passes: the layouts in which the module reads the images are
// final layouts, and dependencies replace barriers.
void RasterHost::createRenderPass()
{
    VkAttachmentDescription attachments[4];
    VkAttachmentReference references[4];
    for (uint32_t i = 0; i < 4; ++i) {
        const bool isDepth = i == 3;
        attachments[i] = {.format = isDepth ? depth_.format : colour_[i].format,
                          .samples = VK_SAMPLE_COUNT_1_BIT,
                          .loadOp = VK_ATTACHMENT_LOAD_OP_CLEAR,
                          .storeOp = VK_ATTACHMENT_STORE_OP_STORE,
                          .stencilLoadOp = VK_ATTACHMENT_LOAD_OP_DONT_CARE,
                          .stencilStoreOp = VK_ATTACHMENT_STORE_OP_DONT_CARE,
                          .initialLayout = VK_IMAGE_LAYOUT_UNDEFINED,
                          .finalLayout = isDepth ? VK_IMAGE_LAYOUT_DEPTH_STENCIL_READ_ONLY_OPTIMAL
                                                 : VK_IMAGE_LAYOUT_SHADER_READ_ONLY_OPTIMAL};
        references[i] = {i, isDepth ? VK_IMAGE_LAYOUT_DEPTH_STENCIL_ATTACHMENT_OPTIMAL
                                    : VK_IMAGE_LAYOUT_COLOR_ATTACHMENT_OPTIMAL};
    }
    const VkSubpassDescription subpass{.pipelineBindPoint = VK_PIPELINE_BIND_POINT_GRAPHICS,
                                       .colorAttachmentCount = 3,
                                       .pColorAttachments = references,
                                       .pDepthStencilAttachment = &references[3]};
    constexpr VkPipelineStageFlags attachmentStages =
        VK_PIPELINE_STAGE_COLOR_ATTACHMENT_OUTPUT_BIT | VK_PIPELINE_STAGE_EARLY_FRAGMENT_TESTS_BIT |
        VK_PIPELINE_STAGE_LATE_FRAGMENT_TESTS_BIT;
    constexpr VkAccessFlags attachmentWrites =
        VK_ACCESS_COLOR_ATTACHMENT_WRITE_BIT | VK_ACCESS_DEPTH_STENCIL_ATTACHMENT_WRITE_BIT;
    const VkSubpassDependency dependencies[] = {
        {.srcSubpass = VK_SUBPASS_EXTERNAL,
         .dstSubpass = 0,
         .srcStageMask = VK_PIPELINE_STAGE_COMPUTE_SHADER_BIT,
         .dstStageMask = attachmentStages,
         .srcAccessMask = 0,
         .dstAccessMask = attachmentWrites | VK_ACCESS_DEPTH_STENCIL_ATTACHMENT_READ_BIT},
        {.srcSubpass = 0,
         .dstSubpass = VK_SUBPASS_EXTERNAL,
         .srcStageMask = attachmentStages,
         .dstStageMask = VK_PIPELINE_STAGE_COMPUTE_SHADER_BIT,
         .srcAccessMask = attachmentWrites,
         .dstAccessMask = VK_ACCESS_SHADER_READ_BIT}};
    const VkRenderPassCreateInfo info{.sType = VK_STRUCTURE_TYPE_RENDER_PASS_CREATE_INFO,
                                      .attachmentCount = 4,
                                      .pAttachments = attachments,
                                      .subpassCount = 1,
                                      .pSubpasses = &subpass,
                                      .dependencyCount = 2,
                                      .pDependencies = dependencies};
    gpu::check(vkCreateRenderPass(device_.handle, &info, nullptr, &renderPass_),
               "creating the host's render pass");
    const VkImageView views[] = {colour_[0].view.get(), colour_[1].view.get(),
                                 colour_[2].view.get(), depth_.view.get()};
    const VkFramebufferCreateInfo framebuffer{.sType = VK_STRUCTURE_TYPE_FRAMEBUFFER_CREATE_INFO,
                                              .renderPass = renderPass_,
                                              .attachmentCount = 4,
                                              .pAttachments = views,
                                              .width = width_,
                                              .height = height_,
                                              .layers = 1};
    gpu::check(vkCreateFramebuffer(device_.handle, &framebuffer, nullptr, &framebuffer_),
               "creating the host's framebuffer");
}

void RasterHost::createPipeline()
{
    const gpu::Handle<VkShaderModule> vertex = gpu::createShaderModule(
        device_, case_.native ? spirv::host_scene_vert_full : spirv::host_scene_vert);
    const gpu::Handle<VkShaderModule> fragment = gpu::createShaderModule(
        device_, case_.native ? spirv::host_scene_frag_full : spirv::host_scene_frag);
    const auto stage = [](VkShaderStageFlagBits which, const gpu::Handle<VkShaderModule>& module) {
        return VkPipelineShaderStageCreateInfo{
            .sType = VK_STRUCTURE_TYPE_PIPELINE_SHADER_STAGE_CREATE_INFO,
            .stage = which,
            .module = module.get(),
            .pName = "main"};
    };
    const VkPipelineShaderStageCreateInfo stages[] = {
        stage(VK_SHADER_STAGE_VERTEX_BIT, vertex), stage(VK_SHADER_STAGE_FRAGMENT_BIT, fragment)};
    const VkPipelineVertexInputStateCreateInfo input{
        .sType = VK_STRUCTURE_TYPE_PIPELINE_VERTEX_INPUT_STATE_CREATE_INFO};
    const VkPipelineInputAssemblyStateCreateInfo assembly{
        .sType = VK_STRUCTURE_TYPE_PIPELINE_INPUT_ASSEMBLY_STATE_CREATE_INFO,
        .topology = VK_PRIMITIVE_TOPOLOGY_TRIANGLE_LIST};
    const float w = float(width_), h = float(height_);
    const VkViewport viewport = case_.depth == HostDepth::OpenGl ? VkViewport{0, h, w, -h, 0, 1}
                                                                 : VkViewport{0, 0, w, h, 0, 1};
    const VkRect2D scissor{{0, 0}, {width_, height_}};
    const VkPipelineViewportStateCreateInfo viewports{
        .sType = VK_STRUCTURE_TYPE_PIPELINE_VIEWPORT_STATE_CREATE_INFO,
        .viewportCount = 1,
        .pViewports = &viewport,
        .scissorCount = 1,
        .pScissors = &scissor};
    const VkPipelineRasterizationStateCreateInfo raster{
        .sType = VK_STRUCTURE_TYPE_PIPELINE_RASTERIZATION_STATE_CREATE_INFO, .lineWidth = 1};
    const VkPipelineMultisampleStateCreateInfo samples{
        .sType = VK_STRUCTURE_TYPE_PIPELINE_MULTISAMPLE_STATE_CREATE_INFO,
        .rasterizationSamples = VK_SAMPLE_COUNT_1_BIT};
    const VkPipelineDepthStencilStateCreateInfo depth{
        .sType = VK_STRUCTURE_TYPE_PIPELINE_DEPTH_STENCIL_STATE_CREATE_INFO,
        .depthTestEnable = VK_TRUE,
        .depthWriteEnable = VK_TRUE,
        .depthCompareOp =
            case_.depth == HostDepth::Reversed ? VK_COMPARE_OP_GREATER : VK_COMPARE_OP_LESS};
    VkPipelineColorBlendAttachmentState writes[3]{};
    for (VkPipelineColorBlendAttachmentState& w4 : writes)
        w4.colorWriteMask = 0xF;
    const VkPipelineColorBlendStateCreateInfo blend{
        .sType = VK_STRUCTURE_TYPE_PIPELINE_COLOR_BLEND_STATE_CREATE_INFO,
        .attachmentCount = 3,
        .pAttachments = writes};
    const VkFormat formats[] = {colour_[0].format, colour_[1].format, colour_[2].format};
    const VkPipelineRenderingCreateInfo rendering{
        .sType = VK_STRUCTURE_TYPE_PIPELINE_RENDERING_CREATE_INFO,
        .colorAttachmentCount = 3,
        .pColorAttachmentFormats = formats,
        .depthAttachmentFormat = depth_.format};
    const VkGraphicsPipelineCreateInfo info{.sType =
                                                VK_STRUCTURE_TYPE_GRAPHICS_PIPELINE_CREATE_INFO,
                                            .pNext = renderPass_ ? nullptr : &rendering,
                                            .stageCount = 2,
                                            .pStages = stages,
                                            .pVertexInputState = &input,
                                            .pInputAssemblyState = &assembly,
                                            .pViewportState = &viewports,
                                            .pRasterizationState = &raster,
                                            .pMultisampleState = &samples,
                                            .pDepthStencilState = &depth,
                                            .pColorBlendState = &blend,
                                            .layout = layout_.get(),
                                            .renderPass = renderPass_};
    VkPipeline pipeline{};
    gpu::check(
        vkCreateGraphicsPipelines(device_.handle, VK_NULL_HANDLE, 1, &info, nullptr, &pipeline),
        "creating the host's pipeline");
    pipeline_ = {device_, pipeline};
}

std::array<VkClearValue, 4> RasterHost::clearValues() const
{
    std::array<VkClearValue, 4> out{};
    if (!case_.native && !isProjected(case_.depth))
        out[2].color.float32[0] = out[2].color.float32[3] = clearOf(case_);
    out[3].depthStencil.depth = case_.depth == HostDepth::Reversed ? 0.0f : 1.0f;
    return out;
}

void RasterHost::drawWalls(VkCommandBuffer cmd) const
{
    const VkDescriptorSet set = bindings_.set(0);
    vkCmdBindPipeline(cmd, VK_PIPELINE_BIND_POINT_GRAPHICS, pipeline_.get());
    vkCmdBindDescriptorSets(cmd, VK_PIPELINE_BIND_POINT_GRAPHICS, layout_.get(), 0, 1, &set, 0,
                            nullptr);
    vkCmdDraw(cmd, 6, gpu::HOST_SCENE_WALLS, 0, 0);
}

void RasterHost::drawInRenderPass(VkCommandBuffer cmd) const
{
    const std::array<VkClearValue, 4> clears = clearValues();
    const VkRenderPassBeginInfo begin{.sType = VK_STRUCTURE_TYPE_RENDER_PASS_BEGIN_INFO,
                                      .renderPass = renderPass_,
                                      .framebuffer = framebuffer_,
                                      .renderArea = {{0, 0}, {width_, height_}},
                                      .clearValueCount = uint32_t(clears.size()),
                                      .pClearValues = clears.data()};
    vkCmdBeginRenderPass(cmd, &begin, VK_SUBPASS_CONTENTS_INLINE);
    drawWalls(cmd);
    vkCmdEndRenderPass(cmd);
}

void RasterHost::drawDynamic(VkCommandBuffer cmd) const
{
    constexpr app::ImageAccess before{computeShader, 0, VK_IMAGE_LAYOUT_UNDEFINED};
    constexpr app::ImageAccess tested{depthTests,
                                      VK_ACCESS_2_DEPTH_STENCIL_ATTACHMENT_READ_BIT |
                                          VK_ACCESS_2_DEPTH_STENCIL_ATTACHMENT_WRITE_BIT,
                                      VK_IMAGE_LAYOUT_DEPTH_ATTACHMENT_OPTIMAL};
    const CndLightingFrame after = frame();
    const app::ImageAccess colourRead{computeShader, VK_ACCESS_2_SHADER_SAMPLED_READ_BIT,
                                      after.gbufferImageLayout};
    const app::ImageAccess depthRead{computeShader, VK_ACCESS_2_SHADER_SAMPLED_READ_BIT,
                                     VK_IMAGE_LAYOUT_DEPTH_READ_ONLY_OPTIMAL};
    const auto barriers = [&](const app::ImageAccess& colourFrom, const app::ImageAccess& colourTo,
                              const app::ImageAccess& depthFrom, const app::ImageAccess& depthTo) {
        const VkImageMemoryBarrier2 all[] = {
            app::imageBarrier(colour_[0].image.get(), VK_IMAGE_ASPECT_COLOR_BIT, colourFrom,
                              colourTo),
            app::imageBarrier(colour_[1].image.get(), VK_IMAGE_ASPECT_COLOR_BIT, colourFrom,
                              colourTo),
            app::imageBarrier(colour_[2].image.get(), VK_IMAGE_ASPECT_COLOR_BIT, colourFrom,
                              colourTo),
            app::imageBarrier(depth_.image.get(), VK_IMAGE_ASPECT_DEPTH_BIT, depthFrom, depthTo)};
        const VkDependencyInfo info{.sType = VK_STRUCTURE_TYPE_DEPENDENCY_INFO,
                                    .imageMemoryBarrierCount = 4,
                                    .pImageMemoryBarriers = all};
        vkCmdPipelineBarrier2(cmd, &info);
    };
    const std::array<VkClearValue, 4> clears = clearValues();
    const auto attachment = [&](int i) {
        return VkRenderingAttachmentInfo{
            .sType = VK_STRUCTURE_TYPE_RENDERING_ATTACHMENT_INFO,
            .imageView = i == 3 ? depth_.view.get() : colour_[i].view.get(),
            .imageLayout = i == 3 ? tested.layout : app::colorAttachment.layout,
            .loadOp = VK_ATTACHMENT_LOAD_OP_CLEAR,
            .storeOp = VK_ATTACHMENT_STORE_OP_STORE,
            .clearValue = clears[i]};
    };
    const VkRenderingAttachmentInfo colours[] = {attachment(0), attachment(1), attachment(2)};
    const VkRenderingAttachmentInfo depth = attachment(3);
    const VkRenderingInfo rendering{.sType = VK_STRUCTURE_TYPE_RENDERING_INFO,
                                    .renderArea = {{0, 0}, {width_, height_}},
                                    .layerCount = 1,
                                    .colorAttachmentCount = 3,
                                    .pColorAttachments = colours,
                                    .pDepthAttachment = &depth};
    barriers(before, app::colorAttachment, before, tested);
    vkCmdBeginRendering(cmd, &rendering);
    drawWalls(cmd);
    vkCmdEndRendering(cmd);
    barriers(app::colorAttachment, colourRead, tested, depthRead);
}

void RasterHost::draw(VkCommandBuffer cmd) const
{
    if (case_.pass == HostPass::RenderPass)
        drawInRenderPass(cmd);
    else
        drawDynamic(cmd);
}

CndLightingFrame RasterHost::frame() const
{
    const bool inRenderPass = case_.pass == HostPass::RenderPass;
    const VkImageLayout colours =
        inRenderPass ? VK_IMAGE_LAYOUT_SHADER_READ_ONLY_OPTIMAL : VK_IMAGE_LAYOUT_GENERAL;
    const VkImageLayout depth = inRenderPass ? VK_IMAGE_LAYOUT_DEPTH_STENCIL_READ_ONLY_OPTIMAL
                                             : VK_IMAGE_LAYOUT_DEPTH_READ_ONLY_OPTIMAL;
    const bool projected = case_.native || isProjected(case_.depth);
    return {.structSize = sizeof(CndLightingFrame),
            .width = width_,
            .height = height_,
            .camera = cameraOf(case_, width_, height_),
            .clearDepth = clearOf(case_),
            .normalRoughness = colour_[0].view.get(),
            .albedo = colour_[1].view.get(),
            .specular = case_.native ? colour_[2].view.get() : VK_NULL_HANDLE,
            .depth = projected ? depth_.view.get() : colour_[2].view.get(),
            .gbufferImageLayout = colours,
            .depthImageLayout = projected ? depth : colours};
}

} // namespace candelabra::test
