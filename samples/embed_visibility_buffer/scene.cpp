// SPDX-License-Identifier: Apache-2.0
#include "scene.h"

#include <cmath>
#include <cstring>
#include <numbers>
#include <vector>

#include <glm/gtc/matrix_transform.hpp>
#include <glm/gtc/type_ptr.hpp>

#include "ids_frag.h"
#include "plain_frag.h"
#include "scene_vert.h"

constexpr uint32_t rings = 16, sectors = 32; // of a ball
constexpr uint32_t floorIndices = 6, ballIndices = 6 * rings * sectors;
constexpr uint32_t ballCount = 24;
constexpr VkShaderStageFlags stages =
    VK_SHADER_STAGE_VERTEX_BIT | VK_SHADER_STAGE_FRAGMENT_BIT | VK_SHADER_STAGE_COMPUTE_BIT;
constexpr VkFormat idFormats[] = {VK_FORMAT_R32G32_UINT};
constexpr VkFormat gbufferFormats[] = {VK_FORMAT_R32G32_UINT, VK_FORMAT_R32G32_UINT,
                                       VK_FORMAT_R32G32_UINT}; // of CND_GBUFFER_FULL

// The floor, then a ball of radius 1.
static std::vector<Vertex> meshVertices()
{
    std::vector<Vertex> out;
    for (int corner = 0; corner < 4; ++corner)
        out.push_back({{corner & 1 ? 6 : -6, 0, corner & 2 ? 6 : -6}, {0, 1, 0}});
    for (uint32_t ring = 0; ring <= rings; ++ring)
        for (uint32_t sector = 0; sector <= sectors; ++sector) {
            const float polar = std::numbers::pi_v<float> * float(ring) / rings;
            const float around = 2 * std::numbers::pi_v<float> * float(sector) / sectors;
            const glm::vec3 at(std::sin(polar) * std::cos(around), std::cos(polar),
                               std::sin(polar) * std::sin(around));
            out.push_back({at, at});
        }
    return out;
}

static std::vector<uint32_t> meshIndices()
{
    std::vector<uint32_t> out{0, 2, 1, 1, 2, 3};
    for (uint32_t ring = 0; ring < rings; ++ring)
        for (uint32_t sector = 0; sector < sectors; ++sector) {
            const uint32_t first = 4 + ring * (sectors + 1) + sector, below = first + sectors + 1;
            out.insert(out.end(), {first, first + 1, below, below, first + 1, below + 1});
        }
    return out;
}

static std::vector<Object> sceneObjects()
{
    std::vector<Object> out{{glm::mat4x3(1), glm::vec3(0.5f), 0.4f}};
    for (uint32_t i = 0; i < ballCount; ++i) {
        const float angle = 2.39996f * float(i), far = 0.7f * std::sqrt(float(i) + 0.5f);
        const float radius = 0.2f + 0.04f * float(i % 5);
        const glm::vec3 centre(far * std::cos(angle), radius, far * std::sin(angle));
        const glm::mat4 placed =
            glm::scale(glm::translate(glm::mat4(1), centre), glm::vec3(radius));
        out.push_back({glm::mat4x3(placed),
                       {0.8f, 0.2f + 0.1f * float(i % 6), 0.3f},
                       0.15f + 0.1f * float(i % 8)});
    }
    return out;
}

template <typename T>
static HostBuffer bufferOf(const Host& host, const std::vector<T>& content)
{
    const HostBuffer buffer =
        createHostBuffer(&host, content.size() * sizeof(T), VK_BUFFER_USAGE_STORAGE_BUFFER_BIT);
    std::memcpy(buffer.mapped, content.data(), content.size() * sizeof(T));
    return buffer;
}

static HostBuffer cameraOf(const Host& host)
{
    const glm::mat4 viewFromWorld(glm::make_mat4(host.camera.viewFromWorld));
    const Camera camera{glm::make_mat4(host.camera.clipFromView) * viewFromWorld,
                        glm::mat3(viewFromWorld),
                        {host.width, host.height}};
    const HostBuffer buffer =
        createHostBuffer(&host, sizeof camera, VK_BUFFER_USAGE_UNIFORM_BUFFER_BIT);
    std::memcpy(buffer.mapped, &camera, sizeof camera);
    return buffer;
}

