// SPDX-License-Identifier: Apache-2.0
// Adds, replaces and removes some lights of a set: the image must equal that of the whole set given
// again, and only these lights may be uploaded.
#include <ctime>
#include <iostream>
#include <numeric>
#include <random>

#include "gpu/lighting_harness.h"
#include "scene/polygons.h"
#include "shared/light_edits.h"

namespace candelabra::test
{
namespace
{

// Counts bytes copied between buffers, and the records that the kernel light_edits copies. Global
// because Vulkan's function pointers carry no context.
struct CopyCounter {
    PFN_vkGetInstanceProcAddr getInstanceProcAddr = nullptr;
    PFN_vkGetDeviceProcAddr getDeviceProcAddr = nullptr;
    PFN_vkCmdCopyBuffer copyBuffer = nullptr;
    PFN_vkCmdPushConstants pushConstants = nullptr;
    PFN_vkCmdDispatch dispatch = nullptr;
    VkDeviceSize copied = 0;
    uint32_t copies = 0, edited = 0;
    uint32_t next = 0; // what `edited` grows by in the next dispatch
} copyCounter;

void VKAPI_CALL copyBuffer(VkCommandBuffer cmd, VkBuffer from, VkBuffer to, uint32_t count,
                           const VkBufferCopy* regions)
{
    for (uint32_t i = 0; i < count; ++i)
        copyCounter.copied += regions[i].size;
    copyCounter.copies += count;
    copyCounter.copyBuffer(cmd, from, to, count, regions);
}

// No other kernel of these frames has parameters of this size and is not dispatched indirectly.
void VKAPI_CALL pushConstants(VkCommandBuffer cmd, VkPipelineLayout layout,
                              VkShaderStageFlags stages, uint32_t offset, uint32_t size,
                              const void* values)
{
    copyCounter.next = size == sizeof(gpu::LightEditsParams)
                           ? static_cast<const gpu::LightEditsParams*>(values)->count
                           : 0;
    copyCounter.pushConstants(cmd, layout, stages, offset, size, values);
}

void VKAPI_CALL dispatch(VkCommandBuffer cmd, uint32_t x, uint32_t y, uint32_t z)
{
    copyCounter.edited += std::exchange(copyCounter.next, 0);
    copyCounter.dispatch(cmd, x, y, z);
}

PFN_vkVoidFunction VKAPI_CALL countedDeviceProcAddr(VkDevice device, const char* name)
{
    if (std::string(name) == "vkCmdCopyBuffer")
        return reinterpret_cast<PFN_vkVoidFunction>(copyBuffer);
    if (std::string(name) == "vkCmdPushConstants")
        return reinterpret_cast<PFN_vkVoidFunction>(pushConstants);
    if (std::string(name) == "vkCmdDispatch")
        return reinterpret_cast<PFN_vkVoidFunction>(dispatch);
    return copyCounter.getDeviceProcAddr(device, name);
}

PFN_vkVoidFunction VKAPI_CALL countedInstanceProcAddr(VkInstance instance, const char* name)
{
    if (std::string(name) == "vkGetDeviceProcAddr")
        return reinterpret_cast<PFN_vkVoidFunction>(countedDeviceProcAddr);
    return copyCounter.getInstanceProcAddr(instance, name);
}

CndDeviceDesc countCopies(const CndDeviceDesc& host)
{
    copyCounter.getInstanceProcAddr = host.getInstanceProcAddr;
    copyCounter.getDeviceProcAddr = reinterpret_cast<PFN_vkGetDeviceProcAddr>(
        host.getInstanceProcAddr(host.instance, "vkGetDeviceProcAddr"));
    copyCounter.copyBuffer = reinterpret_cast<PFN_vkCmdCopyBuffer>(
        copyCounter.getDeviceProcAddr(host.device, "vkCmdCopyBuffer"));
    copyCounter.pushConstants = reinterpret_cast<PFN_vkCmdPushConstants>(
        copyCounter.getDeviceProcAddr(host.device, "vkCmdPushConstants"));
    copyCounter.dispatch = reinterpret_cast<PFN_vkCmdDispatch>(
        copyCounter.getDeviceProcAddr(host.device, "vkCmdDispatch"));
    CndDeviceDesc desc = host;
    desc.getInstanceProcAddr = countedInstanceProcAddr;
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
        g_ = randomGBuffer(96, 72, 3);
        images_ = uploadImages(g_);
        const CndDeviceDesc host = countCopies(deviceDesc());
        CndError error{};
        const CndLightingDesc desc{.structSize = sizeof desc,
                                   .framesInFlight = 2,
                                   .specularMethods = 1u << RunOptions{}.specular,
                                   .shading = CND_SHADING_CLUSTERED_BIT};
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
        CndLightingFrame f = frameOf(g_, images_, {});
        f.frameSlot = slot_ = 1 - slot_;
        copyCounter.copied = 0;
        copyCounter.copies = copyCounter.edited = copyCounter.next = 0;
        return drawFrame(view_, f, images_);
    }
    void set(const std::vector<CndLight>& lights) { setLights(lighting_, lights); }
    std::vector<CndLightId> add(const std::vector<CndLight>& lights)
    {
        CndError error{};
        std::vector<CndLightId> ids(lights.size());
        EXPECT_EQ(
            cndAddLights(lighting_, uint32_t(lights.size()), lights.data(), ids.data(), &error),
            CND_SUCCESS)
            << error.message;
        return ids;
    }
    void update(const std::vector<CndLightId>& ids, const std::vector<CndLight>& with)
    {
        CndError error{};
        EXPECT_EQ(cndUpdateLights(lighting_, uint32_t(ids.size()), ids.data(), with.data(), &error),
                  CND_SUCCESS)
            << error.message;
    }
    void remove(const std::vector<CndLightId>& ids)
    {
        CndError error{};
        EXPECT_EQ(cndRemoveLights(lighting_, uint32_t(ids.size()), ids.data(), &error), CND_SUCCESS)
            << error.message;
    }
    // Replaces lights from index `first` on, both in the set and in the module.
    void updateSet(std::vector<CndLight>& lights, uint32_t first, const std::vector<CndLight>& with)
    {
        std::copy(with.begin(), with.end(), lights.begin() + first);
        std::vector<CndLightId> ids(with.size());
        std::iota(ids.begin(), ids.end(), CndLightId(first));
        update(ids, with);
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

// Returns points, spheres, discs and polygons.
std::vector<CndLight> someLights(const CpuGBuffer& g, uint32_t count, uint32_t seed)
{
    std::vector<CndLight> lights = randomSpheres(g, count, seed);
    constexpr CndLightType types[] = {CND_LIGHT_SPHERE, CND_LIGHT_POINT, CND_LIGHT_DISC,
                                      CND_LIGHT_POLYGON};
    for (size_t i = 0; i < lights.size(); ++i) {
        lights[i].type = types[(i + seed) % std::size(types)];
        lights[i].direction[2] = 1;
        lights[i].twoSided = VK_TRUE;
        lights[i].axisU[0] = lights[i].axisV[1] = lights[i].radius;
        lights[i].polygon = app::somePolygon(uint32_t(i / 4) + seed);
    }
    return lights;
}

// A set of lights that are added and removed, with their ids.
struct Population {
    std::vector<CndLight> lights;
    std::vector<CndLightId> ids;
    void add(const std::vector<CndLight>& more, const std::vector<CndLightId>& theirs)
    {
        lights.insert(lights.end(), more.begin(), more.end());
        ids.insert(ids.end(), theirs.begin(), theirs.end());
    }
};

double cpuSeconds()
{
    return double(std::clock()) / CLOCKS_PER_SEC;
}

constexpr double orderTolerance = 1e-6; // the order of lights depends on where the first set was

TEST_F(LightUpdates, ShowTheSetGivenAnewAndUploadTheirOwnBytes)
{
    std::vector<CndLight> lights = randomSpheres(g_, 20000, 4);
    set(lights);
    frame();
    EXPECT_GE(copyCounter.copied, 20000u * 64);
    const std::vector<CndLight> fresh = randomSpheres(g_, 1000, 5);
    updateSet(lights, 7000, fresh);
    const std::vector<glm::vec4> image = frame();
    EXPECT_EQ(copyCounter.edited, 1000u);
    EXPECT_LE(copyCounter.copied, 1024u); // statistics
    EXPECT_LE(maxRelativeDifference(image, expected(lights)), orderTolerance);
    const std::vector<glm::vec4> again = frame(); // nothing has changed
    EXPECT_EQ(copyCounter.edited, 0u);
    EXPECT_LE(copyCounter.copied, 1024u);
    EXPECT_EQ(maxRelativeDifference(again, image), 0);
}

TEST_F(LightUpdates, OfMixedTypesAddUpUntilTheyAreRecorded)
{
    std::vector<CndLight> lights = someLights(g_, 300, 6);
    set(lights);
    updateSet(lights, 10, someLights(g_, 40, 7)); // before the set was recorded, and with other
                                                  // types
    EXPECT_LE(maxRelativeDifference(frame(), expected(lights)), orderTolerance);
    updateSet(lights, 0, someLights(g_, 100, 8));
    updateSet(lights, 50, someLights(g_, 250, 9)); // overlaps the previous ones
    updateSet(lights, 299, someLights(g_, 1, 10));
    EXPECT_LE(maxRelativeDifference(frame(), expected(lights)), orderTolerance);
    updateSet(lights, 0, someLights(g_, 300, 11)); // all
    updateSet(lights, 3, randomSpheres(g_, 5, 12));
    EXPECT_LE(maxRelativeDifference(frame(), expected(lights)), orderTolerance);
}

// Everything that may happen between two recordings, from no light to more than the buffers hold.
TEST_F(LightUpdates, OfAPopulationThatComesAndGoes)
{
    std::mt19937 random(20);
    Population now;
    const auto pickSome = [&](size_t most) {
        std::vector<size_t> some;
        for (size_t i = 0; i < now.ids.size() && some.size() < most; ++i)
            if (random() % 3 == 0)
                some.push_back(i);
        return some;
    };
    for (uint32_t step = 0; step < 40; ++step) {
        const std::vector<size_t> some = pickSome(random() % 200);
        std::vector<CndLightId> ids;
        for (const size_t i : some)
            ids.push_back(now.ids[i]);
        switch (random() % 3) {
        case 0: {
            const std::vector<CndLight> more = someLights(g_, uint32_t(random() % 150), step);
            now.add(more, add(more));
            break;
        }
        case 1: {
            const std::vector<CndLight> with = someLights(g_, uint32_t(ids.size()), 100 + step);
            update(ids, with);
            for (size_t i = 0; i < some.size(); ++i)
                now.lights[some[i]] = with[i];
            break;
        }
        default:
            std::shuffle(ids.begin(), ids.end(), random);
            remove(ids);
            for (size_t i = some.size(); i-- > 0;) {
                now.lights.erase(now.lights.begin() + std::ptrdiff_t(some[i]));
                now.ids.erase(now.ids.begin() + std::ptrdiff_t(some[i]));
            }
        }
        if (step == 25) { // larger buffers, while some edits have not been recorded
            const std::vector<CndLight> more = someLights(g_, 1200, step);
            now.add(more, add(more));
        }
        if (random() % 8 == 0 || step == 39) {
            EXPECT_LE(maxRelativeDifference(frame(), expected(now.lights)), orderTolerance) << step;
        }
    }
    EXPECT_GT(now.ids.size(), 100u);
    remove(now.ids);
    for (const glm::vec4& pixel : frame())
        EXPECT_EQ(glm::vec3(pixel), glm::vec3(0));
}

TEST_F(LightUpdates, GiveTheSameBitsForTheSameCalls)
{
    const std::vector<CndLight> lights = someLights(g_, 500, 21);
    add(lights); // without a previous set
    const std::vector<glm::vec4> added = frame();
    set(lights);
    EXPECT_TRUE(sameBits(frame(), added));
    std::vector<glm::vec4> images[2];
    for (std::vector<glm::vec4>& image : images) {
        set(lights);
        const std::vector<CndLightId> ids = add(someLights(g_, 300, 22));
        remove({3, ids[7], 499, 77, ids[299]});
        frame();
        update({ids[8], 5}, someLights(g_, 2, 23));
        remove({ids[100], 0});
        add(someLights(g_, 50, 24));
        image = frame();
    }
    EXPECT_TRUE(sameBits(images[0], images[1]));
}

// The acceptance case: edits of 1,000 lights out of a million.
TEST_F(LightUpdates, OfAMillionCostTheirOwnBytes)
{
    constexpr uint32_t all = 1000000, some = 1000;
    const auto small = [&](uint32_t count, uint32_t seed) {
        std::vector<CndLight> out = randomSpheres(g_, count, seed);
        for (CndLight& light : out) {
            light.radius *= 0.01f;
            light.influenceRadius = 0.05f;
        }
        return out;
    };
    std::vector<CndLight> lights = small(all, 25);
    double start = cpuSeconds();
    set(lights);
    const double whole = cpuSeconds() - start;
    frame();
    EXPECT_GE(copyCounter.copied, VkDeviceSize(all) * 64);

    std::vector<CndLightId> ids(some); // spread over the whole set
    for (uint32_t i = 0; i < some; ++i)
        ids[i] = i * (all / some);
    const auto edit = [&](const char* name, auto&& call) {
        start = cpuSeconds();
        call();
        const double seconds = cpuSeconds() - start;
        std::cout << name << " 1,000 of 1,000,000: " << 1e3 * seconds << " ms of CPU time, the set "
                  << 1e3 * whole << " ms\n";
        const std::vector<glm::vec4> image = frame();
        EXPECT_LE(copyCounter.copied, 1024u); // statistics
        EXPECT_LE(copyCounter.copies, 32u);   // the edits add none
        EXPECT_LE(copyCounter.edited, some);
        EXPECT_GE(copyCounter.edited, some - 1); // the last of all may have been removed
        return image;
    };
    const std::vector<CndLight> fresh = small(some, 26), more = small(some, 27);
    edit("update", [&] { update(ids, fresh); });
    edit("remove", [&] { remove(ids); });
    std::vector<CndLightId> added;
    const std::vector<glm::vec4> image = edit("add", [&] { added = add(more); });
    for (uint32_t i = 0; i < some; ++i)
        lights[ids[i]] = more[i];
    EXPECT_LE(maxRelativeDifference(image, expected(lights)), orderTolerance);
}

TEST_F(LightUpdates, ThatAreWrongChangeNothing)
{
    std::vector<CndLight> lights = randomSpheres(g_, 50, 13);
    set(lights);
    const std::vector<CndLightId> added = add(someLights(g_, 3, 15));
    EXPECT_GE(added[0], CndLightId(1) << 32);
    remove({added[1], 7});
    const std::vector<glm::vec4> before = frame();
    std::vector<CndLight> with = randomSpheres(g_, 10, 14);
    const auto refused = [&](const std::string& named, std::vector<CndLightId> ids) {
        CndError error{};
        EXPECT_EQ(cndUpdateLights(lighting_, uint32_t(ids.size()), ids.data(), with.data(), &error),
                  CND_ERROR_INVALID_ARGUMENT);
        EXPECT_NE(std::string(error.message).find(named), std::string::npos) << error.message;
        error = {};
        EXPECT_EQ(cndRemoveLights(lighting_, uint32_t(ids.size()), ids.data(), &error),
                  CND_ERROR_INVALID_ARGUMENT);
        EXPECT_NE(std::string(error.message).find(named), std::string::npos) << error.message;
    };
    refused("ids[1] is 53, the id of no light of the set", {0, 53});
    refused("ids[0] is 18446744073709551615, the id of no light of the set", {UINT64_MAX});
    refused("ids[0] is 7, the id of no light of the set", {7});
    refused("ids[0] is " + std::to_string(added[1]) + ", the id of no light of the set",
            {added[1]});
    refused("ids[0] is 50, the id of no light of the set", {50}); // perhaps the id of an older set
    refused("ids[2] is 3, and so is ids[0]", {3, added[0], 3});
    with[9].radius = -1;
    CndError error{};
    std::vector<CndLightId> ids(10);
    std::iota(ids.begin(), ids.end(), CndLightId(20));
    EXPECT_EQ(cndUpdateLights(lighting_, 10, ids.data(), with.data(), &error),
              CND_ERROR_INVALID_ARGUMENT);
    EXPECT_NE(std::string(error.message).find("cndUpdateLights: lights[9] (id 29): radius"),
              std::string::npos)
        << error.message;
    EXPECT_EQ(cndAddLights(lighting_, 10, with.data(), ids.data(), &error),
              CND_ERROR_INVALID_ARGUMENT);
    EXPECT_NE(std::string(error.message).find("cndAddLights: lights[9]: radius"), std::string::npos)
        << error.message;
    EXPECT_EQ(ids[0], 20u); // ids were not written
    EXPECT_EQ(cndUpdateLights(lighting_, 1, ids.data(), nullptr, &error),
              CND_ERROR_INVALID_ARGUMENT);
    EXPECT_EQ(cndAddLights(lighting_, 1, with.data(), nullptr, &error), CND_ERROR_INVALID_ARGUMENT);
    EXPECT_EQ(cndRemoveLights(lighting_, 1, nullptr, &error), CND_ERROR_INVALID_ARGUMENT);
    EXPECT_EQ(cndUpdateLights(lighting_, 0, nullptr, nullptr, &error), CND_SUCCESS);
    EXPECT_EQ(cndRemoveLights(lighting_, 0, nullptr, &error), CND_SUCCESS);
    EXPECT_EQ(cndAddLights(lighting_, 0, nullptr, nullptr, &error), CND_SUCCESS);
    EXPECT_EQ(maxRelativeDifference(frame(), before), 0);
    EXPECT_LE(copyCounter.copied, 1024u);
    set(lights);
    // An id of the previous set.
    refused("ids[0] is " + std::to_string(added[0]) + ", the id of no light of the set",
            {added[0]});
}

} // namespace
} // namespace candelabra::test
