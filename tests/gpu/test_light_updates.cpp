// SPDX-License-Identifier: Apache-2.0
// Replacing some lights of a set: the image is that of the set given anew, and only they are
// uploaded.
#include <random>

#include "gpu/lighting_harness.h"

namespace candelabra::test
{
namespace
{

// Bytes copied between buffers; Vulkan's function pointers carry no context.
struct Interposer {
    PFN_vkGetInstanceProcAddr getInstanceProcAddr = nullptr;
    PFN_vkGetDeviceProcAddr getDeviceProcAddr = nullptr;
    PFN_vkCmdCopyBuffer copyBuffer = nullptr;
    VkDeviceSize copied = 0;
} interposer;

void VKAPI_CALL copyBuffer(VkCommandBuffer cmd, VkBuffer from, VkBuffer to, uint32_t count,
                           const VkBufferCopy* regions)
{
    for (uint32_t i = 0; i < count; ++i)
        interposer.copied += regions[i].size;
    interposer.copyBuffer(cmd, from, to, count, regions);
}

PFN_vkVoidFunction VKAPI_CALL getDeviceProcAddr(VkDevice device, const char* name)
{
    if (std::string(name) == "vkCmdCopyBuffer")
        return reinterpret_cast<PFN_vkVoidFunction>(copyBuffer);
    return interposer.getDeviceProcAddr(device, name);
}

PFN_vkVoidFunction VKAPI_CALL getInstanceProcAddr(VkInstance instance, const char* name)
{
    if (std::string(name) == "vkGetDeviceProcAddr")
        return reinterpret_cast<PFN_vkVoidFunction>(getDeviceProcAddr);
    return interposer.getInstanceProcAddr(instance, name);
}

CndDeviceDesc interpose(const CndDeviceDesc& host)
{
    interposer.getInstanceProcAddr = host.getInstanceProcAddr;
    interposer.getDeviceProcAddr = reinterpret_cast<PFN_vkGetDeviceProcAddr>(
        host.getInstanceProcAddr(host.instance, "vkGetDeviceProcAddr"));
    interposer.copyBuffer = reinterpret_cast<PFN_vkCmdCopyBuffer>(
        interposer.getDeviceProcAddr(host.device, "vkCmdCopyBuffer"));
    CndDeviceDesc desc = host;
    desc.getInstanceProcAddr = getInstanceProcAddr;
    return desc;
}

class LightUpdates : public LightingTest
{
protected:
    void SetUp() override
    {
        LightingTest::SetUp();
        if (IsSkipped() || HasFatalFailure())
            return;
        CndCamera camera;
        setPerspective(camera, 1.0, 4.0 / 3, 0.1);
        g_ = randomGBuffer(96, 72, camera, 0, 3);
        images_ = uploadImages(g_);
        const CndDeviceDesc host = interpose(deviceDesc());
        CndError error{};
        const CndLightingDesc desc{.structSize = sizeof desc,
                                   .framesInFlight = 2,
                                   .specularMethods = 1u << RunOptions{}.specular};
        ASSERT_EQ(cndCreateLighting(&host, &desc, &lighting_, &error), CND_SUCCESS)
            << error.message;
        const CndLightingViewDesc viewDesc{sizeof viewDesc, g_.width, g_.height, 0};
        ASSERT_EQ(cndCreateLightingView(lighting_, &viewDesc, &view_, &error), CND_SUCCESS)
            << error.message;
    }
    void TearDown() override
    {
        cndDestroyLightingView(view_);
        cndDestroyLighting(lighting_);
        images_ = {};
        LightingTest::TearDown();
    }
    std::vector<glm::vec4> frame()
    {
        CndError error{};
        CndLightingFrame f = frameOf(g_, images_, {});
        f.frameSlot = slot_ = 1 - slot_;
        interposer.copied = 0;
        context().submitAndWait([&](VkCommandBuffer cmd) {
            clearRadiance(cmd, images_);
            EXPECT_EQ(cndRecordLighting(view_, cmd, &f, &error), CND_SUCCESS) << error.message;
        });
        return readRadiance(images_);
    }
    void set(const std::vector<CndLight>& lights)
    {
        CndError error{};
        const CndLightSet s{sizeof s, uint32_t(lights.size()), lights.data(), {}, nullptr};
        EXPECT_EQ(cndSetLights(lighting_, &s, &error), CND_SUCCESS) << error.message;
    }
    // Both in the set and in the module.
    void update(std::vector<CndLight>& lights, uint32_t first, const std::vector<CndLight>& with)
    {
        CndError error{};
        std::copy(with.begin(), with.end(), lights.begin() + first);
        EXPECT_EQ(cndUpdateLights(lighting_, first, uint32_t(with.size()), with.data(), &error),
                  CND_SUCCESS)
            << error.message;
    }
    std::vector<glm::vec4> expected(const std::vector<CndLight>& lights)
    {
        return run(g_, lights).radiance;
    }

