// SPDX-License-Identifier: Apache-2.0
// A host that draws on one queue family and lights on another (async compute): the host hands the
// G-buffer to the modules and takes the picture back by ownership transfers. If the device has no
// second family for compute, two fictitious families are used and tracked.
#include "candelabra/candelabra.hpp"
#include "gpu/exposure_harness.h"
#include "gpu/lighting_harness.h"
#include "gpu/ownership.h"
#include "render/image_barrier.h"

namespace candelabra::test
{
namespace
{

enum Family : uint32_t { Graphics, Compute, FamilyCount };
enum Part : uint32_t {
    Before,
    Modules,
    After,
    PartCount
}; // parts of a frame, each a submission
   // of its own

constexpr VkPipelineStageFlags2 transferStage = VK_PIPELINE_STAGE_2_ALL_TRANSFER_BIT;
constexpr VkPipelineStageFlags2 computeStage = VK_PIPELINE_STAGE_2_COMPUTE_SHADER_BIT;

// The device, its queues and their command buffers.
class TwoQueues
{
public:
    explicit TwoQueues(const app::VulkanContext& context)
    {
        const VkPhysicalDevice physical = context.info().handle;
        uint32_t count = 0;
        vkGetPhysicalDeviceQueueFamilyProperties(physical, &count, nullptr);
        std::vector<VkQueueFamilyProperties> all(count);
        vkGetPhysicalDeviceQueueFamilyProperties(physical, &count, all.data());
        index_[Graphics] = index_[Compute] = context.queueFamily();
        for (uint32_t i = 0; i < count; ++i)
            if (i != context.queueFamily() && all[i].queueFlags & VK_QUEUE_COMPUTE_BIT) {
                index_[Compute] = i;
                real_ = true;
            }
        createDevice(context, physical);
        for (uint32_t f = 0; f < FamilyCount; ++f)
            vkGetDeviceQueue(desc_.device, index_[f], 0, &queues_[f]);
        for (uint32_t part = 0; part < PartCount; ++part) {
            const VkCommandPoolCreateInfo pool{.sType = VK_STRUCTURE_TYPE_COMMAND_POOL_CREATE_INFO,
                                               .flags =
                                                   VK_COMMAND_POOL_CREATE_RESET_COMMAND_BUFFER_BIT,
                                               .queueFamilyIndex = index_[familyOf(part)]};
            EXPECT_EQ(vkCreateCommandPool(desc_.device, &pool, nullptr, &pools_[part]), VK_SUCCESS);
            const VkCommandBufferAllocateInfo info{
                .sType = VK_STRUCTURE_TYPE_COMMAND_BUFFER_ALLOCATE_INFO,
                .commandPool = pools_[part],
                .level = VK_COMMAND_BUFFER_LEVEL_PRIMARY,
                .commandBufferCount = 1};
            EXPECT_EQ(vkAllocateCommandBuffers(desc_.device, &info, &cmds_[part]), VK_SUCCESS);
            const VkSemaphoreCreateInfo semaphore{.sType = VK_STRUCTURE_TYPE_SEMAPHORE_CREATE_INFO};
            EXPECT_EQ(vkCreateSemaphore(desc_.device, &semaphore, nullptr, &finished_[part]),
                      VK_SUCCESS);
        }
        device_ = std::make_unique<gpu::Device>(desc_, gpu::allModules | gpu::rasterPass);
    }
    ~TwoQueues()
    {
        device_.reset();
        for (uint32_t part = 0; part < PartCount; ++part) {
            vkDestroySemaphore(desc_.device, finished_[part], nullptr);
            vkDestroyCommandPool(desc_.device, pools_[part], nullptr);
        }
        vkDestroyDevice(desc_.device, nullptr);
    }
    TwoQueues(const TwoQueues&) = delete;
    TwoQueues& operator=(const TwoQueues&) = delete;

    static Family familyOf(uint32_t part) { return part == Modules ? Compute : Graphics; }
    // Returns the family index that barriers use.
    uint32_t family(Family f) const { return real_ ? index_[f] : f; }
    bool real() const { return real_; }
    const CndDeviceDesc& desc() const { return desc_; }
    const gpu::Device& device() const { return *device_; }

