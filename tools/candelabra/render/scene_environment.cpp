// SPDX-License-Identifier: Apache-2.0
#include "render/scene_environment.h"

#include <algorithm>
#include <bit>
#include <cmath>
#include <cstring>
#include <functional>

#include <fmt/format.h>

#include "gpu/memory.h"
#include "io/error.h"
#include "io/hash.h"
#include "render/check.h"
#include "render/image_barrier.h"

namespace candelabra::app
{
namespace
{

gpu::Buffer stage(const gpu::Device& device, const Image& image)
{
    const size_t pixels = size_t(image.width) * image.height;
    gpu::Buffer buffer =
        gpu::createBuffer(device, "environment staging", pixels * sizeof(glm::vec4),
                          VK_BUFFER_USAGE_TRANSFER_SRC_BIT, gpu::MemoryUse::Upload);
    const std::span<glm::vec4> out = buffer.as<glm::vec4>();
    const bool grey = image.channels == 1;
    for (size_t i = 0; i < pixels; ++i) {
        const float* in = &image.pixels[i * image.channels];
        out[i] = {in[0], in[grey ? 0 : 1], in[grey ? 0 : 2], 1};
    }
    return buffer;
}

// The side of a cube face that gives the cube map about as many texels around the horizon as the
// image has, between 64 and 1024.
uint32_t cubeSizeFor(const Image& image)
{
    return std::clamp(std::bit_ceil(std::max(image.width / 4, 1u)), 64u, 1024u);
}

// Uploads the image, lets the device prepare the environment, records what `more` records, and
// waits.
void prepare(const VulkanContext& context, const Image& radiance, const Environment& environment,
             const std::function<void(VkCommandBuffer)>& more)
{
    const gpu::Device& device = context.device();
    const gpu::Image image = gpu::createImage(
        device, "environment image", VK_FORMAT_R32G32B32A32_SFLOAT, radiance.width, radiance.height,
        VK_IMAGE_USAGE_SAMPLED_BIT | VK_IMAGE_USAGE_TRANSFER_DST_BIT, VK_IMAGE_ASPECT_COLOR_BIT);
    const gpu::Buffer staging = stage(device, radiance);
    context.submitAndWait([&](VkCommandBuffer cmd) {
        transition(cmd, image.image.get(), discarded, transferWrite);
        const VkBufferImageCopy copy{.imageSubresource = {VK_IMAGE_ASPECT_COLOR_BIT, 0, 0, 1},
                                     .imageExtent = {radiance.width, radiance.height, 1}};
        vkCmdCopyBufferToImage(cmd, staging.get(), image.image.get(),
                               VK_IMAGE_LAYOUT_TRANSFER_DST_OPTIMAL, 1, &copy);
        transition(cmd, image.image.get(), transferWrite, computeRead);
        take(environment.recordMap(cmd, {.width = radiance.width,
                                         .height = radiance.height,
                                         .equirectangular = image.view.get()}));
        if (more)
            more(cmd);
    });
}

// Adds what a driver states about itself and its device. Another one may round differently.
void addDevice(Hash& hash, const gpu::Device& device)
{
    VkPhysicalDeviceDriverProperties driver{
        .sType = VK_STRUCTURE_TYPE_PHYSICAL_DEVICE_DRIVER_PROPERTIES};
    VkPhysicalDeviceIDProperties ids{.sType = VK_STRUCTURE_TYPE_PHYSICAL_DEVICE_ID_PROPERTIES,
                                     .pNext = &driver};
    VkPhysicalDeviceProperties2 properties{.sType = VK_STRUCTURE_TYPE_PHYSICAL_DEVICE_PROPERTIES_2,
                                           .pNext = &ids};
    vkGetPhysicalDeviceProperties2(device.physicalDevice, &properties);
    VkPhysicalDeviceProperties& p = properties.properties;
    for (char* text : {p.deviceName, driver.driverName, driver.driverInfo})
        hash.add(std::span<const char>(text, std::strlen(text) + 1));
    for (const uint32_t number :
         {p.apiVersion, p.driverVersion, p.vendorID, p.deviceID, uint32_t(driver.driverID)})
        hash.add(number);
    for (uint8_t* uuid : {p.pipelineCacheUUID, ids.deviceUUID, ids.driverUUID})
        hash.add(std::span<const uint8_t>(uuid, VK_UUID_SIZE));
}

// The name in the cache of what `map` describes, prepared from this image on this device.
std::string cacheName(const gpu::Device& device, const Image& image,
                      const CndEnvironmentMapInfo& map)
{
    Hash content, maker;
    content.add(image.width);
    content.add(image.height);
    content.add(image.channels);
    content.add(std::span<const float>(image.pixels));
    maker.add(map.version);
    maker.add(map.size);
    addDevice(maker, device);
    return fmt::format("{:016x}-{:016x}.environment", content.value(), maker.value());
}

} // namespace

Environment uploadEnvironment(const VulkanContext& context, const SceneEnvironment& environment,
                              const EnvironmentOptions& options)
{
    const Image& radiance = environment.radiance;
    const gpu::Device& device = context.device();
    const uint32_t largest = device.limits.maxImageDimension2D;
    if (std::max(radiance.width, radiance.height) > largest)
        throw UsageError(fmt::format("the environment has {}x{} pixels, {} takes at most {} a side",
                                     radiance.width, radiance.height, context.info().name,
                                     largest));
    Environment out =
        take(Environment::create(context.desc(), {.framesInFlight = options.framesInFlight,
                                                  .gbufferLayout = options.gbufferLayout,
                                                  .cubeSize = cubeSizeFor(radiance),
                                                  .timestamps = VK_TRUE}));
    const CndEnvironmentMapInfo map = take(out.mapInfo());
    if (!options.cache.keeps()) {
        prepare(context, radiance, out, {});
        return out;
    }
    const std::string name = cacheName(device, radiance, map);
    const gpu::MemoryUse use = gpu::MemoryUse::Readback; // the host reads or writes all of it once
    const gpu::Buffer bytes =
        gpu::createBuffer(device, "prepared environment", map.size,
                          VK_BUFFER_USAGE_TRANSFER_SRC_BIT | VK_BUFFER_USAGE_TRANSFER_DST_BIT, use);
    const CndEnvironmentMapBuffer range{.buffer = bytes.get(), .size = map.size};
    const auto kept = options.cache.find(name);
    if (kept && kept->size() == map.size) {
        std::copy(kept->begin(), kept->end(), bytes.as<uint8_t>().begin());
        context.submitAndWait([&](VkCommandBuffer cmd) { take(out.recordMapLoad(cmd, range)); });
    } else {
        prepare(context, radiance, out,
                [&](VkCommandBuffer cmd) { take(out.recordMapSave(cmd, range)); });
        options.cache.store(name, bytes.as<const uint8_t>().first(map.size));
    }
    return out;
}

void setEnvironmentRotation(double rotation, float (&worldFromEnvironment)[9])
{
    const float c = float(std::cos(rotation)), s = float(std::sin(rotation));
    const float columns[9] = {c, 0, -s, 0, 1, 0, s, 0, c};
    std::copy_n(columns, 9, worldFromEnvironment);
}

} // namespace candelabra::app
