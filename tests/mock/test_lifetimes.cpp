// SPDX-License-Identifier: Apache-2.0
// Two views with three frames in flight each, changing sizes, lights and occluders, on the mock
// driver, which knows what a submission uses until it finishes: nothing may be destroyed or written
// before that, and nothing may pile up.
#include <algorithm>
#include <numeric>
#include <random>
#include <string_view>

#include <gtest/gtest.h>

#include "candelabra/candelabra.hpp"
#include "mock/mock_vulkan.h"

namespace candelabra::test
{
namespace
{

constexpr uint32_t slots = 3, largestSide = 500, largestCount = 4000;
constexpr int frames = 500;

constexpr CndPolygon polygons[] = {{3, {{-1, -1}, {1, -1}, {0, 1}}},
                                   {4, {{-1, -1}, {1, -1}, {1, 1}, {-1, 1}}}};

struct FlightingView {
    LightingView view;
    uint32_t maxWidth = 0, maxHeight = 0;
    uint64_t submissions[slots] = {}; // 0: none
    uint64_t frame = 0;
};

CndLightingFrame testFrame(uint32_t width, uint32_t height)
{
    CndLightingFrame frame{.width = width, .height = height, .camera = MockVulkan::camera()};
    frame.normalRoughness = frame.albedo = frame.specular = frame.depth = frame.radiance =
        MockVulkan::imageView();
    frame.specularMethod = CND_SPECULAR_CONIC;
    return frame;
}

class Storm
{
public:
    Storm()
    {
        auto made =
            Lighting::create(vulkan_.desc(), {.framesInFlight = slots, .shadows = {.points = 32}});
        EXPECT_TRUE(made) << made.error().message;
        lighting_ = std::move(made.value());
    }

    void setLights(uint32_t count)
    {
        lights_.resize(count);
        for (uint32_t i = 0; i < count; ++i) {
            CndLight& light = lights_[i];
            constexpr CndLightType types[] = {CND_LIGHT_SPHERE, CND_LIGHT_TUBE, CND_LIGHT_POLYGON};
            light = {.type = types[i % 3],
                     .radius = 0.1f,
                     .emission = {float(pick(1000)), 1, 1},
                     .influenceRadius = 5,
                     .polygon = &polygons[pick(2)]};
            light.axisU[0] = light.axisV[1] = 0.5f;
        }
        const auto set = lighting_.setLights(lights_, {0, 0, 0});
        ASSERT_TRUE(set) << set.error().message;
        ids_.resize(count);
        std::iota(ids_.begin(), ids_.end(), CndLightId(0));
    }

    void updateLights()
    {
        const uint32_t size = uint32_t(lights_.size());
        const uint32_t first = pick(size), count = pick(size - first);
        const std::span some = std::span(lights_).subspan(first, count);
        for (CndLight& light : some)
            light.emission[1] = float(pick(1000)), light.polygon = &polygons[pick(2)];
        const auto updated = lighting_.updateLights(std::span(ids_).subspan(first, count), some);
        ASSERT_TRUE(updated) << updated.error().message;
    }

    // Removes some lights from the middle and adds copies of some, more of them on average.
    void exchangeLights()
    {
        const uint32_t size = uint32_t(lights_.size());
        const uint32_t first = pick(size), count = pick(size - first);
        const auto removed = lighting_.removeLights(std::span(ids_).subspan(first, count));
        ASSERT_TRUE(removed) << removed.error().message;
        lights_.erase(lights_.begin() + first, lights_.begin() + first + count);
        ids_.erase(ids_.begin() + first, ids_.begin() + first + count);
        if (lights_.empty())
            return;
        const uint32_t more = pick(largestCount / 4) + count / 2;
        for (uint32_t i = 0; i < more; ++i)
            lights_.push_back(lights_[i]);
        ids_.resize(lights_.size());
        const auto added =
            lighting_.addLights(std::span(lights_).last(more), std::span(ids_).last(more));
        ASSERT_TRUE(added) << added.error().message;
    }

