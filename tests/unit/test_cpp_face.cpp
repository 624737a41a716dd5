// SPDX-License-Identifier: Apache-2.0
// Tests what candelabra.hpp does without a device: ownership, results, arguments passed through.
#include <string>
#include <utility>
#include <vector>

#include <gtest/gtest.h>

#include "candelabra/candelabra.hpp"

namespace candelabra::test
{
namespace
{

std::vector<int> destroyed;

void destroy(const int* handle)
{
    destroyed.push_back(*handle);
}

using Owned = detail::Owner<const int*, destroy>;

TEST(CppFace, MoveAssignmentReleasesWhatWasOwned)
{
    destroyed.clear();
    const int first = 1, second = 2;
    {
        Owned a(&first), b(&second);
        a = std::move(b);
        EXPECT_EQ(destroyed, std::vector{1});
        EXPECT_EQ(a.get(), &second);
        EXPECT_EQ(b.get(), nullptr);
        Owned& same = a;
        a = std::move(same);
        EXPECT_EQ(a.get(), &second);
    }
    EXPECT_EQ(destroyed, (std::vector{1, 2}));
}

TEST(CppFace, PowerOfALight)
{
    const CndLight point{.type = CND_LIGHT_POINT, .emission = {1, 2, 3}, .influenceRadius = 1};
    auto power = luminousPowerOfLight(point);
    ASSERT_TRUE(power) << power.error().message;
    EXPECT_FLOAT_EQ(power.value()[2], 12 * 3.14159265f);
    const std::array<float, 3> corners[] = {{0, 0, 0}, {2, 0, 0}, {0, 1, 0}};
    CndLight polygonLight{.emission = {1, 1, 1}};
    CndPolygon polygon;
    ASSERT_TRUE(polygonFromCorners(corners, polygonLight, polygon));
    EXPECT_NEAR(luminousPowerOfLight(polygonLight).value()[0], 3.14159265f, 1e-6f); // 1 m^2
    const auto line = polygonFromCorners(std::span(corners).first(2), polygonLight, polygon);
    EXPECT_STREQ(line.error().message, "a polygon must have 3 to 8 corners");
    const auto none = luminousPowerOfLight({.type = CND_LIGHT_DIRECTIONAL});
    EXPECT_FALSE(none);
    EXPECT_EQ(none.error().code, CND_ERROR_INVALID_ARGUMENT);
    EXPECT_STRNE(none.error().message, "");
}

TEST(CppFace, ResultsGiveTheirValue)
{
    Result<Owned> result(Owned{});
    EXPECT_EQ(&*result, &result.value());
    EXPECT_EQ(result->get(), nullptr);
    const int number = 3;
    result = Owned(&number);
    const Owned taken = *std::move(result); // can only be moved
    EXPECT_EQ(taken.get(), &number);
    const Result<int> constant = 5;
    EXPECT_EQ(*constant, 5);
    Result<void>().value();
}

// A host that does not check learns what failed, not only that something did.
TEST(CppFace, ResultsWithoutAValuePrintTheirError)
{
    const CndLight directional{.type = CND_LIGHT_DIRECTIONAL};
    auto power = luminousPowerOfLight(directional);
    ASSERT_FALSE(power);
    const std::string printed = std::string("candelabra: ") + power.error().message;
    EXPECT_DEATH(power.value(), printed);
    EXPECT_DEATH(*std::as_const(power), printed);
    EXPECT_DEATH(static_cast<void>(power->size()), printed);
    EXPECT_DEATH(checkDevice({}).value(), "candelabra: CndDeviceDesc: .* must not be null");
}

TEST(CppFace, EveryElementHasAnId)
{
    Lighting none;
    uint64_t id = 0;
    const CndLight light{};
    const CndOccluderMesh mesh{};
    const CndOccluderInstance instance{};
    EXPECT_STREQ(none.addLights({&light, 1}, {}).error().message,
                 "Lighting::addLights: ids must have as many elements as lights");
    EXPECT_STREQ(none.updateLights({&id, 1}, {}).error().message,
                 "Lighting::updateLights: ids must have as many elements as lights");
    EXPECT_STREQ(none.addOccluderMeshes({&mesh, 1}, {}).error().message,
                 "Lighting::addOccluderMeshes: ids must have as many elements as meshes");
    EXPECT_STREQ(none.addOccluders({&instance, 1}, {}).error().message,
                 "Lighting::addOccluders: ids must have as many elements as instances");
    EXPECT_STREQ(none.updateOccluders({&id, 1}, {}).error().message,
                 "Lighting::updateOccluders: ids must have as many elements as instances");
    EXPECT_STREQ(none.addOccluder(instance).error().message,
                 "cndAddOccluders: an argument is null");
}

TEST(CppFace, LargestLightCount)
{
    const VkPhysicalDeviceLimits limits{.maxStorageBufferRange = 1u << 27,
                                        .maxComputeWorkGroupCount = {65535, 65535, 65535}};
    EXPECT_EQ(maxLightCount(limits), cndMaxLightCount(&limits));
    EXPECT_GT(maxLightCount(limits), 1000000u);
}

TEST(CppFace, NoDeviceIsNoSuccess)
{
    const auto result = checkDevice({});
    EXPECT_FALSE(result);
    EXPECT_STREQ(
        result.error().message,
        "CndDeviceDesc: instance, physicalDevice and getInstanceProcAddr must not be null");
}

} // namespace
} // namespace candelabra::test
