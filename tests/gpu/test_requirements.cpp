// SPDX-License-Identifier: Apache-2.0
// Each module on a device with exactly what the module lists, for each version of Vulkan that hosts
// may have: creation and frames are silent under validation and give the bits of Vulkan 1.3. On a
// device without a listed feature they are not silent.
#include <cstdlib>

#include "candelabra/candelabra.hpp"
#include "harness/full_tests.h"
#include "harness/gpu_fixture.h"

namespace candelabra::test
{
namespace
{

constexpr uint32_t width = 40, height = 24;
constexpr uint32_t lightingBit = CND_MODULE_LIGHTING_BIT,
                   environmentBit = CND_MODULE_ENVIRONMENT_BIT,
                   exposureBit = CND_MODULE_EXPOSURE_BIT;

enum class Features { AsListed, None };

// A host with an instance of a given version and a device for one module. It calls functions of
// Vulkan 1.0 only.
class ExactHost
{
public:
    ExactHost(uint32_t version, uint32_t module, Features features)
        : instance_(validates() ? app::Validation::On : app::Validation::Off,
                    app::Presentation::Headless, version)
    {
        const char* wanted = std::getenv("CANDELABRA_TEST_DEVICE");
        desc_.instance = instance_.get();
        desc_.physicalDevice = chooseDevice(instance_.devices(), wanted ? wanted : "").handle;
        desc_.getInstanceProcAddr = vkGetInstanceProcAddr;
        desc_.apiVersion = version;
        desc_.debugUtilsEnabled = instance_.debugUtils();
        const auto usable = checkDevice(desc_, module);
        EXPECT_TRUE(usable) << usable.error().message;
        createDevice(version, module, features);
        vkGetDeviceQueue(desc_.device, 0, 0, &queue_);
        const VkCommandPoolCreateInfo pool{.sType = VK_STRUCTURE_TYPE_COMMAND_POOL_CREATE_INFO};
        EXPECT_EQ(vkCreateCommandPool(desc_.device, &pool, nullptr, &pool_), VK_SUCCESS);
        desc_.structSize = sizeof desc_;
        gpu_ = std::make_unique<gpu::Device>(desc_, module);
    }
    ~ExactHost()
    {
        gpu_.reset();
        vkDestroyCommandPool(desc_.device, pool_, nullptr);
        vkDestroyDevice(desc_.device, nullptr);
    }
    ExactHost(const ExactHost&) = delete;
    ExactHost& operator=(const ExactHost&) = delete;

    const CndDeviceDesc& desc() const { return desc_; }
    const gpu::Device& gpu() const { return *gpu_; }
    std::vector<app::ValidationMessage> takeMessages() const { return instance_.messages().take(); }

    template <typename Record>
    void submitAndWait(Record&& record) const
    {
        const VkCommandBufferAllocateInfo allocate{
            .sType = VK_STRUCTURE_TYPE_COMMAND_BUFFER_ALLOCATE_INFO,
            .commandPool = pool_,
            .commandBufferCount = 1};
        VkCommandBuffer cmd{};
        EXPECT_EQ(vkAllocateCommandBuffers(desc_.device, &allocate, &cmd), VK_SUCCESS);
        const VkCommandBufferBeginInfo begin{.sType = VK_STRUCTURE_TYPE_COMMAND_BUFFER_BEGIN_INFO};
        EXPECT_EQ(vkBeginCommandBuffer(cmd, &begin), VK_SUCCESS);
        record(cmd);
        EXPECT_EQ(vkEndCommandBuffer(cmd), VK_SUCCESS);
        const VkSubmitInfo submit{.sType = VK_STRUCTURE_TYPE_SUBMIT_INFO,
                                  .commandBufferCount = 1,
                                  .pCommandBuffers = &cmd};
        EXPECT_EQ(vkQueueSubmit(queue_, 1, &submit, VK_NULL_HANDLE), VK_SUCCESS);
        EXPECT_EQ(vkQueueWaitIdle(queue_), VK_SUCCESS);
        vkFreeCommandBuffers(desc_.device, pool_, 1, &cmd);
    }

private:
    void createDevice(uint32_t version, uint32_t module, Features wanted)
    {
        VkPhysicalDeviceScalarBlockLayoutFeatures scalar{
            .sType = VK_STRUCTURE_TYPE_PHYSICAL_DEVICE_SCALAR_BLOCK_LAYOUT_FEATURES};
        VkPhysicalDeviceVulkan12Features core12{
            .sType = VK_STRUCTURE_TYPE_PHYSICAL_DEVICE_VULKAN_1_2_FEATURES};
        VkPhysicalDeviceFeatures2 features{.sType = VK_STRUCTURE_TYPE_PHYSICAL_DEVICE_FEATURES_2};
        const char* const extension = VK_EXT_SCALAR_BLOCK_LAYOUT_EXTENSION_NAME;
        const bool extended = version < VK_API_VERSION_1_2 && module != exposureBit;
        if (version >= VK_API_VERSION_1_2)
            features.pNext = &core12;
        else if (extended)
            features.pNext = &scalar;
        if (wanted == Features::AsListed) {
            const auto set = requireFeatures(features, module);
            EXPECT_TRUE(set) << set.error().message;
        }
        const float priority = 1;
        const VkDeviceQueueCreateInfo queue{.sType = VK_STRUCTURE_TYPE_DEVICE_QUEUE_CREATE_INFO,
                                            .queueCount = 1,
                                            .pQueuePriorities = &priority};
        const VkDeviceCreateInfo info{.sType = VK_STRUCTURE_TYPE_DEVICE_CREATE_INFO,
                                      .pNext = &features,
                                      .queueCreateInfoCount = 1,
                                      .pQueueCreateInfos = &queue,
                                      .enabledExtensionCount = extended ? 1u : 0u,
                                      .ppEnabledExtensionNames = &extension};
        ASSERT_EQ(vkCreateDevice(desc_.physicalDevice, &info, nullptr, &desc_.device), VK_SUCCESS);
    }

