// SPDX-License-Identifier: Apache-2.0
#include "harness/gpu_fixture.h"

#include <cstdlib>
#include <iostream>
#include <memory>
#include <optional>

#include "harness/pipeline_store.h"
#include "render/check.h"

namespace candelabra::test
{
namespace
{

// Validation messages that are faults of the layer itself, by exact id, each with its proof beside
// it. There are none so far.
bool isLayerFault(const app::ValidationMessage&)
{
    return false;
}

void failOnMessages(const std::vector<app::ValidationMessage>& messages)
{
    for (const app::ValidationMessage& m : messages)
        if (!isLayerFault(m))
            ADD_FAILURE() << "validation: " << m.id << "\n" << m.text;
}

// Owns the context, so that it is destroyed, and leaks are reported, before the process ends.
class ContextOwner : public ::testing::Environment
{
public:
    // Returns null if there is no usable device; `reason` then tells why.
    const app::VulkanContext* get()
    {
        if (context_ || !reason.empty())
            return context_.get();
        const char* wanted = std::getenv("CANDELABRA_TEST_DEVICE");
        try {
            context_ = std::make_unique<app::VulkanContext>(app::ContextOptions{
                .device = wanted ? wanted : "",
                .validation = validates() ? app::Validation::On : app::Validation::Off,
                .engineFunctions = PipelineStore::functions});
            store_.emplace(context_->desc().device);
            std::cout << "device: " << context_->info().name << ", " << context_->info().driver
                      << "\n";
        } catch (const gpu::Failure& failure) {
            reason = failure.message;
        } catch (const std::exception& error) {
            reason = error.what();
        }
        return context_.get();
    }
    void TearDown() override
    {
        if (!context_)
            return;
        for (const std::function<void()>& destroy : destroyers)
            destroy();
        store_.reset();
        // The log must outlive the device, to receive messages about objects that were not
        // destroyed.
        context_->destroyDevice();
        failOnMessages(context_->instance().messages().take());
        context_.reset();
    }
    std::string reason;
    std::vector<std::function<void()>> destroyers;

private:
    std::unique_ptr<app::VulkanContext> context_;
    std::optional<PipelineStore> store_;
};

ContextOwner& owner()
{
    // GoogleTest deletes its environments. The initialiser of `registered` below adds this one
    // before main.
    static auto* const environment =
        static_cast<ContextOwner*>(::testing::AddGlobalTestEnvironment(new ContextOwner));
    return *environment;
}
const ContextOwner& registered = owner();

VkBufferUsageFlags anyUsage()
{
    return VK_BUFFER_USAGE_STORAGE_BUFFER_BIT | VK_BUFFER_USAGE_UNIFORM_BUFFER_BIT |
           VK_BUFFER_USAGE_UNIFORM_TEXEL_BUFFER_BIT | VK_BUFFER_USAGE_TRANSFER_SRC_BIT |
           VK_BUFFER_USAGE_TRANSFER_DST_BIT | VK_BUFFER_USAGE_INDIRECT_BUFFER_BIT |
           VK_BUFFER_USAGE_VERTEX_BUFFER_BIT | VK_BUFFER_USAGE_INDEX_BUFFER_BIT;
}

constexpr VkMemoryBarrier2 everything{
    .sType = VK_STRUCTURE_TYPE_MEMORY_BARRIER_2,
    .srcStageMask = VK_PIPELINE_STAGE_2_ALL_COMMANDS_BIT,
    .srcAccessMask = VK_ACCESS_2_MEMORY_WRITE_BIT,
    .dstStageMask = VK_PIPELINE_STAGE_2_ALL_COMMANDS_BIT | VK_PIPELINE_STAGE_2_HOST_BIT,
    .dstAccessMask =
        VK_ACCESS_2_MEMORY_READ_BIT | VK_ACCESS_2_MEMORY_WRITE_BIT | VK_ACCESS_2_HOST_READ_BIT};

} // namespace

bool validates()
{
    const char* value = std::getenv("CANDELABRA_TEST_VALIDATION");
    return !value || std::strcmp(value, "0") != 0;
}

void GpuTest::SetUp()
{
    if (const app::VulkanContext* context = owner().get()) {
        failOnMessages(context->instance().messages().take());
        return;
    }
    const char* required = std::getenv("CANDELABRA_REQUIRE_GPU");
    if (required && std::strcmp(required, "1") == 0)
        FAIL() << "CANDELABRA_REQUIRE_GPU=1, but: " << owner().reason;
    std::cerr << "SKIPPED, NOTHING TESTED: " << owner().reason << "\n";
    GTEST_SKIP() << owner().reason;
}

void GpuTest::TearDown()
{
    const app::VulkanContext* context = owner().get();
    if (!context)
        return;
    vkDeviceWaitIdle(context->desc().device);
    failOnMessages(context->instance().messages().take());
}

const app::VulkanContext& GpuTest::context() const
{
    return *owner().get();
}

void GpuTest::destroyAfterTests(std::function<void()> destroy)
{
    owner().destroyers.push_back(std::move(destroy));
}

std::vector<app::ValidationMessage> GpuTest::takeMessages() const
{
    return context().instance().messages().take();
}

gpu::Buffer GpuTest::upload(const std::string& name, std::span<const std::byte> data) const
{
    gpu::Buffer buffer =
        createBuffer(device(), name, data.size(), anyUsage(), gpu::MemoryUse::Upload);
    if (!data.empty())
        std::memcpy(buffer.mapped, data.data(), data.size());
    return buffer;
}

gpu::Buffer GpuTest::readback(const std::string& name, VkDeviceSize size) const
{
    gpu::Buffer buffer = createBuffer(device(), name, size, anyUsage(), gpu::MemoryUse::Readback);
    std::memset(buffer.mapped, 0, size);
    return buffer;
}

std::vector<std::byte> GpuTest::readImage(const gpu::Image& image, VkImageAspectFlags aspect,
                                          VkImageLayout layout, uint32_t bytesPerTexel) const
{
    const VkDeviceSize size = VkDeviceSize(image.width) * image.height * bytesPerTexel;
    const gpu::Buffer buffer = readback("test readback", size);
    context().submitAndWait([&](VkCommandBuffer cmd) {
        transition(cmd, image.image.get(), aspect, layout, VK_IMAGE_LAYOUT_TRANSFER_SRC_OPTIMAL);
        const VkBufferImageCopy region{.imageSubresource = {aspect, 0, 0, 1},
                                       .imageExtent = {image.width, image.height, 1}};
        vkCmdCopyImageToBuffer(cmd, image.image.get(), VK_IMAGE_LAYOUT_TRANSFER_SRC_OPTIMAL,
                               buffer.get(), 1, &region);
        if (layout != VK_IMAGE_LAYOUT_UNDEFINED)
            transition(cmd, image.image.get(), aspect, VK_IMAGE_LAYOUT_TRANSFER_SRC_OPTIMAL,
                       layout);
        fullBarrier(cmd);
    });
    return {buffer.mapped, buffer.mapped + size};
}

void fullBarrier(VkCommandBuffer cmd)
{
    const VkDependencyInfo dependency{.sType = VK_STRUCTURE_TYPE_DEPENDENCY_INFO,
                                      .memoryBarrierCount = 1,
                                      .pMemoryBarriers = &everything};
    vkCmdPipelineBarrier2(cmd, &dependency);
}

void transition(VkCommandBuffer cmd, VkImage image, VkImageAspectFlags aspect, VkImageLayout from,
                VkImageLayout to)
{
    const VkImageMemoryBarrier2 barrier{
        .sType = VK_STRUCTURE_TYPE_IMAGE_MEMORY_BARRIER_2,
        .srcStageMask = VK_PIPELINE_STAGE_2_ALL_COMMANDS_BIT,
        .srcAccessMask = VK_ACCESS_2_MEMORY_WRITE_BIT,
        .dstStageMask = VK_PIPELINE_STAGE_2_ALL_COMMANDS_BIT,
        .dstAccessMask = VK_ACCESS_2_MEMORY_READ_BIT | VK_ACCESS_2_MEMORY_WRITE_BIT,
        .oldLayout = from,
        .newLayout = to,
        .srcQueueFamilyIndex = VK_QUEUE_FAMILY_IGNORED,
        .dstQueueFamilyIndex = VK_QUEUE_FAMILY_IGNORED,
        .image = image,
        .subresourceRange = {aspect, 0, VK_REMAINING_MIP_LEVELS, 0, 1}};
    const VkDependencyInfo dependency{.sType = VK_STRUCTURE_TYPE_DEPENDENCY_INFO,
                                      .imageMemoryBarrierCount = 1,
                                      .pImageMemoryBarriers = &barrier};
    vkCmdPipelineBarrier2(cmd, &dependency);
}

} // namespace candelabra::test
