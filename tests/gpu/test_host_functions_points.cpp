// SPDX-License-Identifier: Apache-2.0
// A host that finds the visible points of lights with rays of its own (CND_HOST_VISIBLE_POINTS_BIT)
// gets the image that our walk finds between the same triangles.
#include <cstring>
#include <random>
#include <string>

#include "candelabra/compiler.hpp"
#include "gpu/host_surface.h"
#include "gpu/lighting_harness.h"
#include "harness/full_tests.h"

namespace candelabra::test
{
namespace
{

// Rays against every triangle, after Moller and Trumbore. Lights that are unshadowedBy layer 1
// ignore the triangles from `second` on.
constexpr const char* tracingSource = R"(
layout(scalar, set = 1, binding = 0) readonly buffer Triangles
{
    uint count, second;
    vec3 corners[];
};
bool hits(vec3 from, vec3 ray, bool endless, float ownDistance, uint i)
{
    const vec3 a = corners[3u * i], e1 = corners[3u * i + 1u] - a, e2 = corners[3u * i + 2u] - a;
    const vec3 p = cross(ray, e2), s = from - a, q = cross(s, e1), n = cross(e1, e2);
    const float f = 1.0 / dot(e1, p), t = f * dot(e2, q), u = f * dot(s, p), v = f * dot(ray, q);
    return u >= 0.0 && v >= 0.0 && u + v <= 1.0 && t > 0.0 && (endless || t <= 1.0) &&
           abs(dot(s, n)) > ownDistance * length(n);
}
uvec2 candelabraVisiblePoints(CndVisibilityQuery q)
{
    const bool endless = q.type == CND_LIGHT_DIRECTIONAL || q.type == CND_LIGHT_DISTANT_SPHERE;
    const uint end = (q.unshadowedBy & 2u) != 0u ? second : count;
    uvec2 seen = uvec2(0u);
    for (uint i = 0u; i < q.count; ++i) {
        const vec3 ray = cndLightPoint(q, i);
        bool hidden = (q.points[i / 32u] & 1u << i % 32u) == 0u;
        for (uint k = 0u; k < end && !hidden; ++k)
            hidden = hits(q.position, ray, endless, q.ownDistance, k);
        seen[i / 32u] |= hidden ? 0u : 1u << i % 32u;
    }
    return seen;
}
)";

constexpr uint32_t blockerCount = 40, firstIgnored = 25;

class VisibilityFromHost : public LightingTest
{
protected:
    void SetUp() override
    {
        LightingTest::SetUp();
        if (IsSkipped() || HasFatalFailure())
            return;
        std::mt19937 random(4);
        const auto uniform = [&](double low, double high) {
            return low + (high - low) * double(random()) / 4294967296.0;
        };
        while (corners_.size() < 3 * blockerCount) {
            const uint32_t x = uint32_t(random() % surfaces.width);
            const uint32_t y = uint32_t(random() % surfaces.height);
            if (surfaces.depth[size_t(y) * surfaces.width + x] == surfaces.clearDepth)
                continue;
            const glm::vec3 centre(0.9 * viewPosition(surfaces, x, y)); // in front of the surface
            for (int corner = 0; corner < 3; ++corner)
                corners_.push_back(centre +
                                   glm::vec3(uniform(-1, 1), uniform(-1, 1), uniform(-1, 1)));
        }
        set_ = gpu::Bindings(device(), "triangles", {{0, VK_DESCRIPTOR_TYPE_STORAGE_BUFFER, 1}},
                             VK_SHADER_STAGE_COMPUTE_BIT, 1);
        const size_t bytes = corners_.size() * sizeof corners_[0];
        triangles_ = gpu::createBuffer(device(), "triangles", 8 + bytes,
                                       VK_BUFFER_USAGE_STORAGE_BUFFER_BIT, gpu::MemoryUse::Upload);
        triangles_.as<uint32_t>()[0] = blockerCount;
        triangles_.as<uint32_t>()[1] = firstIgnored;
        std::memcpy(static_cast<std::byte*>(triangles_.mapped) + 8, corners_.data(), bytes);
        set_.write(0, {gpu::Binding::of(0, triangles_)});
    }
    void TearDown() override
    {
        set_ = {};
        triangles_ = {};
        LightingTest::TearDown();
    }
    CompiledKernels compiled(CndCompileDesc desc)
    {
        desc.shadows = VK_TRUE;
        auto kernels = CompiledKernels::create(desc);
        EXPECT_TRUE(kernels) << kernels.error().message;
        return kernels ? std::move(kernels.value()) : CompiledKernels();
    }
    CndLighting create(const CndHostKernels& kernels)
    {
        return createLighting(surfaces, {.framesInFlight = 2,
                                         .specularMethods = 1u << CND_SPECULAR_CONIC,
                                         .shading = CND_SHADING_CLUSTERED_BIT,
                                         .hostKernels = kernels,
                                         .shadows = {.points = 32}})
            .lighting;
    }
    // Adds the triangles as two meshes in two occluder layers.
    void addOccluders(CndLighting lighting)
    {
        const std::pair<uint32_t, uint32_t> parts[] = {{0, firstIgnored},
                                                       {firstIgnored, blockerCount}};
        for (uint32_t layer = 0; layer < 2; ++layer) {
            const auto [first, end] = parts[layer];
            const CndOccluderMesh mesh{.positions = &corners_[3 * size_t(first)].x,
                                       .vertexCount = 3 * (end - first),
                                       .triangleCount = end - first};
            CndOccluderInstance instance{.worldFromMesh = {1, 0, 0, 0, 0, 1, 0, 0, 0, 0, 1, 0},
                                         .occluderLayer = layer};
            CndOccluderId id = 0;
            CndError error{};
            ASSERT_EQ(cndAddOccluderMeshes(lighting, 1, &mesh, &instance.mesh, &error), CND_SUCCESS)
                << error.message;
            ASSERT_EQ(cndAddOccluders(lighting, 1, &instance, &id, &error), CND_SUCCESS)
                << error.message;
        }
    }
    // Every third light ignores layer 1, and every fifth ignores all occluders.
    std::vector<CndLight> someLights(CndLightType type) const
    {
        std::vector<CndLight> lights = lightsOf(type, surfaces, 10, type + 1);
        for (size_t i = 0; i < lights.size(); ++i) {
            lights[i].unshadowedBy = i % 3 ? 0 : 2;
            lights[i].unshadowed = i % 5 == 4;
            lights[i].influenceRadius = 8;
        }
        return lights;
    }
    LightingResult draw(CndLighting lighting, const std::vector<CndLight>& lights,
                        RunOptions options = {})
    {
        options.specular = CND_SPECULAR_CONIC;
        options.lighting = lighting;
        options.hostSet = set_.set(0);
        return run(surfaces, lights, options);
    }
    static size_t differentPixels(const LightingResult& a, const LightingResult& b)
    {
        size_t count = 0;
        for (size_t i = 0; i < a.radiance.size(); ++i)
            count += a.radiance[i] != b.radiance[i];
        return count;
    }

