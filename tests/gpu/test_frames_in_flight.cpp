// SPDX-License-Identifier: Apache-2.0
// Frames that really overlap: three slots, two views of one light set, and sets that grow and
// shrink while earlier frames are still on the GPU. Every image must equal that of a single frame
// rendered alone, or brute force in the same frame.
#include "gpu/lighting_harness.h"
#include "harness/full_tests.h"

#include <array>
#include <atomic>
#include <chrono>
#include <cstdlib>
#include <iostream>
#include <mutex>
#include <numeric>
#include <random>
#include <thread>

namespace candelabra::test
{
namespace
{

constexpr uint32_t slotCount = 3;

// Command buffer, fence and readback buffers of a frame in flight.
struct Slot {
    VkCommandBuffer cmd{};
    VkFence fence{};
    gpu::Buffer images[2];
    uint32_t set = 0; // index of the light set that it drew
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
    static void copyRadiance(VkCommandBuffer cmd, const Images& images, const gpu::Buffer& to,
                             VkExtent2D size)
    {
        const VkImage image = images.radiance.image.get();
        transition(cmd, image, VK_IMAGE_ASPECT_COLOR_BIT, VK_IMAGE_LAYOUT_GENERAL,
                   VK_IMAGE_LAYOUT_TRANSFER_SRC_OPTIMAL);
        const VkBufferImageCopy copy{.imageSubresource = {VK_IMAGE_ASPECT_COLOR_BIT, 0, 0, 1},
                                     .imageExtent = {size.width, size.height, 1}};
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
                               .specularMethods = 1u << RunOptions{}.specular,
                               .shading = CND_SHADING_CLUSTERED_BIT | CND_SHADING_BRUTE_BIT};
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
            copyRadiance(slot.cmd, images[v], slot.images[v],
                         {buffers[v].width, buffers[v].height});
        }
        submit(slot);
    }
    for (Slot& slot : slots_)
        check(slot);
    cndDestroyLightingView(views[0]);
    cndDestroyLightingView(views[1]);
    cndDestroyLighting(lighting);
}

// Two views of one light set, each lit twice in every frame: by clustered culling and by brute
// force.
class StormOfFrames : public FramesInFlight
{
protected:
    static constexpr uint32_t maxWidth = 150, maxHeight = 110;

    struct StormView {
        CpuGBuffer g;
        CndLightingView clustered{}, brute{};
        CndLightingViewDesc desc{.structSize = sizeof desc};
        std::array<std::array<Images, 2>, slotCount> images; // clustered, brute
        std::array<std::array<gpu::Buffer, 2>, slotCount> pixels;
        std::array<VkExtent2D, slotCount> sizes{};
    };

    uint32_t pick(uint32_t below) { return uint32_t(random_() % below); }

    void create()
    {
        constexpr VkDeviceSize imageBytes = maxWidth * maxHeight * sizeof(glm::vec4);
        for (uint32_t v = 0; v < 2; ++v) {
            CndCamera camera;
            setPerspective(camera, 0.6 + v, 1.4, 0.1, 0, v == 0);
            views_[v].g = randomGBuffer(maxWidth, maxHeight, camera, v == 0 ? 0.f : 1.f, 50 + v);
            for (uint32_t slot = 0; slot < slotCount; ++slot)
                for (uint32_t way = 0; way < 2; ++way) {
                    views_[v].images[slot][way] = uploadImages(views_[v].g);
                    views_[v].pixels[slot][way] = readback("radiance", imageBytes);
                }
        }
        const CndLightingDesc desc{.structSize = sizeof desc,
                                   .framesInFlight = slotCount,
                                   .specularMethods = 1u << RunOptions{}.specular,
                                   .shading = CND_SHADING_CLUSTERED_BIT | CND_SHADING_BRUTE_BIT};
        ASSERT_EQ(cndCreateLighting(&deviceDesc(), &desc, &lighting_, &error_), CND_SUCCESS);
    }