    app::VulkanInstance instance_;
    CndDeviceDesc desc_{};
    VkQueue queue_ = VK_NULL_HANDLE;
    VkCommandPool pool_ = VK_NULL_HANDLE;
    std::unique_ptr<gpu::Device> gpu_;
};

// Waits for everything, and moves an image to another layout.
void moveTo(VkCommandBuffer cmd, const gpu::Image& image, VkImageAspectFlags aspect,
            VkImageLayout from, VkImageLayout to)
{
    const VkImageMemoryBarrier barrier{.sType = VK_STRUCTURE_TYPE_IMAGE_MEMORY_BARRIER,
                                       .srcAccessMask = VK_ACCESS_MEMORY_WRITE_BIT,
                                       .dstAccessMask =
                                           VK_ACCESS_MEMORY_READ_BIT | VK_ACCESS_MEMORY_WRITE_BIT,
                                       .oldLayout = from,
                                       .newLayout = to,
                                       .srcQueueFamilyIndex = VK_QUEUE_FAMILY_IGNORED,
                                       .dstQueueFamilyIndex = VK_QUEUE_FAMILY_IGNORED,
                                       .image = image.image.get(),
                                       .subresourceRange = {aspect, 0, 1, 0, 1}};
    constexpr VkPipelineStageFlags all = VK_PIPELINE_STAGE_ALL_COMMANDS_BIT;
    vkCmdPipelineBarrier(cmd, all, all, 0, 0, nullptr, 0, nullptr, 1, &barrier);
}

constexpr VkImageUsageFlags sampled = VK_IMAGE_USAGE_SAMPLED_BIT | VK_IMAGE_USAGE_TRANSFER_DST_BIT;
constexpr VkImageUsageFlags stored = VK_IMAGE_USAGE_STORAGE_BIT | VK_IMAGE_USAGE_TRANSFER_DST_BIT |
                                     VK_IMAGE_USAGE_TRANSFER_SRC_BIT | VK_IMAGE_USAGE_SAMPLED_BIT;

// Images of one colour each.
class Pictures
{
public:
    explicit Pictures(const ExactHost& host)
        : normals(make(host, VK_FORMAT_R8G8B8A8_UNORM, sampled)),
          albedo(make(host, VK_FORMAT_R8G8B8A8_UNORM, sampled)),
          depth(gpu::createImage(host.gpu(), "depth", VK_FORMAT_D32_SFLOAT, width, height, sampled,
                                 VK_IMAGE_ASPECT_DEPTH_BIT)),
          radiance(make(host, VK_FORMAT_R32G32B32A32_SFLOAT, stored)),
          display(make(host, VK_FORMAT_R8G8B8A8_UNORM, stored)),
          surroundings(make(host, VK_FORMAT_R32G32B32A32_SFLOAT, sampled))
    {
        host.submitAndWait([&](VkCommandBuffer cmd) {
            constexpr VkImageLayout read = VK_IMAGE_LAYOUT_SHADER_READ_ONLY_OPTIMAL;
            fill(cmd, normals, {{0.5f, 0.5f, 1, 0.4f}}, read); // towards +z; roughness in alpha
            fill(cmd, albedo, {{0.8f, 0.5f, 0.2f, 0}}, read);
            fill(cmd, radiance, {{1, 2, 3, 0}}, VK_IMAGE_LAYOUT_GENERAL);
            fill(cmd, display, {{0, 0, 0, 0}}, VK_IMAGE_LAYOUT_GENERAL);
            fill(cmd, surroundings, {{100, 200, 300, 0}}, read);
            constexpr VkImageAspectFlags aspect = VK_IMAGE_ASPECT_DEPTH_BIT;
            moveTo(cmd, depth, aspect, VK_IMAGE_LAYOUT_UNDEFINED,
                   VK_IMAGE_LAYOUT_TRANSFER_DST_OPTIMAL);
            const VkClearDepthStencilValue fourMetres{.depth = 0.1f / 4};
            const VkImageSubresourceRange all{aspect, 0, 1, 0, 1};
            vkCmdClearDepthStencilImage(cmd, depth.image.get(),
                                        VK_IMAGE_LAYOUT_TRANSFER_DST_OPTIMAL, &fourMetres, 1, &all);
            moveTo(cmd, depth, aspect, VK_IMAGE_LAYOUT_TRANSFER_DST_OPTIMAL, read);
        });
    }
    const gpu::Image normals, albedo, depth, radiance, display, surroundings;