    VkCommandBuffer begin(Part part, Ownership& ownership) const
    {
        const VkCommandBufferBeginInfo info{.sType = VK_STRUCTURE_TYPE_COMMAND_BUFFER_BEGIN_INFO};
        EXPECT_EQ(vkBeginCommandBuffer(cmds_[part], &info), VK_SUCCESS);
        ownership.begin(cmds_[part], family(familyOf(part)));
        return cmds_[part];
    }
    // Submits a part; `stage` waits for the semaphore of the previous part.
    void submit(Part part, VkPipelineStageFlags2 stage) const
    {
        EXPECT_EQ(vkEndCommandBuffer(cmds_[part]), VK_SUCCESS);
        const auto semaphore = [&](uint32_t of, VkPipelineStageFlags2 stages) {
            return VkSemaphoreSubmitInfo{.sType = VK_STRUCTURE_TYPE_SEMAPHORE_SUBMIT_INFO,
                                         .semaphore = finished_[of],
                                         .stageMask = stages};
        };
        const VkSemaphoreSubmitInfo wait = semaphore(part == Before ? 0 : part - 1, stage);
        const VkSemaphoreSubmitInfo signal = semaphore(part, VK_PIPELINE_STAGE_2_ALL_COMMANDS_BIT);
        const VkCommandBufferSubmitInfo cmd{.sType = VK_STRUCTURE_TYPE_COMMAND_BUFFER_SUBMIT_INFO,
                                            .commandBuffer = cmds_[part]};
        const VkSubmitInfo2 info{.sType = VK_STRUCTURE_TYPE_SUBMIT_INFO_2,
                                 .waitSemaphoreInfoCount = part == Before ? 0u : 1u,
                                 .pWaitSemaphoreInfos = &wait,
                                 .commandBufferInfoCount = 1,
                                 .pCommandBufferInfos = &cmd,
                                 .signalSemaphoreInfoCount = part == After ? 0u : 1u,
                                 .pSignalSemaphoreInfos = &signal};
        EXPECT_EQ(vkQueueSubmit2(queues_[familyOf(part)], 1, &info, VK_NULL_HANDLE), VK_SUCCESS);
    }
    void drop(Part part) const { EXPECT_EQ(vkEndCommandBuffer(cmds_[part]), VK_SUCCESS); }
    void waitIdle() const { EXPECT_EQ(vkDeviceWaitIdle(desc_.device), VK_SUCCESS); }

private:
    void createDevice(const app::VulkanContext& context, VkPhysicalDevice physical)
    {
        VkPhysicalDeviceVulkan13Features core13{
            .sType = VK_STRUCTURE_TYPE_PHYSICAL_DEVICE_VULKAN_1_3_FEATURES};
        VkPhysicalDeviceVulkan12Features core12{
            .sType = VK_STRUCTURE_TYPE_PHYSICAL_DEVICE_VULKAN_1_2_FEATURES, .pNext = &core13};
        VkPhysicalDeviceFeatures2 features{.sType = VK_STRUCTURE_TYPE_PHYSICAL_DEVICE_FEATURES_2,
                                           .pNext = &core12};
        gpu::requireFeatures(features, gpu::allModules | gpu::rasterPass);
        const float priority = 1;
        VkDeviceQueueCreateInfo queues[FamilyCount];
        for (uint32_t f = 0; f < FamilyCount; ++f)
            queues[f] = {.sType = VK_STRUCTURE_TYPE_DEVICE_QUEUE_CREATE_INFO,
                         .queueFamilyIndex = index_[f],
                         .queueCount = 1,
                         .pQueuePriorities = &priority};
        const VkDeviceCreateInfo info{.sType = VK_STRUCTURE_TYPE_DEVICE_CREATE_INFO,
                                      .pNext = &features,
                                      .queueCreateInfoCount = real_ ? 2u : 1u,
                                      .pQueueCreateInfos = queues};
        desc_ = context.desc();
        desc_.pipelineCache = VK_NULL_HANDLE; // the context's is for its own device
        EXPECT_EQ(vkCreateDevice(physical, &info, nullptr, &desc_.device), VK_SUCCESS);
    }