    // Compares the two images of both views that the slot's last frame made, if there was one.
    void check(uint32_t index)
    {
        Slot& slot = slots_[index];
        if (!slot.used)
            return;
        wait(slot);
        slot.used = false;
        for (StormView& view : views_) {
            const size_t count = size_t(view.sizes[index].width) * view.sizes[index].height;
            std::array<std::vector<glm::vec4>, 2> got;
            for (uint32_t way = 0; way < 2; ++way) {
                const std::span all = view.pixels[index][way].as<glm::vec4>();
                got[way].assign(all.begin(), all.begin() + std::ptrdiff_t(count));
            }
            EXPECT_LE(maxRelativeDifference(got[0], got[1]), 1e-6)
                << view.sizes[index].width << "x" << view.sizes[index].height;
        }
    }

    void checkAll()
    {
        for (uint32_t slot = 0; slot < slotCount; ++slot)
            check(slot);
    }

    void recreate(StormView& view, VkExtent2D size)
    {
        checkAll();
        cndDestroyLightingView(view.clustered);
        cndDestroyLightingView(view.brute);
        view.desc.maxWidth = size.width;
        view.desc.maxHeight = size.height;
        ASSERT_EQ(cndCreateLightingView(lighting_, &view.desc, &view.clustered, &error_),
                  CND_SUCCESS);
        ASSERT_EQ(cndCreateLightingView(lighting_, &view.desc, &view.brute, &error_), CND_SUCCESS);
    }

    void setLights()
    {
        lights_ = randomSpheres(views_[pick(2)].g, pick(400), uint32_t(random_()));
        const CndLightSet set{sizeof set, uint32_t(lights_.size()), lights_.data(), {}};
        ASSERT_EQ(cndSetLights(lighting_, &set, &error_), CND_SUCCESS) << error_.message;
        ids_.resize(lights_.size());
        std::iota(ids_.begin(), ids_.end(), CndLightId(0));
    }

    void moveLights()
    {
        const uint32_t first = pick(uint32_t(lights_.size()));
        const uint32_t count = 1 + pick(uint32_t(lights_.size()) - first);
        for (uint32_t k = first; k < first + count; ++k)
            lights_[k].position[pick(3)] += 0.5f;
        if (pick(2)) {
            ASSERT_EQ(cndUpdateLights(lighting_, count, &ids_[first], &lights_[first], &error_),
                      CND_SUCCESS)
                << error_.message;
        } else { // achieves the same by removing and adding lights
            ASSERT_EQ(cndRemoveLights(lighting_, count, &ids_[first], &error_), CND_SUCCESS)
                << error_.message;
            ASSERT_EQ(cndAddLights(lighting_, count, &lights_[first], &ids_[first], &error_),
                      CND_SUCCESS)
                << error_.message;
        }
    }

    void record(uint32_t index, const std::array<VkExtent2D, 2>& sizes)
    {
        const VkCommandBuffer cmd = slots_[index].cmd;
        const VkCommandBufferBeginInfo begin{.sType = VK_STRUCTURE_TYPE_COMMAND_BUFFER_BEGIN_INFO};
        ASSERT_EQ(vkBeginCommandBuffer(cmd, &begin), VK_SUCCESS);
        fullBarrier(cmd);
        for (uint32_t v = 0; v < 2; ++v)
            for (uint32_t way = 0; way < 2; ++way) {
                StormView& view = views_[v];
                view.sizes[index] = sizes[v];
                const Images& images = view.images[index][way];
                clearRadiance(cmd, images);
                CndLightingFrame frame = frameOf(view.g, images, {});
                frame.frameSlot = index;
                frame.width = sizes[v].width;
                frame.height = sizes[v].height;
                frame.culling = way == 0 ? CND_CULLING_CLUSTERED : CND_CULLING_BRUTE;
                ASSERT_EQ(
                    cndRecordLighting(way == 0 ? view.clustered : view.brute, cmd, &frame, &error_),
                    CND_SUCCESS)
                    << error_.message;
                copyRadiance(cmd, images, view.pixels[index][way], sizes[v]);
            }
        submit(slots_[index]);
    }

