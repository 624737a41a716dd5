// SPDX-License-Identifier: Apache-2.0
// Frames that really overlap: three slots, two views on one light set, sets that grow and shrink
// while earlier frames are still on the GPU. Every image must be that of a fresh, lone frame.
#include "gpu/lighting_harness.h"

#include <array>
#include <map>

namespace candelabra::test
{
namespace
{

constexpr uint32_t slotCount = 3;

// Command buffer, fence and read-back buffers of a frame in flight.
struct Slot {
    VkCommandBuffer cmd{};
    VkFence fence{};
    gpu::Buffer images[2];
    uint32_t set = 0; // which light set it drew
    bool used = false;
};

} // namespace

class FramesInFlight : public LightingTest
{
protected:
    void SetUp() override
    {
        LightingTest::SetUp();
        const VkCommandPoolCreateInfo poolInfo{.sType = VK_STRUCTURE_TYPE_COMMAND_POOL_CREATE_INFO,
                                               .flags =
                                                   VK_COMMAND_POOL_CREATE_RESET_COMMAND_BUFFER_BIT,
                                               .queueFamilyIndex = context().queueFamily()};
        ASSERT_EQ(vkCreateCommandPool(handle(), &poolInfo, nullptr, &pool_), VK_SUCCESS);
        for (Slot& slot : slots_) {
            const VkCommandBufferAllocateInfo info{
                .sType = VK_STRUCTURE_TYPE_COMMAND_BUFFER_ALLOCATE_INFO,
                .commandPool = pool_,
                .level = VK_COMMAND_BUFFER_LEVEL_PRIMARY,
                .commandBufferCount = 1};
            ASSERT_EQ(vkAllocateCommandBuffers(handle(), &info, &slot.cmd), VK_SUCCESS);
            const VkFenceCreateInfo fence{.sType = VK_STRUCTURE_TYPE_FENCE_CREATE_INFO};
            ASSERT_EQ(vkCreateFence(handle(), &fence, nullptr, &slot.fence), VK_SUCCESS);
        }
    }
    void TearDown() override
    {
        context().waitIdle();
        for (Slot& slot : slots_) {
            vkDestroyFence(handle(), slot.fence, nullptr);
            slot = {};
        }
        vkDestroyCommandPool(handle(), pool_, nullptr);
        LightingTest::TearDown();
    }
    VkDevice handle() const { return deviceDesc().device; }

    void wait(Slot& slot)
    {
        ASSERT_EQ(vkWaitForFences(handle(), 1, &slot.fence, VK_TRUE, UINT64_MAX), VK_SUCCESS);
        ASSERT_EQ(vkResetFences(handle(), 1, &slot.fence), VK_SUCCESS);
    }
    void submit(Slot& slot)
    {
        ASSERT_EQ(vkEndCommandBuffer(slot.cmd), VK_SUCCESS);
        const VkSubmitInfo info{.sType = VK_STRUCTURE_TYPE_SUBMIT_INFO,
                                .commandBufferCount = 1,
                                .pCommandBuffers = &slot.cmd};
        ASSERT_EQ(vkQueueSubmit(context().queue(), 1, &info, slot.fence), VK_SUCCESS);
        slot.used = true;
    }
    static void copyRadiance(VkCommandBuffer cmd, const Images& images, const gpu::Buffer& to)
    {
        const VkImage image = images.radiance.image.get();
        transition(cmd, image, VK_IMAGE_ASPECT_COLOR_BIT, VK_IMAGE_LAYOUT_GENERAL,
                   VK_IMAGE_LAYOUT_TRANSFER_SRC_OPTIMAL);
        const VkBufferImageCopy copy{
            .imageSubresource = {VK_IMAGE_ASPECT_COLOR_BIT, 0, 0, 1},
            .imageExtent = {images.radiance.width, images.radiance.height, 1}};
        vkCmdCopyImageToBuffer(cmd, image, VK_IMAGE_LAYOUT_TRANSFER_SRC_OPTIMAL, to.get(), 1,
                               &copy);
        transition(cmd, image, VK_IMAGE_ASPECT_COLOR_BIT, VK_IMAGE_LAYOUT_TRANSFER_SRC_OPTIMAL,
                   VK_IMAGE_LAYOUT_GENERAL);
    }

