// SPDX-License-Identifier: Apache-2.0
#include "boxes.h"

#include "boxes.frag.inc"
#include "boxes.vert.inc"

namespace
{

// The push constants of boxes.vert.
struct Push {
    glm::mat4 clipFromWorld;
    glm::vec4 centreRoughness, halfSizeMetalness, baseColour;
};

constexpr VkShaderStageFlags pushStages = VK_SHADER_STAGE_VERTEX_BIT | VK_SHADER_STAGE_FRAGMENT_BIT;
constexpr VkFormat colourFormats[] = {gbufferDesc.normalRoughnessFormat, gbufferDesc.albedoFormat,
                                      gbufferDesc.specularFormat};

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

// Back faces are culled, so that every normal in the G-buffer faces the camera.
Boxes::Boxes(const Host& host)
    : device_(host.device),
      raster_(createRaster(device_, {.vertex = boxes_vert,
                                     .fragment = boxes_frag,
                                     .constants = {pushStages, 0, sizeof(Push)},
                                     .cullMode = VK_CULL_MODE_BACK_BIT,
                                     .colours = colourFormats,
                                     .depth = gbufferDesc.depthFormat}))
{
}

Boxes::~Boxes()
{
    destroyRaster(device_, raster_);
}

void Boxes::record(VkCommandBuffer cmd, const GBuffer& g, VkExtent2D size,
                   const glm::mat4& clipFromWorld) const
{
    const HostImage* colours[] = {&g.normal, &g.baseColour, &g.roughnessMetalness};
    VkRenderingAttachmentInfo attachments[3];
    for (int i = 0; i < 3; ++i) {
        imageBarrier(cmd, colours[i], overwritten, colourAttachment);
        // The old content of pixels does not matter, because depth tells which pixels are drawn.
        attachments[i] = attachment(*colours[i], colourAttachment.layout,
                                    VK_ATTACHMENT_LOAD_OP_DONT_CARE, VK_ATTACHMENT_STORE_OP_STORE);
    }
    imageBarrier(cmd, &g.depth, overwritten, depthAttachment);
    beginRaster(cmd, raster_, size, attachments,
                attachment(g.depth, depthAttachment.layout, VK_ATTACHMENT_LOAD_OP_CLEAR,
                           VK_ATTACHMENT_STORE_OP_STORE, {.depthStencil = {.depth = 1}}));
    const auto draw = [&](glm::vec3 centre, glm::vec3 halfSize, glm::vec3 colour,
                          float perceptualRoughness, float metalness) {
        const Push push{
            clipFromWorld, {centre, perceptualRoughness}, {halfSize, metalness}, {colour, 1}};
        vkCmdPushConstants(cmd, raster_.layout, pushStages, 0, sizeof push, &push);
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
        imageBarrier(cmd, colour, colourAttachment, sampledRead);
    imageBarrier(cmd, &g.depth, depthAttachment, sampledRead);
}