    const CpuGBuffer surfaces = randomGBuffer(40, 32, 3);
    std::vector<glm::vec3> corners_;
    gpu::Bindings set_;
    gpu::Buffer triangles_;
};

} // namespace

// A ray and our test may decide differently about a point at the edge of a triangle.
TEST_F(VisibilityFromHost, RaysGiveTheImageOfOurWalk)
{
    std::vector<CndLightType> types = {CND_LIGHT_SPHERE, CND_LIGHT_POLYGON,
                                       CND_LIGHT_DISTANT_SPHERE};
    if (fullTests()) // kernels take long to create
        types.insert(types.end(), {CND_LIGHT_TUBE, CND_LIGHT_POINT});
    uint32_t mask = 0;
    for (const CndLightType type : types)
        mask |= 1u << type;
    const CompiledKernels kernels = compiled(
        {.functions = CND_HOST_VISIBLE_POINTS_BIT, .source = tracingSource, .lightTypes = mask});
    const CndLighting own = create({}), host = create(kernels.hostKernels(set_.layout()));
    addOccluders(own);
    const size_t few = surfaces.depth.size() / 300;
    for (const CndLightType type : types) {
        const auto lights = someLights(type);
        // Counting takes one more pipeline per type.
        const RunOptions options{.countPairs = type == CND_LIGHT_SPHERE};
        const LightingResult walked = draw(own, lights, options);
        const LightingResult traced = draw(host, lights, options);
        EXPECT_LE(differentPixels(walked, traced), few) << type;
        // The module does not ask where it has found that no occluder is between.
        EXPECT_LE(walked.stats.askedPairs, traced.stats.askedPairs) << type;
        EXPECT_EQ(traced.stats.askedPairs, traced.stats.contributingPairs) << type;
        EXPECT_EQ(walked.stats.hiddenEntries, 0u) << type;
        EXPECT_NEAR(double(walked.stats.darkPairs), double(traced.stats.darkPairs), 10) << type;
        EXPECT_NEAR(double(walked.stats.partlyLitPairs), double(traced.stats.partlyLitPairs), 10)
            << type;
        // Without slots, each pixel walks, or calls the function, where it evaluates the light.
        EXPECT_TRUE(agree(walked.radiance, draw(own, lights, {.shadowBudget = 4096}).radiance,
                          cndIsDistant(type) ? batchesOnLlvmpipe : 0))
            << type;
        const LightingResult unlisted = draw(host, lights, {.shadowBudget = 4096});
        EXPECT_TRUE(
            agree(traced.radiance, unlisted.radiance, cndIsDistant(type) ? batchesOnLlvmpipe : 0))
            << type;
        EXPECT_EQ(unlisted.stats.unlistedClusters > 0, !cndIsDistant(type)) << type;
        // Frames in which nothing has moved ask again: the module does not know what the rays hit.
        const LightingResult still = draw(host, lights, {.frames = 2, .unchanged = true});
        EXPECT_TRUE(sameBits(still, traced)) << type;
        EXPECT_EQ(still.stats.walkedEntries, traced.stats.shadowSlots) << type;
        RunOptions off;
        off.withFrame = [](CndLightingFrame& frame) { frame.shadowsOff = VK_TRUE; };
        const LightingResult unshadowed = draw(host, lights, off);
        EXPECT_TRUE(agree(draw(own, lights, off).radiance, unshadowed.radiance)) << type;
        EXPECT_GT(differentPixels(traced, unshadowed), 10 * few) << type;
    }
}