    // Adds a mesh and instances of it, changes both, or removes them.
    void editOccluders()
    {
        const uint32_t what = pick(4);
        if (occluders_.empty()) {
            positions_.resize(9 * (1 + pick(5000)));
            for (float& p : positions_)
                p = float(pick(1000));
            const uint32_t triangles = uint32_t(positions_.size() / 9);
            instance_.mesh = lighting_
                                 .addOccluderMesh({.positions = positions_.data(),
                                                   .vertexCount = 3 * triangles,
                                                   .triangleCount = triangles})
                                 .value();
        }
        if (occluders_.empty() || what == 0) {
            const std::vector<CndOccluderInstance> more(1 + pick(1000), instance_);
            occluders_.resize(occluders_.size() + more.size());
            ASSERT_TRUE(lighting_.addOccluders(more, std::span(occluders_).last(more.size())));
        } else if (what == 1) {
            instance_.worldFromMesh[3] = pick(100);
            const std::vector<CndOccluderInstance> moved(occluders_.size() / 2, instance_);
            ASSERT_TRUE(
                lighting_.updateOccluders(std::span(occluders_).first(moved.size()), moved));
            ASSERT_TRUE(lighting_.replaceOccluderPositions(instance_.mesh, positions_.data()));
        } else if (what == 2) {
            const CndDevicePositions positions{.mesh = instance_.mesh,
                                               .buffer = MockVulkan::hostBuffer(),
                                               .offset = 4 * pick(1000),
                                               .stride = 12 + 4 * pick(6)};
            ASSERT_TRUE(lighting_.replaceOccluderPositionsOnDevice({&positions, 1}));
        } else {
            ASSERT_TRUE(lighting_.removeOccluders(occluders_));
            ASSERT_TRUE(lighting_.removeOccluderMeshes({&instance_.mesh, 1}));
            occluders_.clear();
        }
    }

    void randomFrame(FlightingView& v)
    {
        const uint32_t what = pick(8); // what to change while frames are in flight
        if (what == 0)
            setLights(pick(largestCount));
        else if (what == 1 && !lights_.empty())
            updateLights();
        else if (what == 2 && !lights_.empty())
            exchangeLights();
        else if (what == 3)
            editOccluders();
        frame(v, 1 + pick(largestSide), 1 + pick(largestSide));
    }

    void frame(FlightingView& v, uint32_t width, uint32_t height)
    {
        const uint32_t slot = uint32_t(v.frame++ % slots);
        wait(v, slot);
        if (width > v.maxWidth || height > v.maxHeight)
            resize(v, width, height);
        CndLightingFrame frame = testFrame(width, height);
        frame.frameSlot = slot;
        const auto recorded = v.view.record(MockVulkan::commandBuffer(), frame);
        ASSERT_TRUE(recorded) << recorded.error().message;
        v.submissions[slot] = vulkan_.submit();
    }

    void wait(FlightingView& v, uint32_t slot)
    {
        if (const uint64_t submission = std::exchange(v.submissions[slot], 0))
            vulkan_.finish(submission);
    }

    // Returns the bytes of all memory, and the number of objects.
    std::pair<VkDeviceSize, size_t> held() const
    {
        VkDeviceSize bytes = 0;
        for (const auto& [handle, memory] : vulkan_.memories)
            bytes += memory.size;
        return {bytes, vulkan_.alive.size()};
    }

    const MockVulkan& vulkan() const { return vulkan_; }

private:
    // Returns a random number in 0 .. below - 1.
    uint32_t pick(uint32_t below) { return uint32_t(random_() % below); }