// The host draws with the set as set 0, and Candelabra's kernels read it as set 1.
static void createSet(const Host& host, Scene& scene)
{
    constexpr VkDescriptorType types[] = {
        VK_DESCRIPTOR_TYPE_STORAGE_BUFFER, VK_DESCRIPTOR_TYPE_STORAGE_BUFFER,
        VK_DESCRIPTOR_TYPE_STORAGE_BUFFER, VK_DESCRIPTOR_TYPE_UNIFORM_BUFFER,
        VK_DESCRIPTOR_TYPE_SAMPLED_IMAGE};
    constexpr uint32_t count = std::size(types);
    VkDescriptorSetLayoutBinding bindings[count];
    VkDescriptorPoolSize sizes[count];
    for (uint32_t i = 0; i < count; ++i) {
        bindings[i] = {i, types[i], 1, stages, nullptr};
        sizes[i] = {types[i], 1};
    }
    const VkDescriptorSetLayoutCreateInfo layout{
        .sType = VK_STRUCTURE_TYPE_DESCRIPTOR_SET_LAYOUT_CREATE_INFO,
        .bindingCount = count,
        .pBindings = bindings};
    checkVulkan(vkCreateDescriptorSetLayout(host.device, &layout, nullptr, &scene.setLayout),
                "vkCreateDescriptorSetLayout failed");
    const VkDescriptorPoolCreateInfo pool{.sType = VK_STRUCTURE_TYPE_DESCRIPTOR_POOL_CREATE_INFO,
                                          .maxSets = 1,
                                          .poolSizeCount = count,
                                          .pPoolSizes = sizes};
    checkVulkan(vkCreateDescriptorPool(host.device, &pool, nullptr, &scene.pool),
                "vkCreateDescriptorPool failed");
    const VkDescriptorSetAllocateInfo allocation{.sType =
                                                     VK_STRUCTURE_TYPE_DESCRIPTOR_SET_ALLOCATE_INFO,
                                                 .descriptorPool = scene.pool,
                                                 .descriptorSetCount = 1,
                                                 .pSetLayouts = &scene.setLayout};
    checkVulkan(vkAllocateDescriptorSets(host.device, &allocation, &scene.set),
                "vkAllocateDescriptorSets failed");
    const VkDescriptorBufferInfo buffers[] = {{scene.vertices.buffer, 0, VK_WHOLE_SIZE},
                                              {scene.indices.buffer, 0, VK_WHOLE_SIZE},
                                              {scene.objects.buffer, 0, VK_WHOLE_SIZE},
                                              {scene.camera.buffer, 0, VK_WHOLE_SIZE}};
    const VkDescriptorImageInfo image{VK_NULL_HANDLE, scene.ids.view, sampledRead.layout};
    for (uint32_t i = 0; i < count; ++i) {
        const VkWriteDescriptorSet write{.sType = VK_STRUCTURE_TYPE_WRITE_DESCRIPTOR_SET,
                                         .dstSet = scene.set,
                                         .dstBinding = i,
                                         .descriptorCount = 1,
                                         .descriptorType = types[i],
                                         .pImageInfo = &image,
                                         .pBufferInfo = i < 4 ? &buffers[i] : nullptr};
        vkUpdateDescriptorSets(host.device, 1, &write, 0, nullptr);
    }
}

Scene createScene(const Host& host)
{
    Scene scene{
        .ids = createHostImage(&host, idFormats[0], host.width, host.height,
                               VK_IMAGE_USAGE_COLOR_ATTACHMENT_BIT | VK_IMAGE_USAGE_SAMPLED_BIT),
        .vertices = bufferOf(host, meshVertices()),
        .indices = bufferOf(host, meshIndices()),
        .objects = bufferOf(host, sceneObjects()),
        .camera = cameraOf(host)};
    createSet(host, scene);
    RasterDesc desc{.vertex = scene_vert,
                    .fragment = ids_frag,
                    .setLayout = scene.setLayout,
                    .cullMode = VK_CULL_MODE_BACK_BIT,
                    .depthTest = VK_COMPARE_OP_GREATER, // reversed depth
                    .colours = idFormats};
    scene.visibility = createRaster(host.device, desc);
    desc.fragment = plain_frag;
    desc.colours = gbufferFormats;
    scene.plain = createRaster(host.device, desc);
    return scene;
}