    CndDeviceDesc desc_{};
    bool real_ = false;
    uint32_t index_[FamilyCount] = {};
    VkQueue queues_[FamilyCount] = {};
    VkCommandPool pools_[PartCount] = {};
    VkCommandBuffer cmds_[PartCount] = {};
    VkSemaphore finished_[PartCount] = {};
    std::unique_ptr<gpu::Device> device_;
};

} // namespace

class QueueFamilies : public LightingTest
{
protected:
    void SetUp() override
    {
        LightingTest::SetUp();
        if (IsSkipped() || HasFatalFailure())
            return;
        g_ = randomGBuffer(72, 48, 17);
        lights_ = randomSpheres(g_, 150, 17);
        queues_ = std::make_unique<TwoQueues>(context());
        ownership_ = std::make_unique<Ownership>(queues_->desc(), queues_->real());
        images_ = createImages();
        const CndLightingDesc lighting{.framesInFlight = 1,
                                       .timestamps = VK_TRUE,
                                       .specularMethods = 1u << RunOptions{}.specular};
        lighting_ = std::move(Lighting::create(ownership_->desc(), lighting).value());
        view_ =
            std::move(lighting_.createView({.maxWidth = g_.width, .maxHeight = g_.height}).value());
        exposure_ = std::move(Exposure::create(ownership_->desc(), {.framesInFlight = 1}).value());
        ASSERT_TRUE(lighting_.setLights(lights_, {0, 0, 0}));
    }
    void TearDown() override
    {
        view_ = {};
        lighting_ = {};
        exposure_ = {};
        images_.clear();
        uploads_.clear();
        radiance_ = {};
        ownership_.reset();
        queues_.reset();
        LightingTest::TearDown();
    }

    // The images: normalRoughness, albedo, specular, depth, radiance, display.
    enum : size_t { Depth = 3, Radiance = 4, Display = 5, ImageCount = 6 };
    std::vector<gpu::Image> createImages()
    {
        const gpu::Device& d = queues_->device();
        constexpr VkImageUsageFlags read = VK_IMAGE_USAGE_SAMPLED_BIT;
        constexpr VkImageUsageFlags to = VK_IMAGE_USAGE_TRANSFER_DST_BIT;
        constexpr VkImageUsageFlags from = VK_IMAGE_USAGE_TRANSFER_SRC_BIT;
        constexpr VkImageUsageFlags store = VK_IMAGE_USAGE_STORAGE_BIT;
        const std::pair<VkFormat, VkImageUsageFlags> kinds[ImageCount] = {
            {VK_FORMAT_R32G32_UINT, read | to},
            {VK_FORMAT_R32G32_UINT, read | to},
            {VK_FORMAT_R32G32_UINT, read | to},
            {VK_FORMAT_D32_SFLOAT, read | to | VK_IMAGE_USAGE_DEPTH_STENCIL_ATTACHMENT_BIT},
            {VK_FORMAT_R32G32B32A32_SFLOAT, read | to | from | store},
            {VK_FORMAT_R8G8B8A8_UNORM, store | from}};
        std::vector<gpu::Image> out;
        for (size_t i = 0; i < ImageCount; ++i) {
            out.push_back(gpu::createImage(d, "host image", kinds[i].first, g_.width, g_.height,
                                           kinds[i].second, aspectOf(i)));
            ownership_->add(out[i].image.get(), out[i].view.get());
        }
        const auto data = [&](const auto& texels) {
            const auto bytes = std::as_bytes(std::span(texels));
            uploads_.push_back(gpu::createBuffer(d, "host texels", bytes.size(),
                                                 VK_BUFFER_USAGE_TRANSFER_SRC_BIT,
                                                 gpu::MemoryUse::Upload));
            std::memcpy(uploads_.back().mapped, bytes.data(), bytes.size());
        };
        data(g_.normalRoughness);
        data(g_.albedo);
        data(g_.specular);
        data(g_.depth);
        radiance_ = gpu::createBuffer(d, "host read-back", g_.depth.size() * sizeof(glm::vec4),
                                      VK_BUFFER_USAGE_TRANSFER_DST_BIT, gpu::MemoryUse::Readback);
        return out;
    }
    static VkImageAspectFlags aspectOf(size_t i)
    {
        return i == Depth ? VK_IMAGE_ASPECT_DEPTH_BIT : VK_IMAGE_ASPECT_COLOR_BIT;
    }