    void resize(FlightingView& v, uint32_t width, uint32_t height)
    {
        for (uint32_t slot = 0; slot < slots; ++slot)
            wait(v, slot);
        v.maxWidth = std::max(width, v.maxWidth);
        v.maxHeight = std::max(height, v.maxHeight);
        auto made = lighting_.createView({.maxWidth = v.maxWidth,
                                          .maxHeight = v.maxHeight,
                                          .listBudget = 1 << 20,
                                          .shadowBudget = 1 << 20});
        ASSERT_TRUE(made) << made.error().message;
        v.view = std::move(made.value());
    }

    MockVulkan vulkan_;
    std::mt19937 random_{5};
    Lighting lighting_;
    std::vector<CndLight> lights_;
    std::vector<CndLightId> ids_;
    std::vector<float> positions_; // of the mesh of occluders
    CndOccluderInstance instance_{.worldFromMesh = {1, 0, 0, 0, 0, 1, 0, 0, 0, 0, 1, 0}};
    std::vector<CndOccluderId> occluders_;
};

} // namespace

TEST(Lifetimes, StormOfSizesLightsAndOccluders)
{
    Storm storm;
    FlightingView views[2];
    std::pair<VkDeviceSize, size_t> early{};
    for (int i = 0; i < frames && !::testing::Test::HasFailure(); ++i) {
        for (FlightingView& v : views)
            storm.randomFrame(v);
        if (i == frames / 2)
            early = storm.held();
    }
    for (const std::string& what : storm.vulkan().misuse)
        ADD_FAILURE() << what;
    EXPECT_GT(early.first, 1u << 20);
    // Sizes and counts reached their maximum long before; only what waits to be freed varies.
    const auto [bytes, objects] = storm.held();
    EXPECT_LT(double(bytes), 1.5 * double(early.first));
    EXPECT_LT(double(objects), 1.2 * double(early.second));
    for (FlightingView& v : views)
        for (uint32_t slot = 0; slot < slots; ++slot)
            storm.wait(v, slot);
}

// Buffers that a larger set of lights replaced live only as long as frames in flight use them.
TEST(Lifetimes, OutgrownBuffersAreFreed)
{
    Storm storm;
    FlightingView view;
    const auto allSlots = [&] {
        for (uint32_t slot = 0; slot < slots; ++slot)
            storm.frame(view, 64, 64);
    };
    allSlots();
    storm.setLights(10 * largestCount);
    const VkDeviceSize both = storm.held().first;
    allSlots();
    allSlots(); // the host promises that the frames recorded before growing have finished
    storm.setLights(10 * largestCount);
    storm.setLights(10 * largestCount);
    EXPECT_LT(storm.held().first, both);
    for (uint32_t slot = 0; slot < slots; ++slot)
        storm.wait(view, slot);
    for (const std::string& what : storm.vulkan().misuse)
        ADD_FAILURE() << what;
}

// A light set that fails while buffers grow leaves the old set in place, but perhaps larger buffers
// in a view: what an earlier frame wrote is not in them, so the next frame makes its lists again.
TEST(Lifetimes, ListsAreNotReusedAfterAFailedLightSet)
{
    uint64_t failing = 0;
    for (bool failed = true; failed && !HasFailure(); ++failing) {
        MockVulkan vulkan;
        Lighting lighting =
            std::move(Lighting::create(vulkan.desc(), {.framesInFlight = 1}).value());
        LightingView view =
            std::move(lighting.createView({.maxWidth = 64, .maxHeight = 64}).value());
        const std::vector<CndLight> lights(largestCount, {.type = CND_LIGHT_SPHERE,
                                                          .radius = 0.1f,
                                                          .emission = {1, 1, 1},
                                                          .influenceRadius = 5});
        const auto preparesLights = [&] {
            CndLightingFrame frame = testFrame(64, 64);
            frame.surfacesUnchanged = VK_TRUE;
            EXPECT_TRUE(view.record(MockVulkan::commandBuffer(), frame));
            vulkan.finish(vulkan.submit());
            const CndLightingStats stats = view.stats(0).value().value();
            const auto* const prepare = std::find_if(
                stats.passes, stats.passes + stats.passCount,
                [](const CndPassPlan& p) { return std::string_view(p.name) == "prepare_lights"; });
            return !prepare->skipped;
        };
        ASSERT_TRUE(lighting.setLights(std::span(lights).first(1), {0, 0, 0}));
        EXPECT_TRUE(preparesLights());
        EXPECT_FALSE(preparesLights()) << "nothing has changed";
        vulkan.failingCall = vulkan.failableCalls.size() + failing;
        failed = !lighting.setLights(lights, {0, 0, 0});
        EXPECT_TRUE(preparesLights()) << vulkan.failed << ", call " << failing;
    }
    EXPECT_GT(failing, 10u);
}

// No kernel looks for shadows in a frame in which nothing has moved. Occluders that cannot be added
// may still have led to larger buffers, and the next frame asks again.
TEST(Lifetimes, StillFramesDispatchNothingForShadows)
{
    constexpr const char* kernels[] = {"prepare_occluders", "polygon_facets", "prove_dark",
                                       "ask_pairs",         "list_occluders", "pair_visibility"};
    const float triangle[] = {0, 0, -1, 1, 0, -1, 0, 1, -1};
    std::vector<CndLight> lights(3, {.influenceRadius = 5, .polygon = &polygons[0]});
    lights[0].type = CND_LIGHT_SPHERE;
    lights[0].radius = 0.1f;
    lights[1].type = CND_LIGHT_POLYGON;
    lights[1].axisU[0] = lights[1].axisV[1] = 0.5f;
    lights[2].type = CND_LIGHT_DIRECTIONAL;
    lights[2].direction[1] = -1;
    std::vector<CndOccluderInstance> instances(
        1000, {.worldFromMesh = {1, 0, 0, 0, 0, 1, 0, 0, 0, 0, 1, 0}});
    std::vector<CndOccluderId> ids(instances.size());
    uint64_t failing = 0;
    for (bool failed = true; failed && !HasFailure(); ++failing) {
        MockVulkan vulkan;
        Lighting lighting = std::move(Lighting::create(vulkan.desc(), {.framesInFlight = 1,
                                                                       .timestamps = VK_TRUE,
                                                                       .shadows = {.points = 32}})
                                          .value());
        LightingView view =
            std::move(lighting.createView({.maxWidth = 64, .maxHeight = 64}).value());
        ASSERT_TRUE(lighting.setLights(lights, {0, 0, 0}));
        const CndOccluderMeshId mesh =
            lighting.addOccluderMesh({.positions = triangle, .vertexCount = 3, .triangleCount = 1})
                .value();
        for (CndOccluderInstance& instance : instances)
            instance.mesh = mesh;
        const auto dispatched = [&] {
            CndLightingFrame frame = testFrame(64, 64);
            frame.surfacesUnchanged = VK_TRUE;
            EXPECT_TRUE(view.record(MockVulkan::commandBuffer(), frame));
            vulkan.finish(vulkan.submit());
            const CndLightingStats stats = view.stats(0).value().value();
            return std::ranges::count_if(kernels, [&](const std::string_view kernel) {
                return std::any_of(stats.kernelTimes, stats.kernelTimes + stats.kernelTimeCount,
                                   [&](const CndKernelTime& t) { return t.name == kernel; });
            });
        };
        ASSERT_TRUE(lighting.addOccluders(std::span(instances).first(1), std::span(ids).first(1)));
        EXPECT_EQ(dispatched(), std::ssize(kernels));
        EXPECT_EQ(dispatched(), 0) << "nothing has changed";
        vulkan.failingCall = vulkan.failableCalls.size() + failing;
        failed = !lighting.addOccluders(instances, ids);
        vulkan.failingCall = UINT64_MAX;
        EXPECT_EQ(dispatched(), std::ssize(kernels)) << vulkan.failed << ", call " << failing;
    }
    EXPECT_GT(failing, 5u);
}

} // namespace candelabra::test