void destroyScene(const Host& host, const Scene& scene)
{
    destroyRaster(host.device, scene.plain);
    destroyRaster(host.device, scene.visibility);
    vkDestroyDescriptorPool(host.device, scene.pool, nullptr);
    vkDestroyDescriptorSetLayout(host.device, scene.setLayout, nullptr);
    for (const HostBuffer& buffer : {scene.vertices, scene.indices, scene.objects, scene.camera})
        destroyHostBuffer(&host, buffer);
    destroyHostImage(&host, scene.ids);
}

static void clearRadiance(const Host& host)
{
    constexpr ImageUse cleared{VK_IMAGE_LAYOUT_TRANSFER_DST_OPTIMAL, VK_PIPELINE_STAGE_2_CLEAR_BIT,
                               VK_ACCESS_2_TRANSFER_WRITE_BIT};
    constexpr ImageUse storage{VK_IMAGE_LAYOUT_GENERAL, VK_PIPELINE_STAGE_2_COMPUTE_SHADER_BIT,
                               VK_ACCESS_2_SHADER_STORAGE_READ_BIT |
                                   VK_ACCESS_2_SHADER_STORAGE_WRITE_BIT};
    const VkClearColorValue black{};
    const VkImageSubresourceRange all{VK_IMAGE_ASPECT_COLOR_BIT, 0, 1, 0, 1};
    imageBarrier(host.cmd, &host.radiance, overwritten, cleared);
    vkCmdClearColorImage(host.cmd, host.radiance.image, cleared.layout, &black, 1, &all);
    imageBarrier(host.cmd, &host.radiance, cleared, storage);
}

static void draw(const Host& host, const Scene& scene, const Raster& raster,
                 std::span<const HostImage> images)
{
    clearRadiance(host);
    std::vector<VkRenderingAttachmentInfo> colours;
    for (const HostImage& image : images) {
        imageBarrier(host.cmd, &image, overwritten, colourAttachment);
        // The old content of pixels does not matter, because depth tells which pixels are drawn.
        colours.push_back(attachment(image, colourAttachment.layout,
                                     VK_ATTACHMENT_LOAD_OP_DONT_CARE,
                                     VK_ATTACHMENT_STORE_OP_STORE));
    }
    imageBarrier(host.cmd, &host.depth, overwritten, depthAttachment);
    beginRaster(host.cmd, raster, {host.width, host.height}, colours,
                attachment(host.depth, depthAttachment.layout, VK_ATTACHMENT_LOAD_OP_CLEAR,
                           VK_ATTACHMENT_STORE_OP_STORE, {.depthStencil = {.depth = 0}}));
    vkCmdBindDescriptorSets(host.cmd, VK_PIPELINE_BIND_POINT_GRAPHICS, raster.layout, 0, 1,
                            &scene.set, 0, nullptr);
    vkCmdDraw(host.cmd, floorIndices, 1, 0, 0);
    vkCmdDraw(host.cmd, ballIndices, ballCount, floorIndices, 1);
    vkCmdEndRendering(host.cmd);
    for (const HostImage& image : images)
        imageBarrier(host.cmd, &image, colourAttachment, sampledRead);
    imageBarrier(host.cmd, &host.depth, depthAttachment, sampledRead);
}

void drawIds(const Host& host, const Scene& scene)
{
    draw(host, scene, scene.visibility, {&scene.ids, 1});
}

void drawGBuffer(const Host& host, const Scene& scene)
{
    const HostImage images[] = {host.normalRoughness, host.albedo, host.specular};
    draw(host, scene, scene.plain, images);
}