TEST_F(VisibilityFromHost, AShadowTermMultipliesWhatRaysSee)
{
    const std::string source = std::string(tracingSource) +
                               "float candelabraVisibility(CndShadowQuery q) { return 0.5; }\n";
    const CompiledKernels kernels =
        compiled({.functions = CND_HOST_VISIBILITY_BIT | CND_HOST_VISIBLE_POINTS_BIT,
                  .source = source.c_str(),
                  .lightTypes = 1u << CND_LIGHT_SPHERE});
    const CndLighting own = create({}), host = create(kernels.hostKernels(set_.layout()));
    addOccluders(own);
    addOccluders(host); // ignored
    const auto lights = someLights(CND_LIGHT_SPHERE);
    LightingResult traced = draw(host, lights);
    for (glm::vec4& pixel : traced.radiance)
        pixel *= 2;
    EXPECT_LE(differentPixels(draw(own, lights), traced), surfaces.depth.size() / 300);
    EXPECT_TRUE(sameBits(draw(host, lights, {.culling = CND_CULLING_BRUTE}), draw(host, lights)));
}

TEST_F(VisibilityFromHost, WhatIsMissingIsNamed)
{
    const CompiledKernels kernels = compiled({.functions = CND_HOST_VISIBLE_POINTS_BIT,
                                              .source = tracingSource,
                                              .lightTypes = 1u << CND_LIGHT_SPHERE});
    const CndHostKernels all = kernels.hostKernels(set_.layout());
    ASSERT_EQ(all.count, 2u);
    const auto refused = [&](const std::vector<CndKernelCode>& codes, uint32_t points,
                             const char* sentence) {
        const CndLightingDesc desc{
            .structSize = sizeof desc,
            .framesInFlight = 1,
            .hostKernels = {uint32_t(codes.size()), codes.data(), set_.layout()},
            .shadows = {.points = points}};
        CndLighting lighting{};
        CndError error{};
        EXPECT_EQ(cndCreateLighting(&deviceDesc(), &desc, &lighting, &error),
                  CND_ERROR_INVALID_ARGUMENT);
        EXPECT_STREQ(error.message, sentence);
    };
    const std::string advice = " is missing: name its light type and method in CndCompileDesc, and "
                               "whether the module has shadows";
    const CndKernelCode unlisted = all.kernels[0], pairs = all.kernels[1];
    refused({pairs}, 64, ("CndHostKernels: kernel shade_unlisted_points:CONIC" + advice).c_str());
    refused({unlisted}, 64, ("CndHostKernels: kernel pair_visibility_points" + advice).c_str());
    // A kernel that walks is not one that calls the host's function.
    CndKernelCode walking = pairs;
    walking.name = "pair_visibility";
    refused({unlisted, walking}, 64,
            ("CndHostKernels: kernel pair_visibility_points" + advice).c_str());
    refused({unlisted, pairs}, 0,
            "CndLightingDesc: hostKernels have CND_HOST_VISIBLE_POINTS_BIT, which needs "
            "shadows.points of 32 or 64");
}

} // namespace candelabra::test