    void destroy()
    {
        for (StormView& view : views_) {
            cndDestroyLightingView(view.clustered);
            cndDestroyLightingView(view.brute);
        }
        cndDestroyLighting(lighting_);
    }

    std::mt19937 random_{3};
    std::array<StormView, 2> views_;
    CndError error_{};
    CndLighting lighting_{};
    std::vector<CndLight> lights_;
    std::vector<CndLightId> ids_;
};

// Two views with three frames in flight, another size in every frame, and views that are recreated
// while lights are added, removed and moved: every image must equal brute force recorded beside it.
// (tests/mock/test_lifetimes.cpp checks what is allocated and freed meanwhile.)
TEST_F(StormOfFrames, SizesAndLightsEqualBrute)
{
    const int frames = fullTests() ? 500 : 60;
    create();
    for (int i = 0; i < frames && !HasFatalFailure(); ++i) {
        const uint32_t index = uint32_t(i) % slotCount;
        check(index);
        if (i == 0 || pick(3) == 0)
            setLights();
        else if (!lights_.empty())
            moveLights();
        std::array<VkExtent2D, 2> sizes;
        for (uint32_t v = 0; v < 2; ++v) {
            sizes[v] = {1 + pick(maxWidth), 1 + pick(maxHeight)};
            const CndLightingViewDesc& had = views_[v].desc;
            if (sizes[v].width > had.maxWidth || sizes[v].height > had.maxHeight || pick(20) == 0)
                recreate(views_[v], sizes[v]);
        }
        record(index, sizes);
    }
    checkAll();
    destroy();
}

// The same while a second thread edits the lights, one call after the other; a mutex keeps calls on
// the module apart. With CANDELABRA_SOAK_SECONDS it lasts that long.
TEST_F(StormOfFrames, LightsAreEditedByAnotherThread)
{
    const char* asked = std::getenv("CANDELABRA_SOAK_SECONDS");
    const double seconds = asked ? std::atof(asked) : 0;
    const auto began = std::chrono::steady_clock::now();
    const auto elapsed = [&] {
        return std::chrono::duration<double>(std::chrono::steady_clock::now() - began).count();
    };
    create();
    setLights();
    std::mutex calls;
    std::atomic<bool> done = false;
    size_t edits = 0, frames = 0, framesWithEdits = 0;
    std::thread editor([&] {
        while (!done) {
            {
                const std::lock_guard lock(calls);
                if (pick(8) == 0 || lights_.empty())
                    setLights();
                else
                    moveLights();
                ++edits;
            }
            std::this_thread::yield();
        }
    });
    for (size_t seen = 0; (frames < 40 || elapsed() < seconds) && !HasFailure(); ++frames) {
        const uint32_t index = uint32_t(frames) % slotCount;
        check(index);
        const std::lock_guard lock(calls);
        framesWithEdits += edits != seen;
        seen = edits;
        const std::array<VkExtent2D, 2> sizes{VkExtent2D{1 + pick(maxWidth), 1 + pick(maxHeight)},
                                              VkExtent2D{1 + pick(maxWidth), 1 + pick(maxHeight)}};
        for (uint32_t v = 0; v < 2; ++v)
            if (sizes[v].width > views_[v].desc.maxWidth ||
                sizes[v].height > views_[v].desc.maxHeight)
                recreate(views_[v], {maxWidth, maxHeight});
        record(index, sizes);
    }
    done = true;
    editor.join();
    checkAll();
    destroy();
    std::cout << frames << " frames, " << edits << " edits\n";
    EXPECT_GE(framesWithEdits, 10u);
}

} // namespace candelabra::test
