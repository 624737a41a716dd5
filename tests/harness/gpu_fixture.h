// SPDX-License-Identifier: Apache-2.0
// GpuTest: the fixture of tests that need a Vulkan device. All tests of a process share one
// headless context with core and synchronisation validation enabled, and equal pipelines
// (pipeline_store.h); any validation message fails the test in which it appeared.
// CANDELABRA_TEST_VALIDATION=0 runs the tests without validation, on machines that lack the layer.
// CANDELABRA_TEST_DEVICE chooses the device (as --device does). Without a usable device the tests
// are skipped with a message, or fail if CANDELABRA_REQUIRE_GPU is 1.
#pragma once

#include <cstring>
#include <functional>
#include <span>
#include <string>
#include <vector>

#include <gtest/gtest.h>

#include "gpu/memory.h"
#include "render/vulkan_context.h"

namespace candelabra::test
{

class GpuTest : public ::testing::Test
{
protected:
    void SetUp() override;
    void TearDown() override; // derived fixtures destroy their objects first, then call this

    const app::VulkanContext& context() const;
    const gpu::Device& device() const { return context().device(); }
    const CndDeviceDesc& deviceDesc() const { return context().desc(); }

    // Returns the messages since the last call, for tests that provoke them; they no longer fail
    // the test.
    std::vector<app::ValidationMessage> takeMessages() const;

    // Has `destroy` called after the last test, before the device is destroyed.
    static void destroyAfterTests(std::function<void()> destroy);

    // Returns a host-visible buffer, usable by the GPU in any way, filled with `data`.
    gpu::Buffer upload(const std::string& name, std::span<const std::byte> data) const;
    template <typename T>
    gpu::Buffer upload(const std::string& name, const std::vector<T>& data) const
    {
        return upload(name, std::as_bytes(std::span(data)));
    }
    // Returns a host-visible storage buffer of `size` zero bytes, to be read with Buffer::as<T>().
    gpu::Buffer readback(const std::string& name, VkDeviceSize size) const;
    // Returns the texels of mip level 0 of a colour or depth image, rows from the top. The image is
    // in `layout` and stays in it.
    std::vector<std::byte> readImage(const gpu::Image& image, VkImageAspectFlags aspect,
                                     VkImageLayout layout, uint32_t bytesPerTexel) const;
};

// Tells whether tests run with validation.
bool validates();

// Makes all earlier writes visible to everything later.
void fullBarrier(VkCommandBuffer cmd);
// A layout transition that waits and makes visible like fullBarrier.
void transition(VkCommandBuffer cmd, VkImage image, VkImageAspectFlags aspect, VkImageLayout from,
                VkImageLayout to);

} // namespace candelabra::test