    // Returns a barrier within one family.
    VkImageMemoryBarrier2 change(size_t i, const app::ImageAccess& from,
                                 const app::ImageAccess& to) const
    {
        return app::imageBarrier(images_[i].image.get(), aspectOf(i), from, to);
    }
    // The two halves of an ownership transfer: what happened before it, and what will happen after
    // it.
    VkImageMemoryBarrier2 release(size_t i, Family to, const app::ImageAccess& before,
                                  VkImageLayout layout) const
    {
        VkImageMemoryBarrier2 b = change(i, before, {0, 0, layout});
        b.srcQueueFamilyIndex = queues_->family(to == Compute ? Graphics : Compute);
        b.dstQueueFamilyIndex = queues_->family(to);
        return b;
    }
    VkImageMemoryBarrier2 acquire(size_t i, Family to, VkImageLayout from,
                                  const app::ImageAccess& after) const
    {
        // Starts at the stage that waits for the semaphore.
        VkImageMemoryBarrier2 b = change(i, {after.stage, 0, from}, after);
        b.srcQueueFamilyIndex = queues_->family(to == Compute ? Graphics : Compute);
        b.dstQueueFamilyIndex = queues_->family(to);
        return b;
    }

    static constexpr app::ImageAccess filled = app::transferWrite, sampled = app::computeRead,
                                      copied = app::transferRead;
    static constexpr app::ImageAccess stored{
        computeStage, VK_ACCESS_2_SHADER_STORAGE_READ_BIT | VK_ACCESS_2_SHADER_STORAGE_WRITE_BIT,
        VK_IMAGE_LAYOUT_GENERAL};
    static app::ImageAccess lit(size_t i) { return i == Radiance ? stored : sampled; }

    // Graphics family: draws the G-buffer (copies it, in this test) and releases it.
    void recordBefore(VkCommandBuffer cmd)
    {
        std::vector<VkImageMemoryBarrier2> barriers;
        for (size_t i = 0; i < Display; ++i) // old contents are discarded, so no transfer back is
                                             // needed
            barriers.push_back(change(i, app::discarded, filled));
        ownership_->barrier(cmd, barriers);
        for (size_t i = 0; i < Radiance; ++i) {
            const VkBufferImageCopy copy{.imageSubresource = {aspectOf(i), 0, 0, 1},
                                         .imageExtent = {g_.width, g_.height, 1}};
            vkCmdCopyBufferToImage(cmd, uploads_[i].get(), images_[i].image.get(), filled.layout, 1,
                                   &copy);
        }
        const VkClearColorValue black{};
        const VkImageSubresourceRange all{VK_IMAGE_ASPECT_COLOR_BIT, 0, 1, 0, 1};
        vkCmdClearColorImage(cmd, images_[Radiance].image.get(), filled.layout, &black, 1, &all);
        barriers.clear();
        for (size_t i = 0; i < Display; ++i)
            barriers.push_back(release(i, Compute, filled, lit(i).layout));
        ownership_->barrier(cmd, barriers);
    }
    // Compute family: the modules, between acquire and release. The image `forgotten` is not
    // acquired.
    void recordModules(VkCommandBuffer cmd, size_t forgotten)
    {
        std::vector<VkImageMemoryBarrier2> barriers;
        for (size_t i = 0; i < Display; ++i)
            if (i != forgotten)
                barriers.push_back(acquire(i, Compute, filled.layout, lit(i)));
        barriers.push_back(change(Display, {computeStage, 0, VK_IMAGE_LAYOUT_UNDEFINED}, stored));
        ownership_->barrier(cmd, barriers);
        CndLightingFrame frame{.width = g_.width,
                               .height = g_.height,
                               .camera = g_.camera,
                               .clearDepth = g_.clearDepth,
                               .normalRoughness = images_[0].view.get(),
                               .albedo = images_[1].view.get(),
                               .specular = images_[2].view.get(),
                               .depth = images_[Depth].view.get(),
                               .radiance = images_[Radiance].view.get(),
                               .specularMethod = RunOptions{}.specular,
                               .lobes = RunOptions{}.lobes};
        ownership_->module([&] { ASSERT_TRUE(view_.record(cmd, frame)); });
        barriers = {change(Radiance, stored, sampled)};
        ownership_->barrier(cmd, barriers);
        ownership_->module([&] {
            ASSERT_TRUE(exposure_.record(cmd, {.width = g_.width,
                                               .height = g_.height,
                                               .radiance = images_[Radiance].view.get(),
                                               .display = images_[Display].view.get(),
                                               .reset = VK_TRUE,
                                               .settings = plainSettings()}));
        });
        barriers = {release(Radiance, Graphics, sampled, copied.layout),
                    release(Display, Graphics, stored, copied.layout)};
        ownership_->barrier(cmd, barriers);
    }
    // Graphics family: shows the picture (copies it, in this test).
    void recordAfter(VkCommandBuffer cmd)
    {
        const VkImageMemoryBarrier2 barriers[] = {
            acquire(Radiance, Graphics, sampled.layout, copied),
            acquire(Display, Graphics, stored.layout, copied)};
        ownership_->barrier(cmd, barriers);
        const VkBufferImageCopy copy{.imageSubresource = {VK_IMAGE_ASPECT_COLOR_BIT, 0, 0, 1},
                                     .imageExtent = {g_.width, g_.height, 1}};
        vkCmdCopyImageToBuffer(cmd, images_[Radiance].image.get(), copied.layout, radiance_.get(),
                               1, &copy);
        fullBarrier(cmd);
    }

