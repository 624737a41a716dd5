// SPDX-License-Identifier: Apache-2.0
// Prepared maps of the environment module as bytes in buffers of the host.
#include <string>

#include "candelabra_shaders.h"
#include "environment/environment.h"

namespace candelabra::environment
{
namespace
{

// Part of CndEnvironmentMapInfo::version. It changes when other code than that of the kernels
// changes what a prepared map is.
constexpr uint64_t hostVersion = 1;

constexpr VkDeviceSize texelBytes = 4 * sizeof(float);
constexpr uint32_t faces = 6;

// One mip level of a cube map, all faces.
struct MapPart {
    const gpu::CubeImage& cube;
    uint32_t level;
    VkBufferImageCopy region;
};

MapPart partOf(const gpu::CubeImage& cube, uint32_t level, uint32_t size, VkDeviceSize offset)
{
    return {cube,
            level,
            {.bufferOffset = offset,
             .imageSubresource = {VK_IMAGE_ASPECT_COLOR_BIT, level, 0, faces},
             .imageExtent = {size, size, 1}}};
}

VkDeviceSize bytesOf(const MapPart& part)
{
    const VkDeviceSize side = part.region.imageExtent.width;
    return faces * side * side * texelBytes;
}

// Moves a cube map from one layout to another, between compute shaders and transfers.
void recordLayout(const gpu::Frame& f, const gpu::CubeImage& cube, VkImageLayout from,
                  VkImageLayout to)
{
    constexpr VkPipelineStageFlags stages =
        VK_PIPELINE_STAGE_COMPUTE_SHADER_BIT | VK_PIPELINE_STAGE_TRANSFER_BIT;
    const VkImageMemoryBarrier barrier{
        .sType = VK_STRUCTURE_TYPE_IMAGE_MEMORY_BARRIER,
        .srcAccessMask = VK_ACCESS_SHADER_WRITE_BIT | VK_ACCESS_TRANSFER_WRITE_BIT,
        .dstAccessMask = VK_ACCESS_SHADER_READ_BIT | VK_ACCESS_SHADER_WRITE_BIT |
                         VK_ACCESS_TRANSFER_READ_BIT | VK_ACCESS_TRANSFER_WRITE_BIT,
        .oldLayout = from,
        .newLayout = to,
        .srcQueueFamilyIndex = VK_QUEUE_FAMILY_IGNORED,
        .dstQueueFamilyIndex = VK_QUEUE_FAMILY_IGNORED,
        .image = cube.image.get(),
        .subresourceRange = {VK_IMAGE_ASPECT_COLOR_BIT, 0, VK_REMAINING_MIP_LEVELS, 0,
                             VK_REMAINING_ARRAY_LAYERS}};
    f.device.CmdPipelineBarrier(f.cmd, stages, stages, 0, 0, nullptr, 0, nullptr, 1, &barrier);
}

// Like FNV-1a (Fowler, Noll and Vo 1991), but of whole words and numbers in place of bytes.
uint64_t hashOf(std::initializer_list<gpu::Spirv> kernels, std::initializer_list<uint64_t> numbers)
{
    uint64_t hash = 0xcbf29ce484222325;
    const auto add = [&](uint64_t value) { hash = (hash ^ value) * 0x100000001b3; };
    for (const gpu::Spirv& kernel : kernels)
        for (const uint32_t word : kernel.words)
            add(word);
    for (const uint64_t number : numbers)
        add(number);
    return hash;
}

} // namespace

template <typename Copy>
void Environment::forEachMapPart(VkDeviceSize offset, const Copy& copy) const
{
    const auto next = [&](const gpu::CubeImage& cube, uint32_t level, uint32_t size) {
        const MapPart part = partOf(cube, level, size, offset);
        offset += bytesOf(part);
        copy(part);
    };
    for (uint32_t mip = 0; mip < source_.mips.size(); ++mip)
        next(source_, mip, desc_.cubeSize >> mip);
    // Level 0 is the same as that of the source.
    for (uint32_t level = 1; level < prefiltered_.mips.size(); ++level)
        next(prefiltered_, level, desc_.cubeSize >> level);
    next(irradiance_, 0, gpu::ENVIRONMENT_IRRADIANCE_SIZE);
}

void Environment::readMapInfo(CndEnvironmentMapInfo& info) const
{
    if (info.structSize != sizeof info)
        gpu::failArgument("CndEnvironmentMapInfo: structSize is " +
                          std::to_string(info.structSize) + ", this library expects " +
                          std::to_string(sizeof info));
    info.size = 0;
    forEachMapPart(0, [&](const MapPart& part) { info.size += bytesOf(part); });
    info.version =
        hashOf({spirv::environment_cube_comp, spirv::environment_mip_comp,
                spirv::environment_prefilter_comp, spirv::environment_irradiance_comp},
               {hostVersion, desc_.cubeSize, source_.mips.size(), prefiltered_.mips.size()});
}

void Environment::requireMapBuffer(const CndEnvironmentMapBuffer& buffer) const
{
    if (buffer.structSize != sizeof buffer)
        gpu::failArgument("CndEnvironmentMapBuffer: structSize is " +
                          std::to_string(buffer.structSize) + ", this library expects " +
                          std::to_string(sizeof buffer));
    if (!buffer.buffer)
        gpu::failArgument("CndEnvironmentMapBuffer: buffer is null");
    if (buffer.offset % texelBytes)
        gpu::failArgument("CndEnvironmentMapBuffer: offset must be a multiple of 16, is " +
                          std::to_string(buffer.offset));
    CndEnvironmentMapInfo info{.structSize = sizeof info};
    readMapInfo(info);
    if (buffer.size != info.size)
        gpu::failArgument("CndEnvironmentMapBuffer: size is " + std::to_string(buffer.size) +
                          ", a prepared map has " + std::to_string(info.size) + " bytes");
}

void Environment::recordMapSave(VkCommandBuffer cmd, const CndEnvironmentMapBuffer& to)
{
    requireMapBuffer(to);
    if (!mapped_)
        gpu::failArgument("cndRecordEnvironmentMapSave: cndRecordEnvironmentMap or "
                          "cndRecordEnvironmentMapLoad must be recorded first");
    gpu::Timer untimed;
    const gpu::Frame f{device_, cmd, untimed, mapSlot()};
    constexpr VkImageLayout copied = VK_IMAGE_LAYOUT_TRANSFER_SRC_OPTIMAL;
    for (const gpu::CubeImage* cube : {&source_, &prefiltered_, &irradiance_})
        recordLayout(f, *cube, VK_IMAGE_LAYOUT_GENERAL, copied);
    forEachMapPart(to.offset, [&](const MapPart& part) {
        device_.CmdCopyImageToBuffer(cmd, part.cube.image.get(), copied, to.buffer, 1,
                                     &part.region);
    });
    for (const gpu::CubeImage* cube : {&source_, &prefiltered_, &irradiance_})
        recordLayout(f, *cube, copied, VK_IMAGE_LAYOUT_GENERAL);
    f.hostBarrier();
}

void Environment::recordMapLoad(VkCommandBuffer cmd, const CndEnvironmentMapBuffer& from)
{
    requireMapBuffer(from);
    const gpu::Frame f{device_, cmd, timer_, mapSlot()};
    recordMapBegin(f);
    constexpr VkImageLayout copied = VK_IMAGE_LAYOUT_TRANSFER_DST_OPTIMAL;
    for (const gpu::CubeImage* cube : {&source_, &prefiltered_, &irradiance_})
        recordLayout(f, *cube, VK_IMAGE_LAYOUT_GENERAL, copied);
    const auto load = [&](const MapPart& part) {
        device_.CmdCopyBufferToImage(cmd, from.buffer, part.cube.image.get(), copied, 1,
                                     &part.region);
    };
    forEachMapPart(from.offset, load);
    load(partOf(prefiltered_, 0, desc_.cubeSize, from.offset));
    for (const gpu::CubeImage* cube : {&source_, &prefiltered_, &irradiance_})
        recordLayout(f, *cube, copied, VK_IMAGE_LAYOUT_GENERAL);
    f.barrier();
    device_.endLabel(cmd);
    mapped_ = true;
}

} // namespace candelabra::environment