    std::array<Slot, slotCount> slots_;
    VkCommandPool pool_{};
};

TEST_F(FramesInFlight, ViewsAndGrowingSetsStayRight)
{
    std::array<CpuGBuffer, 2> buffers;
    std::array<Images, 2> images;
    for (uint32_t v = 0; v < 2; ++v) {
        CndCamera camera;
        setPerspective(camera, 1.0, 1.5, 0.1);
        buffers[v] = randomGBuffer(48 + 24 * v, 32 + 16 * v, camera, 0, 20 + v);
        images[v] = uploadImages(buffers[v]);
    }
    const uint32_t counts[] = {10, 3000, 50, 9000, 0, 20000, 700};
    std::vector<std::vector<CndLight>> sets;
    std::vector<std::array<std::vector<glm::vec4>, 2>> expected;
    for (const uint32_t count : counts) {
        sets.push_back(randomSpheres(buffers[0], count, count));
        expected.push_back(
            {run(buffers[0], sets.back()).radiance, run(buffers[1], sets.back()).radiance});
    }
    CndError error{};
    const CndLightingDesc desc{.structSize = sizeof desc,
                               .framesInFlight = slotCount,
                               .specularMethods = 1u << RunOptions{}.specular};
    CndLighting lighting{};
    ASSERT_EQ(cndCreateLighting(&deviceDesc(), &desc, &lighting, &error), CND_SUCCESS);
    CndLightingView views[2]{};
    for (uint32_t v = 0; v < 2; ++v) {
        const CndLightingViewDesc viewDesc{sizeof viewDesc, buffers[v].width, buffers[v].height, 0};
        ASSERT_EQ(cndCreateLightingView(lighting, &viewDesc, &views[v], &error), CND_SUCCESS);
        for (Slot& slot : slots_)
            slot.images[v] = readback("radiance", buffers[v].depth.size() * sizeof(glm::vec4));
    }
    const auto check = [&](Slot& slot) {
        wait(slot);
        for (uint32_t v = 0; v < 2; ++v) {
            const std::vector<glm::vec4>& want = expected[slot.set][v];
            EXPECT_EQ(std::memcmp(slot.images[v].mapped, want.data(), want.size() * sizeof want[0]),
                      0)
                << "view " << v << ", " << counts[slot.set] << " lights";
        }
    };
    for (uint32_t i = 0; i < 42; ++i) {
        Slot& slot = slots_[i % slotCount];
        if (slot.used)
            check(slot);
        slot.set = i % uint32_t(sets.size());
        const CndLightSet set{
            sizeof set, uint32_t(sets[slot.set].size()), sets[slot.set].data(), {}};
        ASSERT_EQ(cndSetLights(lighting, &set, &error), CND_SUCCESS) << error.message;
        const VkCommandBufferBeginInfo begin{.sType = VK_STRUCTURE_TYPE_COMMAND_BUFFER_BEGIN_INFO};
        ASSERT_EQ(vkBeginCommandBuffer(slot.cmd, &begin), VK_SUCCESS);
        fullBarrier(slot.cmd);
        for (uint32_t v = 0; v < 2; ++v) {
            clearRadiance(slot.cmd, images[v]);
            CndLightingFrame frame = frameOf(buffers[v], images[v], {});
            frame.frameSlot = i % slotCount;
            ASSERT_EQ(cndRecordLighting(views[v], slot.cmd, &frame, &error), CND_SUCCESS);
            copyRadiance(slot.cmd, images[v], slot.images[v]);
        }
        submit(slot);
    }
    for (Slot& slot : slots_)
        check(slot);
    cndDestroyLightingView(views[0]);
    cndDestroyLightingView(views[1]);
    cndDestroyLighting(lighting);
}

} // namespace candelabra::test