    CpuGBuffer g_;
    std::vector<CndLight> lights_;
    std::unique_ptr<TwoQueues> queues_;
    std::unique_ptr<Ownership> ownership_;
    std::vector<gpu::Image> images_;
    std::vector<gpu::Buffer> uploads_;
    gpu::Buffer radiance_;
    Lighting lighting_;
    LightingView view_;
    Exposure exposure_;
};

TEST_F(QueueFamilies, ModulesTouchWhatTheirFamilyOwns)
{
    const LightingResult expected = run(g_, lights_);
    for (int frame = 0; frame < 2; ++frame) {
        recordBefore(queues_->begin(Before, *ownership_));
        queues_->submit(Before, 0);
        ownership_->touched.clear();
        recordModules(queues_->begin(Modules, *ownership_), ImageCount);
        queues_->submit(Modules, computeStage);
        EXPECT_EQ(ownership_->touched.size(), size_t(ImageCount));
        recordAfter(queues_->begin(After, *ownership_));
        queues_->submit(After, transferStage);
        queues_->waitIdle();
        const auto got = radiance_.as<glm::vec4>();
        EXPECT_TRUE(sameBits({got.begin(), got.end()}, expected.radiance)) << frame;
        for (const size_t shown : {Radiance, Display})
            EXPECT_TRUE(ownership_->isOwner(images_[shown].image.get(), queues_->family(Graphics)));
        EXPECT_TRUE(exposure_.stats(0).value());
        EXPECT_TRUE(view_.stats(0).value());
    }
    for (const std::string& fault : ownership_->faults)
        ADD_FAILURE() << fault;
    // The modules may only compute and copy, on buffers of their own: no submission, wait or
    // memory.
    const std::set<std::string> allowed{"CmdBindDescriptorSets",
                                        "CmdBindPipeline",
                                        "CmdCopyBuffer",
                                        "CmdDispatch",
                                        "CmdDispatchIndirect",
                                        "CmdFillBuffer",
                                        "CmdPipelineBarrier",
                                        "CmdPushConstants",
                                        "CmdResetQueryPool",
                                        "CmdUpdateBuffer",
                                        "CmdWriteTimestamp",
                                        "UpdateDescriptorSets",
                                        "CmdBeginDebugUtilsLabelEXT",
                                        "CmdEndDebugUtilsLabelEXT"};
    for (const std::string& name : ownership_->called)
        EXPECT_TRUE(allowed.contains(name)) << name;
    EXPECT_TRUE(ownership_->called.contains("CmdDispatchIndirect"));
}

// Shows that the tracking can detect a fault. The commands are recorded but not submitted.
TEST_F(QueueFamilies, AnImageThatIsNotAcquiredIsNoticed)
{
    for (const size_t forgotten : {size_t(0), size_t(Depth)}) {
        recordBefore(queues_->begin(Before, *ownership_));
        queues_->drop(Before);
        EXPECT_TRUE(ownership_->faults.empty());
        recordModules(queues_->begin(Modules, *ownership_), forgotten);
        queues_->drop(Modules);
        ASSERT_FALSE(ownership_->faults.empty()) << forgotten;
        EXPECT_NE(ownership_->faults[0].find("has not acquired"), std::string::npos);
        ownership_->faults.clear();
    }
}

} // namespace candelabra::test
