// SPDX-License-Identifier: Apache-2.0
#include "panel.h"

#include <algorithm>

#define GLFW_INCLUDE_NONE
#include <GLFW/glfw3.h>
#include <backends/imgui_impl_glfw.h>
#include <backends/imgui_impl_vulkan.h>
#include <imgui.h>

namespace
{

// Debian's version of Dear ImGui draws in render passes.
VkRenderPass createPass(VkDevice device, VkFormat format)
{
    const VkAttachmentDescription colour{.format = format,
                                         .samples = VK_SAMPLE_COUNT_1_BIT,
                                         .loadOp = VK_ATTACHMENT_LOAD_OP_LOAD,
                                         .storeOp = VK_ATTACHMENT_STORE_OP_STORE,
                                         .stencilLoadOp = VK_ATTACHMENT_LOAD_OP_DONT_CARE,
                                         .stencilStoreOp = VK_ATTACHMENT_STORE_OP_DONT_CARE,
                                         .initialLayout = colourAttachment.layout,
                                         .finalLayout = colourAttachment.layout};
    const VkAttachmentReference reference{0, colourAttachment.layout};
    const VkSubpassDescription subpass{.pipelineBindPoint = VK_PIPELINE_BIND_POINT_GRAPHICS,
                                       .colorAttachmentCount = 1,
                                       .pColorAttachments = &reference};
    const VkRenderPassCreateInfo info{.sType = VK_STRUCTURE_TYPE_RENDER_PASS_CREATE_INFO,
                                      .attachmentCount = 1,
                                      .pAttachments = &colour,
                                      .subpassCount = 1,
                                      .pSubpasses = &subpass};
    VkRenderPass pass{};
    checkVulkan(vkCreateRenderPass(device, &info, nullptr, &pass), "creating a render pass");
    return pass;
}

} // namespace

Panel::Panel(const Window& window) : window_(window)
{
    const Host& host = window.host();
    const VkDescriptorPoolSize font{VK_DESCRIPTOR_TYPE_COMBINED_IMAGE_SAMPLER, 1};
    const VkDescriptorPoolCreateInfo pool{.sType = VK_STRUCTURE_TYPE_DESCRIPTOR_POOL_CREATE_INFO,
                                          .flags =
                                              VK_DESCRIPTOR_POOL_CREATE_FREE_DESCRIPTOR_SET_BIT,
                                          .maxSets = 1,
                                          .poolSizeCount = 1,
                                          .pPoolSizes = &font};
    checkVulkan(vkCreateDescriptorPool(host.device, &pool, nullptr, &pool_),
                "creating a descriptor pool");
    pass_ = createPass(host.device, window.format());
    ImGui::CreateContext();
    ImGui::GetIO().IniFilename = nullptr; // write no settings file
    ImGui_ImplGlfw_InitForVulkan(window.get(), true);
    ImGui_ImplVulkan_InitInfo info{};
    info.Instance = host.instance;
    info.PhysicalDevice = host.physicalDevice;
    info.Device = host.device;
    info.QueueFamily = host.queueFamily;
    info.Queue = host.queue;
    info.DescriptorPool = pool_;
    info.MinImageCount = framesInFlight;
    info.ImageCount = std::max(framesInFlight, window.imageCount());
    info.MSAASamples = VK_SAMPLE_COUNT_1_BIT;
    ImGui_ImplVulkan_Init(&info, pass_);
    Host once = host; // a copy, to use its command buffer once
    ImGui_ImplVulkan_CreateFontsTexture(beginFrame(&once));
    endFrame(&once);
    ImGui_ImplVulkan_DestroyFontUploadObjects();
}

Panel::~Panel()
{
    const VkDevice device = window_.host().device;
    vkDeviceWaitIdle(device);
    ImGui_ImplVulkan_Shutdown();
    ImGui_ImplGlfw_Shutdown();
    ImGui::DestroyContext();
    for (const VkFramebuffer framebuffer : framebuffers_)
        vkDestroyFramebuffer(device, framebuffer, nullptr);
    vkDestroyRenderPass(device, pass_, nullptr);
    vkDestroyDescriptorPool(device, pool_, nullptr);
}

void Panel::record(const Window::Frame& frame, VkExtent2D size, Settings& settings,
                   uint32_t longestList)
{
    ImGui_ImplVulkan_NewFrame();
    ImGui_ImplGlfw_NewFrame();
    ImGui::NewFrame();
    ImGui::SetNextWindowPos({8, 8}, ImGuiCond_FirstUseEver);
    ImGui::Begin("Candelabra", nullptr, ImGuiWindowFlags_AlwaysAutoResize);
    ImGui::Text("%.1f ms a frame", 1000.0 / double(ImGui::GetIO().Framerate));
    ImGui::Text("at most %u lights in a list", longestList);
    ImGui::SliderInt("lights", &settings.lightCount, 0, 512);
    ImGui::Checkbox("moving", &settings.moving);
    int shown = settings.overlay + 1;
    ImGui::Combo("show", &shown,
                 "lit\0all that is read\0normals\0roughness\0albedo\0F0\0positions\0faults\0");
    settings.overlay = shown - 1;
    ImGui::End();
    ImGui::Render();

    const VkFramebufferCreateInfo info{.sType = VK_STRUCTURE_TYPE_FRAMEBUFFER_CREATE_INFO,
                                       .renderPass = pass_,
                                       .attachmentCount = 1,
                                       .pAttachments = &frame.target.view,
                                       .width = size.width,
                                       .height = size.height,
                                       .layers = 1};
    const VkDevice device = window_.host().device;
    vkDestroyFramebuffer(device, framebuffers_[frame.slot], nullptr);
    checkVulkan(vkCreateFramebuffer(device, &info, nullptr, &framebuffers_[frame.slot]),
                "creating a framebuffer");
    const VkRenderPassBeginInfo begin{.sType = VK_STRUCTURE_TYPE_RENDER_PASS_BEGIN_INFO,
                                      .renderPass = pass_,
                                      .framebuffer = framebuffers_[frame.slot],
                                      .renderArea = {{0, 0}, size}};
    vkCmdBeginRenderPass(frame.cmd, &begin, VK_SUBPASS_CONTENTS_INLINE);
    ImGui_ImplVulkan_RenderDrawData(ImGui::GetDrawData(), frame.cmd);
    vkCmdEndRenderPass(frame.cmd);
}
