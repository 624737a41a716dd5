// SPDX-License-Identifier: Apache-2.0
// GpuTest: fixture for tests that need a Vulkan device. One headless context is shared by all tests
// of a process, with core and synchronisation validation on; any message fails the test it appeared
// in. CANDELABRA_TEST_DEVICE chooses the device (as --device); without a usable one tests are
// skipped loudly, or fail when CANDELABRA_REQUIRE_GPU is 1.
#pragma once

#include <cstring>
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
    void TearDown() override; // derived fixtures destroy their objects, then call this

    const app::VulkanContext& context() const;
    const gpu::Device& device() const { return context().device(); }
    const CndDeviceDesc& deviceDesc() const { return context().desc(); }

    // Messages since the last call, for tests that provoke them; they no longer fail the test.
    std::vector<app::ValidationMessage> takeMessages() const;

    // A host-visible buffer the GPU can use in any way, filled with `data`.
    gpu::Buffer upload(const std::string& name, std::span<const std::byte> data) const;
    template <typename T>
    gpu::Buffer upload(const std::string& name, const std::vector<T>& data) const
    {
        return upload(name, std::as_bytes(std::span(data)));
    }
    // A host-visible storage buffer of `size` zero bytes, to be read with Buffer::as<T>().
    gpu::Buffer readback(const std::string& name, VkDeviceSize size) const;
    // The texels of mip 0 of a colour or depth image in `layout`, which it keeps; rows from the
    // top.
    std::vector<std::byte> readImage(const gpu::Image& image, VkImageAspectFlags aspect,
                                     VkImageLayout layout, uint32_t bytesPerTexel) const;
};

// Makes all writes so far visible to everything after, for tests.
void fullBarrier(VkCommandBuffer cmd);
// Transition with the same strength.
void transition(VkCommandBuffer cmd, VkImage image, VkImageAspectFlags aspect, VkImageLayout from,
                VkImageLayout to);

} // namespace candelabra::test