    template <typename Frame>
    Frame frame() const
    {
        Frame out{.width = width, .height = height};
        for (int i = 0; i < 4; ++i)
            out.camera.viewFromWorld[5 * i] = 1;
        out.camera.clipFromView[0] = 1;
        out.camera.clipFromView[5] = -1;
        out.camera.clipFromView[11] = -1;
        out.camera.clipFromView[14] = 0.1f;
        out.normalRoughness = normals.view.get();
        out.albedo = albedo.view.get();
        out.depth = depth.view.get();
        out.radiance = radiance.view.get();
        return out;
    }

    // Returns the bytes of an image in GENERAL.
    static std::vector<std::byte> read(const ExactHost& host, const gpu::Image& image)
    {
        const VkDeviceSize size = image.format == VK_FORMAT_R8G8B8A8_UNORM ? 4 : 16;
        const gpu::Buffer buffer =
            gpu::createBuffer(host.gpu(), "bytes", size * width * height,
                              VK_BUFFER_USAGE_TRANSFER_DST_BIT, gpu::MemoryUse::Readback);
        host.submitAndWait([&](VkCommandBuffer cmd) {
            moveTo(cmd, image, VK_IMAGE_ASPECT_COLOR_BIT, VK_IMAGE_LAYOUT_GENERAL,
                   VK_IMAGE_LAYOUT_TRANSFER_SRC_OPTIMAL);
            const VkBufferImageCopy region{.imageSubresource = {VK_IMAGE_ASPECT_COLOR_BIT, 0, 0, 1},
                                           .imageExtent = {width, height, 1}};
            vkCmdCopyImageToBuffer(cmd, image.image.get(), VK_IMAGE_LAYOUT_TRANSFER_SRC_OPTIMAL,
                                   buffer.get(), 1, &region);
            const VkMemoryBarrier toHost{.sType = VK_STRUCTURE_TYPE_MEMORY_BARRIER,
                                         .srcAccessMask = VK_ACCESS_TRANSFER_WRITE_BIT,
                                         .dstAccessMask = VK_ACCESS_HOST_READ_BIT};
            vkCmdPipelineBarrier(cmd, VK_PIPELINE_STAGE_TRANSFER_BIT, VK_PIPELINE_STAGE_HOST_BIT, 0,
                                 1, &toHost, 0, nullptr, 0, nullptr);
        });
        return {buffer.mapped, buffer.mapped + size * width * height};
    }

private:
    static gpu::Image make(const ExactHost& host, VkFormat format, VkImageUsageFlags usage)
    {
        return gpu::createImage(host.gpu(), "picture", format, width, height, usage,
                                VK_IMAGE_ASPECT_COLOR_BIT);
    }
    static void fill(VkCommandBuffer cmd, const gpu::Image& image, const VkClearColorValue& colour,
                     VkImageLayout to)
    {
        constexpr VkImageAspectFlags aspect = VK_IMAGE_ASPECT_COLOR_BIT;
        moveTo(cmd, image, aspect, VK_IMAGE_LAYOUT_UNDEFINED, VK_IMAGE_LAYOUT_TRANSFER_DST_OPTIMAL);
        const VkImageSubresourceRange all{aspect, 0, 1, 0, 1};
        vkCmdClearColorImage(cmd, image.image.get(), VK_IMAGE_LAYOUT_TRANSFER_DST_OPTIMAL, &colour,
                             1, &all);
        moveTo(cmd, image, aspect, VK_IMAGE_LAYOUT_TRANSFER_DST_OPTIMAL, to);
    }
};

constexpr CndGBufferDesc channels{.roughness = CND_CHANNEL_NORMAL_A, .dielectricF0 = 0.04f};

template <typename T>
T take(Result<T> result)
{
    EXPECT_TRUE(result) << result.error().message;
    return std::move(result.value());
}

void expectDone(const Result<void>& result)
{
    EXPECT_TRUE(result) << result.error().message;
}

// Each of these functions creates a module, records and submits two frames, and returns the image.

std::vector<std::byte> light(const ExactHost& host, const Pictures& pictures)
{
    auto lighting = take(Lighting::create(
        host.desc(), {.framesInFlight = 2,
                      .gbufferLayout = CND_GBUFFER_HOST,
                      .timestamps = VK_TRUE,
                      .gbuffer = channels,
                      .forwardStages = VK_SHADER_STAGE_VERTEX_BIT | VK_SHADER_STAGE_FRAGMENT_BIT}));
    const CndLight lights[] = {
        {.type = CND_LIGHT_SPHERE,
         .position = {0, 0, -3},
         .radius = 0.2f,
         .emission = {1000, 1000, 1000},
         .influenceRadius = 5},
        {.type = CND_LIGHT_TUBE,
         .position = {1, 1, -3},
         .radius = 0.1f,
         .emission = {1000, 500, 1000},
         .influenceRadius = 5,
         .axisU = {0.5f, 0, 0}},
        {.type = CND_LIGHT_DIRECTIONAL, .direction = {0, 0, -1}, .emission = {10, 10, 10}}};
    expectDone(lighting.setLights(lights, {0, 0, 0}));
    auto view = take(lighting.createView({.maxWidth = width, .maxHeight = height}));
    host.submitAndWait([&](VkCommandBuffer cmd) {
        for (uint32_t slot = 0; slot < 2; ++slot) {
            auto frame = pictures.frame<CndLightingFrame>();
            frame.frameSlot = slot;
            frame.specularMethod = CND_SPECULAR_CONIC;
            frame.countPairs = VK_TRUE;
            expectDone(view.record(cmd, frame));
        }
    });
    EXPECT_TRUE(view.stats(1).value());
    return Pictures::read(host, pictures.radiance);
}

std::vector<std::byte> surround(const ExactHost& host, const Pictures& pictures)
{
    auto environment = take(Environment::create(host.desc(), {.framesInFlight = 2,
                                                              .gbufferLayout = CND_GBUFFER_HOST,
                                                              .cubeSize = 64,
                                                              .timestamps = VK_TRUE,
                                                              .gbuffer = channels}));
    host.submitAndWait([&](VkCommandBuffer cmd) {
        expectDone(
            environment.recordMap(cmd, {.width = width,
                                        .height = height,
                                        .equirectangular = pictures.surroundings.view.get()}));
        for (uint32_t slot = 0; slot < 2; ++slot) {
            auto frame = pictures.frame<CndEnvironmentFrame>();
            frame.frameSlot = slot;
            frame.worldFromEnvironment[0] = frame.worldFromEnvironment[4] =
                frame.worldFromEnvironment[8] = 1;
            frame.scale = 1;
            if (slot)
                moveTo(cmd, pictures.radiance, VK_IMAGE_ASPECT_COLOR_BIT, VK_IMAGE_LAYOUT_GENERAL,
                       VK_IMAGE_LAYOUT_GENERAL);
            expectDone(environment.record(cmd, frame));
        }
    });
    return Pictures::read(host, pictures.radiance);
}

std::vector<std::byte> expose(const ExactHost& host, const Pictures& pictures)
{
    auto exposure =
        take(Exposure::create(host.desc(), {.framesInFlight = 2, .timestamps = VK_TRUE}));
    host.submitAndWait([&](VkCommandBuffer cmd) {
        for (uint32_t slot = 0; slot < 2; ++slot) {
            CndExposureFrame frame{.frameSlot = slot,
                                   .width = width,
                                   .height = height,
                                   .radiance = pictures.radiance.view.get(),
                                   .radianceImageLayout = VK_IMAGE_LAYOUT_GENERAL,
                                   .display = pictures.display.view.get(),
                                   .deltaTime = 0.1f,
                                   .reset = slot == 0};
            cndDefaultExposureSettings(&frame.settings);
            if (slot)
                moveTo(cmd, pictures.display, VK_IMAGE_ASPECT_COLOR_BIT, VK_IMAGE_LAYOUT_GENERAL,
                       VK_IMAGE_LAYOUT_GENERAL);
            expectDone(exposure.record(cmd, frame));
        }
    });
    return Pictures::read(host, pictures.display);
}

std::vector<std::byte> imageOf(const ExactHost& host, uint32_t module)
{
    const Pictures pictures(host);
    return module == lightingBit      ? light(host, pictures)
           : module == environmentBit ? surround(host, pictures)
                                      : expose(host, pictures);
}

class Requirements : public GpuTest, public ::testing::WithParamInterface<uint32_t>
{
};

} // namespace

TEST_P(Requirements, ADeviceWithExactlyWhatIsListedIsEnough)
{
    const uint32_t module = GetParam();
    std::vector<std::byte> expected;
    // Every device compiles the kernels again.
    std::vector<uint32_t> versions = {VK_API_VERSION_1_3, VK_API_VERSION_1_1};
    if (fullTests())
        versions.push_back(VK_API_VERSION_1_2);
    for (const uint32_t version : versions) {
        const ExactHost host(version, module, Features::AsListed);
        const std::vector<std::byte> image = imageOf(host, module);
        for (const app::ValidationMessage& m : host.takeMessages())
            ADD_FAILURE() << "Vulkan 1." << VK_API_VERSION_MINOR(version) << ": " << m.text;
        if (expected.empty())
            expected = image;
        EXPECT_EQ(image, expected) << VK_API_VERSION_MINOR(version);
        EXPECT_GT(std::count_if(image.begin(), image.end(),
                                [](std::byte b) { return b != std::byte(0); }),
                  int(image.size() / 8));
    }
}

// The only feature that modules list is needed by those that list it.
TEST_P(Requirements, ADeviceWithoutTheListedFeatureIsNotEnough)
{
    if (!validates())
        GTEST_SKIP() << "only validation notices that a feature is not enabled";
    const uint32_t module = GetParam();
    const ExactHost host(VK_API_VERSION_1_3, module, Features::None);
    imageOf(host, module);
    const auto messages = host.takeMessages();
    EXPECT_EQ(messages.empty(), module == exposureBit);
    for (const app::ValidationMessage& m : messages)
        EXPECT_NE(m.text.find("SPIR-V"), std::string::npos) << m.text;
}

INSTANTIATE_TEST_SUITE_P(Modules, Requirements,
                         ::testing::Values(lightingBit, environmentBit, exposureBit),
                         [](const auto& module) {
                             return std::string(module.param == lightingBit      ? "Lighting"
                                                : module.param == environmentBit ? "Environment"
                                                                                 : "Exposure");
                         });

// The loader's answer for an instance of Vulkan 1.0, whatever the device has.
TEST_F(GpuTest, AnInstanceOfVulkan10IsNamed)
{
    for (const bool stated : {false, true}) {
        const VkApplicationInfo application{.sType = VK_STRUCTURE_TYPE_APPLICATION_INFO,
                                            .apiVersion = stated ? VK_API_VERSION_1_0 : 0};
        const VkInstanceCreateInfo info{.sType = VK_STRUCTURE_TYPE_INSTANCE_CREATE_INFO,
                                        .pApplicationInfo = stated ? &application : nullptr};
        CndDeviceDesc desc{.getInstanceProcAddr = vkGetInstanceProcAddr,
                           .apiVersion = application.apiVersion};
        ASSERT_EQ(vkCreateInstance(&info, nullptr, &desc.instance), VK_SUCCESS);
        uint32_t count = 1;
        vkEnumeratePhysicalDevices(desc.instance, &count, &desc.physicalDevice);
        const auto result = checkDevice(desc);
        EXPECT_EQ(result.error().code, CND_ERROR_UNSUPPORTED);
        EXPECT_NE(std::string(result.error().message).find("VkApplicationInfo::apiVersion"),
                  std::string::npos)
            << result.error().message;
        vkDestroyInstance(desc.instance, nullptr);
    }
}

} // namespace candelabra::test
