// SPDX-License-Identifier: Apache-2.0
// The samples in C++ share this in addition to host.h: uses of images, and pipelines and passes of
// the samples' own.
#pragma once

#include <span>

#include <candelabra/candelabra.hpp>

#include "host.h"

inline CndDeviceDesc deviceOf(const Host& host)
{
    return {.instance = host.instance,
            .physicalDevice = host.physicalDevice,
            .device = host.device,
            .getInstanceProcAddr = vkGetInstanceProcAddr};
}

// Describes the G-buffer that drawWall() draws.
inline CndLightingFrame wallFrame(const Host& host)
{
    return {.width = host.width,
            .height = host.height,
            .camera = host.camera,
            .clearDepth = 0,
            .normalRoughness = host.normalRoughness.view,
            .albedo = host.albedo.view,
            .specular = host.specular.view,
            .depth = host.depth.view,
            .radiance = host.radiance.view,
            .specularMethod = CND_SPECULAR_CONIC};
}

// Layout, stage and access of images at the places where they are used.
constexpr ImageUse colourAttachment{
    VK_IMAGE_LAYOUT_COLOR_ATTACHMENT_OPTIMAL, VK_PIPELINE_STAGE_2_COLOR_ATTACHMENT_OUTPUT_BIT,
    VK_ACCESS_2_COLOR_ATTACHMENT_READ_BIT | VK_ACCESS_2_COLOR_ATTACHMENT_WRITE_BIT};
constexpr ImageUse depthAttachment{
    VK_IMAGE_LAYOUT_DEPTH_ATTACHMENT_OPTIMAL,
    VK_PIPELINE_STAGE_2_EARLY_FRAGMENT_TESTS_BIT | VK_PIPELINE_STAGE_2_LATE_FRAGMENT_TESTS_BIT,
    VK_ACCESS_2_DEPTH_STENCIL_ATTACHMENT_READ_BIT | VK_ACCESS_2_DEPTH_STENCIL_ATTACHMENT_WRITE_BIT};
// Overwritten, after compute shaders of the previous frame have read it.
constexpr ImageUse overwritten{VK_IMAGE_LAYOUT_UNDEFINED, VK_PIPELINE_STAGE_2_COMPUTE_SHADER_BIT,
                               0};
constexpr ImageUse sampledRead{VK_IMAGE_LAYOUT_SHADER_READ_ONLY_OPTIMAL,
                               VK_PIPELINE_STAGE_2_COMPUTE_SHADER_BIT,
                               VK_ACCESS_2_SHADER_SAMPLED_READ_BIT};
constexpr ImageUse storageWrite{VK_IMAGE_LAYOUT_GENERAL, VK_PIPELINE_STAGE_2_COMPUTE_SHADER_BIT,
                                VK_ACCESS_2_SHADER_STORAGE_WRITE_BIT};

// A pipeline of a sample's own.
struct RasterDesc {
    std::span<const uint32_t> vertex, fragment; // SPIR-V; the fragment shader may be missing
    VkDescriptorSetLayout setLayout = VK_NULL_HANDLE;
    VkPushConstantRange constants{};                               // of size 0: none
    std::span<const VkVertexInputAttributeDescription> attributes; // of vertex buffer 0
    uint32_t vertexBytes = 0; // from one vertex to the next; 0: there is no vertex buffer
    VkPrimitiveTopology topology = VK_PRIMITIVE_TOPOLOGY_TRIANGLE_LIST;
    VkCullModeFlags cullMode = VK_CULL_MODE_NONE; // front faces are counter-clockwise
    VkCompareOp depthTest = VK_COMPARE_OP_LESS;
    VkBool32 depthWrite = VK_TRUE;
    VkPipelineColorBlendAttachmentState blend{.colorWriteMask = 0xF};
    std::span<const VkFormat> colours;
    VkFormat depth = VK_FORMAT_D32_SFLOAT;
    VkRenderPass renderPass = VK_NULL_HANDLE; // null: the formats are those of dynamic rendering
};

struct Raster {
    VkPipelineLayout layout;
    VkPipeline pipeline;
};

Raster createRaster(VkDevice device, const RasterDesc& desc);
void destroyRaster(VkDevice device, const Raster& raster);

// Binds the pipeline and sets its viewport.
void bindRaster(VkCommandBuffer cmd, const Raster& raster, VkExtent2D size);

// Begins dynamic rendering with a pipeline.
void beginRaster(VkCommandBuffer cmd, const Raster& raster, VkExtent2D size,
                 std::span<const VkRenderingAttachmentInfo> colours,
                 const VkRenderingAttachmentInfo& depth);

inline VkRenderingAttachmentInfo attachment(const HostImage& image, VkImageLayout layout,
                                            VkAttachmentLoadOp load, VkAttachmentStoreOp store,
                                            VkClearValue clear = {})
{
    return {.sType = VK_STRUCTURE_TYPE_RENDERING_ATTACHMENT_INFO,
            .imageView = image.view,
            .imageLayout = layout,
            .loadOp = load,
            .storeOp = store,
            .clearValue = clear};
}