    CpuGBuffer g_;
    Images images_;
    CndLighting lighting_{};
    CndLightingView view_{};
    uint32_t slot_ = 0;
};

constexpr double tolerance = 1e-6; // the order of lights follows where the first set was

TEST_F(LightUpdates, ShowTheSetGivenAnewAndUploadTheirOwnBytes)
{
    std::vector<CndLight> lights = randomSpheres(g_, 20000, 4);
    set(lights);
    frame();
    EXPECT_GE(interposer.copied, 20000u * 64);
    const std::vector<CndLight> fresh = randomSpheres(g_, 1000, 5);
    update(lights, 7000, fresh);
    const std::vector<glm::vec4> image = frame();
    EXPECT_GE(interposer.copied, 1000u * 64);
    EXPECT_LE(interposer.copied, 1000u * 64 + 1024); // and statistics
    EXPECT_LE(maxRelativeDifference(image, expected(lights)), tolerance);
    const std::vector<glm::vec4> again = frame(); // nothing new
    EXPECT_LE(interposer.copied, 1024u);
    EXPECT_EQ(maxRelativeDifference(again, image), 0);
}

TEST_F(LightUpdates, OfMixedTypesAddUpUntilTheyAreRecorded)
{
    std::vector<CndLight> lights = randomSpheres(g_, 300, 6);
    for (size_t i = 0; i < lights.size(); i += 3)
        lights[i].type = CND_LIGHT_POINT;
    const auto someOther = [&](uint32_t first, uint32_t count, uint32_t seed) {
        std::vector<CndLight> with = randomSpheres(g_, count, seed);
        for (uint32_t i = 0; i < count; ++i)
            with[i].type = lights[first + i].type;
        return with;
    };
    set(lights);
    update(lights, 10, someOther(10, 40, 7)); // before the set was recorded
    EXPECT_LE(maxRelativeDifference(frame(), expected(lights)), tolerance);
    update(lights, 0, someOther(0, 100, 8));
    update(lights, 50, someOther(50, 250, 9)); // over some of those before
    update(lights, 299, someOther(299, 1, 10));
    EXPECT_LE(maxRelativeDifference(frame(), expected(lights)), tolerance);
    update(lights, 0, someOther(0, 300, 11)); // all
    update(lights, 3, someOther(3, 5, 12));
    EXPECT_LE(maxRelativeDifference(frame(), expected(lights)), tolerance);
}

TEST_F(LightUpdates, ThatAreWrongReplaceNothing)
{
    std::vector<CndLight> lights = randomSpheres(g_, 50, 13);
    set(lights);
    const std::vector<glm::vec4> before = frame();
    const auto refused = [&](const char* named, uint32_t first, std::vector<CndLight> with) {
        CndError error{};
        EXPECT_EQ(cndUpdateLights(lighting_, first, uint32_t(with.size()), with.data(), &error),
                  CND_ERROR_INVALID_ARGUMENT);
        EXPECT_NE(std::string(error.message).find(named), std::string::npos) << error.message;
    };
    std::vector<CndLight> with = randomSpheres(g_, 10, 14);
    refused("41 to 51", 41, with);
    refused("4294967295", UINT32_MAX, with);
    with[3].type = CND_LIGHT_POINT;
    refused("lights[3]: type is 0, of the light it replaces 1", 0, with);
    with[3].type = CND_LIGHT_SPHERE;
    with[9].radius = -1;
    refused("lights[9]: radius", 0, with);
    CndError error{};
    EXPECT_EQ(cndUpdateLights(lighting_, 0, 1, nullptr, &error), CND_ERROR_INVALID_ARGUMENT);
    EXPECT_EQ(cndUpdateLights(lighting_, 50, 0, nullptr, &error), CND_SUCCESS);
    EXPECT_EQ(maxRelativeDifference(frame(), before), 0);
    EXPECT_LE(interposer.copied, 1024u);
}

} // namespace
} // namespace candelabra::test
