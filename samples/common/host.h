// SPDX-License-Identifier: Apache-2.0
// The Vulkan program into which the headless samples integrate Candelabra: a device, a G-buffer
// that shows a wall, one command buffer. A real renderer has all of this already. Vulkan errors end
// the program with a message, because this is a sample.
#ifndef CANDELABRA_SAMPLES_HOST_H
#define CANDELABRA_SAMPLES_HOST_H

#include <candelabra/candelabra.h>
#include <vulkan/vulkan.h>

#ifdef __cplusplus
extern "C" {
#endif

typedef struct HostImage {
    VkImage image;
    VkFormat format;
    VkDeviceMemory memory;
    VkImageView view;
    VkImageAspectFlags aspect;
} HostImage;

typedef struct HostBuffer {
    VkBuffer buffer;
    VkDeviceMemory memory;
    void* mapped;
} HostBuffer;

typedef struct Host {
    VkInstance instance;
    VkPhysicalDevice physicalDevice;
    VkDevice device;
    uint32_t queueFamily;
    VkQueue queue;
    VkCommandPool pool;
    VkCommandBuffer cmd;
    uint32_t width, height;
    CndCamera camera; // at the world's origin, looks along -z, reversed depth
    HostImage normalRoughness, albedo, specular, depth, radiance, display;
} Host;

// The wall fills the picture, faces the camera and is matt.
#define WALL_DISTANCE 2.0f // metres
#define WALL_ALBEDO 0.5f
#define WALL_ALBEDO_CODE 0x1BFFFFu // what cndPackAlbedoFull() of lib/gbuffer.glsl makes of it

Host createHost(uint32_t width, uint32_t height);
void destroyHost(Host* host);

// The parts of createHost, for samples that draw something else: everything but the images, with
// instance and device extensions for a window (a count of 0: none); and 2D images, which can also
// be cleared and copied. The view of an image with stencil is of its depth aspect.
void createHostDevice(Host* host, uint32_t instanceExtensionCount,
                      const char* const* instanceExtensions, uint32_t deviceExtensionCount,
                      const char* const* deviceExtensions);
void destroyHostDevice(Host* host);
HostImage createHostImage(const Host* host, VkFormat format, uint32_t width, uint32_t height,
                          VkImageUsageFlags usage);
void destroyHostImage(const Host* host, HostImage image);
HostBuffer createHostBuffer(const Host* host, VkDeviceSize size, VkBufferUsageFlags usage);
void destroyHostBuffer(const Host* host, HostBuffer buffer);
// Ends the program with a message unless `result` is VK_SUCCESS.
void checkVulkan(VkResult result, const char* what);

// Begins the host's command buffer.
VkCommandBuffer beginFrame(Host* host);
// The G-buffer pass. Leaves its images in the state that CndLightingFrame requires, radiance black,
// and display ready to be written.
void drawWall(Host* host);
// Submits the command buffer and waits until it has finished.
void endFrame(Host* host);

// A use of an image: its layout, and the stage and access that a barrier waits for or makes
// visible.
typedef struct ImageUse {
    VkImageLayout layout;
    VkPipelineStageFlags2 stage;
    VkAccessFlags2 access;
} ImageUse;
void imageBarrier(VkCommandBuffer cmd, const HostImage* image, ImageUse from, ImageUse to);

// Records a copy of a region of an image, which is a source of transfers, to a buffer that the
// program reads when the commands have finished.
void copyToHost(VkCommandBuffer cmd, const HostImage* image, VkOffset3D offset, VkExtent3D extent,
                const HostBuffer* buffer);

// Copies all pixels of an image to `pixels`, `size` bytes in total, rows from the top. Call it
// after endFrame().
void readPixels(Host* host, const HostImage* image, ImageUse written, void* pixels, size_t size);
// Copies the pixel in the middle, `size` bytes.
void readCentre(Host* host, const HostImage* image, VkImageLayout layout, void* pixel, size_t size);

#ifdef __cplusplus
}
#endif
#endif
