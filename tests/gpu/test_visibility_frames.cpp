// SPDX-License-Identifier: Apache-2.0
// Frames with shadows: lights of all types, found through lists, without lists and by brute force,
// while lights and occluders change.
#include <algorithm>
#include <iostream>
#include <random>
#include <set>
#include <string>

#include "generate/shapes.h"
#include "gpu/lighting_harness.h"
#include "gpu/random_frame.h"
#include "harness/full_tests.h"
#include "shared/cluster_data.h"

namespace candelabra::test
{
namespace
{

class VisibilityFrames : public LightingTest
{
protected:
    // The lighting that the tests of a process share. Its occluders are those of the present test.
    CndLighting lighting()
    {
        static CndLighting out = VK_NULL_HANDLE;
        if (!out) {
            destroyAfterTests([] { cndDestroyLighting(out); });
            const CndLightingDesc desc{.structSize = sizeof desc,
                                       .framesInFlight = 2,
                                       .specularMethods = 1u << CND_SPECULAR_CONIC,
                                       .shading = CND_SHADING_CLUSTERED_BIT,
                                       .shadows = {.points = 64}};
            CndError error{};
            EXPECT_EQ(cndCreateLighting(&deviceDesc(), &desc, &out, &error), CND_SUCCESS)
                << error.message;
        }
        return out;
    }
    void TearDown() override
    {
        removeOccluders();
        LightingTest::TearDown();
    }
    // Adds a mesh of random triangles of about 1 m, and `count` instances of it near the surfaces.
    void addOccluders(uint32_t count, uint32_t seed, uint32_t layer = 0)
    {
        random_.seed(seed);
        std::vector<float> positions;
        for (int i = 0; i < 3 * 3 * 12; ++i)
            positions.push_back(float(uniform(-0.7, 0.7)));
        addMesh({.positions = positions.data(),
                 .vertexCount = uint32_t(positions.size() / 3),
                 .triangleCount = uint32_t(positions.size() / 9)});
        std::vector<CndOccluderInstance> instances;
        for (uint32_t i = 0; i < count; ++i)
            instances.push_back(someInstance(meshes_.back(), layer));
        addInstances(instances);
    }
    // Adds boxes, which some lights are proven to be behind. The size is that of a side.
    void addBoxes(uint32_t count, double size, uint32_t seed)
    {
        const app::Mesh box = app::makeBox();
        addMesh({.positions = &box.vertices[0].position.x,
                 .stride = sizeof box.vertices[0],
                 .vertexCount = uint32_t(box.vertices.size()),
                 .indices = box.indices.data(),
                 .triangleCount = uint32_t(box.indices.size() / 3)});
        addFlatInstances(count, size, seed);
    }
    // Adds instances of the mesh added last, some of them in layers or with a surface error.
    void addFlatInstances(uint32_t count, double size, uint32_t seed)
    {
        random_.seed(seed);
        std::vector<CndOccluderInstance> instances;
        for (uint32_t i = 0; i < count; ++i) {
            instances.push_back(someInstance(meshes_.back(), i % 3));
            instances.back().surfaceError = i % 4 ? 0 : 0.02f;
            for (int k = 0; k < 12; ++k)
                instances.back().worldFromMesh[k] *= k % 4 == 3 ? 1 : k % 4 == 2 ? 0.2 : size;
        }
        addInstances(instances);
    }
    void addMesh(const CndOccluderMesh& mesh)
    {
        CndError error{};
        EXPECT_EQ(cndAddOccluderMeshes(lighting(), 1, &mesh, &meshes_.emplace_back(), &error),
                  CND_SUCCESS)
            << error.message;
    }
    void addInstances(const std::vector<CndOccluderInstance>& instances)
    {
        const uint32_t count = uint32_t(instances.size());
        CndError error{};
        occluders_.resize(occluders_.size() + count);
        EXPECT_EQ(cndAddOccluders(lighting(), count, instances.data(),
                                  occluders_.data() + occluders_.size() - count, &error),
                  CND_SUCCESS)
            << error.message;
        instances_.insert(instances_.end(), instances.begin(), instances.end());
    }
    // A sheet of 2 m, whose triangles share vertices: its indices, and its positions when it is
    // bent.
    static constexpr uint32_t sheetSide = 20;
    static std::vector<uint32_t> sheetIndices()
    {
        std::vector<uint32_t> out;
        for (uint32_t i = 0; i < sheetSide * (sheetSide + 1); ++i)
            if (i % (sheetSide + 1) < sheetSide)
                for (const uint32_t corner :
                     {i, i + 1, i + sheetSide + 1, i + sheetSide + 1, i + 1, i + sheetSide + 2})
                    out.push_back(corner);
        return out;
    }
    static std::vector<glm::vec3> bentSheet(float bend)
    {
        std::vector<glm::vec3> out;
        for (uint32_t y = 0; y <= sheetSide; ++y)
            for (uint32_t x = 0; x <= sheetSide; ++x) {
                const glm::vec2 p = glm::vec2(x, y) * (2.0f / sheetSide) - 1.0f;
                out.emplace_back(p, bend * std::sin(3 * p.x + bend));
            }
        return out;
    }
    void addSheets(const std::vector<glm::vec3>& positions, uint32_t seed)
    {
        const std::vector<uint32_t> indices = sheetIndices();
        addMesh({.positions = &positions[0].x,
                 .vertexCount = uint32_t(positions.size()),
                 .indices = indices.data(),
                 .triangleCount = uint32_t(indices.size() / 3)});
        random_.seed(seed);
        std::vector<CndOccluderInstance> instances;
        for (int i = 0; i < 12; ++i)
            instances.push_back(someInstance(meshes_.back(), 0));
        addInstances(instances);
    }
    // What the sheets look like when they are added in this pose.
    LightingResult drawAnew(const std::vector<CndLight>& lights,
                            const std::vector<glm::vec3>& positions, uint32_t seed)
    {
        removeOccluders();
        addSheets(positions, seed);
        return draw(lights);
    }
    // Takes the positions of the mesh added last from a buffer of the device.
    void takeFrom(const gpu::Buffer& buffer, VkDeviceSize offset = 0)
    {
        const CndDevicePositions positions{
            .mesh = meshes_.back(), .buffer = buffer.get(), .offset = offset};
        CndError error{};
        EXPECT_EQ(cndReplaceOccluderPositionsOnDevice(lighting(), 1, &positions, &error),
                  CND_SUCCESS)
            << error.message;
    }
    // A buffer of the host with these poses one after the other.
    gpu::Buffer posesOnDevice(const std::vector<std::vector<glm::vec3>>& poses)
    {
        const size_t bytes = poses[0].size() * sizeof(glm::vec3);
        gpu::Buffer out =
            gpu::createBuffer(device(), "poses", poses.size() * bytes,
                              VK_BUFFER_USAGE_STORAGE_BUFFER_BIT, gpu::MemoryUse::Upload);
        for (size_t i = 0; i < poses.size(); ++i)
            std::memcpy(out.mapped + i * bytes, poses[i].data(), bytes);
        return out;
    }
    CndOccluderInstance someInstance(CndOccluderMeshId mesh, uint32_t layer)
    {
        const glm::dvec3 at(uniform(-4, 4), uniform(-3, 3), uniform(-12, -4));
        CndOccluderInstance out{.mesh = mesh, .occluderLayer = layer};
        for (int row = 0; row < 3; ++row) {
            for (int column = 0; column < 3; ++column)
                out.worldFromMesh[4 * row + column] = (row == column) + uniform(-0.3, 0.3);
            out.worldFromMesh[4 * row + 3] = at[row];
        }
        return out;
    }
    void removeOccluders()
    {
        CndError error{};
        EXPECT_EQ(
            cndRemoveOccluders(lighting(), uint32_t(occluders_.size()), occluders_.data(), &error),
            CND_SUCCESS)
            << error.message;
        EXPECT_EQ(
            cndRemoveOccluderMeshes(lighting(), uint32_t(meshes_.size()), meshes_.data(), &error),
            CND_SUCCESS)
            << error.message;
        occluders_.clear();
        meshes_.clear();
        instances_.clear();
    }
    LightingResult draw(const std::vector<CndLight>& lights, RunOptions options = {})
    {
        options.specular = CND_SPECULAR_CONIC;
        options.lighting = lighting();
        return run(surfaces, lights, options);
    }
    double uniform(double low, double high)
    {
        return low + (high - low) * double(random_()) / 4294967296.0;
    }
    static bool runs(const CndLightingStats& stats, const std::string& pass)
    {
        return std::any_of(stats.passes, stats.passes + stats.passCount,
                           [&](const CndPassPlan& p) { return p.name == pass && !p.skipped; });
    }
    static std::vector<CndLight> everyType(const CpuGBuffer& g, uint32_t count)
    {
        std::vector<CndLight> lights;
        for (uint32_t type = 0; type < CND_LIGHT_TYPE_COUNT; ++type)
            for (const CndLight& light : lightsOf(CndLightType(type), g, count, type + 1))
                lights.push_back(light);
        return lights;
    }

    const CpuGBuffer surfaces = randomGBuffer(96, 64, 3);
    std::mt19937 random_;
    std::vector<CndOccluderMeshId> meshes_;
    std::vector<CndOccluderId> occluders_;
    std::vector<CndOccluderInstance> instances_; // as occluders_
};

// Its modules have the kernels of brute force alone, in which no pixel walks through occluders. So
// SwiftShader makes them in seconds.
class VisibilityBits : public LightingTest
{
};

} // namespace

// Where nothing hides a light, a module with shadows gives the bits of one without.
TEST_F(VisibilityBits, LightInFullViewKeepsThem)
{
    const CpuGBuffer g = randomGBuffer(48, 32, 3);
    const Images images = uploadImages(g);
    const RunOptions options{.culling = CND_CULLING_BRUTE};
    const std::vector<CndLight> lights = randomSpheres(g, 40, 5);
    std::vector<glm::vec4> drawn[3];
    for (const bool shadows : {false, true}) {
        const auto own = createLighting(g, {.framesInFlight = 1,
                                            .specularMethods = 1u << options.specular,
                                            .shading = CND_SHADING_BRUTE_BIT,
                                            .shadows = {.points = shadows ? 64u : 0u}});
        setLights(own.lighting, lights);
        if (!shadows) {
            drawn[0] = drawFrame(own.view, frameOf(g, images, options), images);
            continue;
        }
        // The first mesh hides no light, because its only triangle is behind the camera.
        // The second mesh has 17 triangles between the surfaces and the lights. They hide some of
        // the lights.
        std::vector<float> positions = {-9, -9, 5, 9, -9, 5, 0, 9, 5};
        for (float x = -4; x <= 4; x += 0.5f)
            positions.insert(positions.end(), {x, -30, 0, x, 30, 0, x, 0, -40});
        for (int i = 0; i < 2; ++i) {
            const uint32_t count = i ? uint32_t(positions.size() / 9) - 1 : 1;
            const CndOccluderMesh mesh{.positions = &positions[9 * size_t(i)],
                                       .vertexCount = 3 * count,
                                       .triangleCount = count};
            CndOccluderInstance instance{.worldFromMesh = {1, 0, 0, 0, 0, 1, 0, 0, 0, 0, 1, 0}};
            CndOccluderId id = 0;
            CndError error{};
            ASSERT_EQ(cndAddOccluderMeshes(own.lighting, 1, &mesh, &instance.mesh, &error),
                      CND_SUCCESS)
                << error.message;
            ASSERT_EQ(cndAddOccluders(own.lighting, 1, &instance, &id, &error), CND_SUCCESS)
                << error.message;
            drawn[1 + i] = drawFrame(own.view, frameOf(g, images, options), images);
        }
    }
    EXPECT_TRUE(agree(drawn[0], drawn[1]));
    size_t same = 0;
    for (size_t i = 0; i < drawn[0].size(); ++i)
        same += drawn[0][i] == drawn[2][i];
    EXPECT_GT(same, drawn[0].size() / 10);
    EXPECT_LT(same, drawn[0].size() * 9 / 10);
}

// A light of any type is shadowed, and all ways of finding lights give the same image.
TEST_F(VisibilityFrames, ListsTreesAndBruteForceGiveTheSame)
{
    addOccluders(40, 1);
    for (uint32_t type = 0; type < CND_LIGHT_TYPE_COUNT; ++type) {
        const auto lights = lightsOf(CndLightType(type), surfaces, 25, type + 1);
        const LightingResult listed = draw(lights, {.countPairs = true});
        const CndLightingStats& s = listed.stats;
        const bool hasSize = !cndIsPunctual(type);
        EXPECT_GT(s.askedPairs, 1000u) << type;
        EXPECT_GT(s.darkPairs, s.askedPairs / 100) << type;
        EXPECT_EQ(s.partlyLitPairs > 0, hasSize) << type;
        EXPECT_LT(s.darkPairs + s.partlyLitPairs, s.askedPairs) << type;
        EXPECT_EQ(s.missingShadowSlots, 0u) << type;
        EXPECT_EQ(s.unfinishedPairs, 0u) << type;
        EXPECT_EQ(s.unlistedClusters, 0u) << type;
        EXPECT_EQ(s.testedEntries + s.walkedEntries, s.shadowSlots) << type;
        const uint32_t noSlot = s.litEntries + s.hiddenEntries;
        EXPECT_EQ(noSlot + s.shadowSlots, cndIsDistant(type) ? 0u : s.listEntries) << type;
        EXPECT_EQ(s.testedEntries > 0, !cndIsDistant(type)) << type;
        const LightingResult unlisted = draw(lights, {.shadowBudget = 4096});
        if (!cndIsDistant(type)) {
            EXPECT_GT(unlisted.stats.unlistedClusters, 0u) << type;
            EXPECT_GT(unlisted.stats.missingShadowSlots, 0u) << type;
            EXPECT_LE(unlisted.stats.shadowSlots, 16u) << type;
        }
        EXPECT_TRUE(
            agree(listed.radiance, unlisted.radiance, cndIsDistant(type) ? batchesOnLlvmpipe : 0))
            << type;
        const LightingResult brute = draw(lights, {.culling = CND_CULLING_BRUTE});
        EXPECT_TRUE(agree(listed.radiance, brute.radiance, batchesOnLlvmpipe)) << type;
        EXPECT_EQ(unlisted.stats.unfinishedPairs, 0u) << type;
        // Some clusters find slots, and some do not. The budget ends within a group.
        const uint32_t half = s.shadowSlots / 2 + 1;
        const LightingResult some = draw(lights, {.shadowBudget = half * VkDeviceSize(256)});
        if (!cndIsDistant(type)) {
            EXPECT_GT(some.stats.missingShadowSlots, 0u) << type;
            EXPECT_EQ(some.stats.shadowSlots, half) << type;
            EXPECT_GT(some.stats.unlistedClusters, 0u) << type;
        }
        EXPECT_TRUE(
            agree(listed.radiance, some.radiance, cndIsDistant(type) ? batchesOnLlvmpipe : 0))
            << type;
        RunOptions off;
        off.withFrame = [](CndLightingFrame& frame) { frame.shadowsOff = VK_TRUE; };
        EXPECT_GT(maxRelativeDifference(draw(lights, off).radiance, listed.radiance), 1e-3) << type;
    }
}

// Lists leave out no triangle, however instances are stretched, large, thin or far from the origin
// of their mesh.
TEST_F(VisibilityFrames, ListsKeepTheBitsOfOddOccluders)
{
    // The ground, slivers of 10 m, and triangles of 0.5 m.
    std::vector<float> ground = {-1e4f, 0, -1e4f, 1e4f, 0, -1e4f, 0, 0, 2e4f}, slivers, small;
    random_.seed(4);
    for (int i = 0; i < 20; ++i) {
        const auto add = [](std::vector<float>& to, double x, double y, double z) {
            for (const double at : {x, y, z})
                to.push_back(float(at));
        };
        const double x = uniform(-3, 3), y = uniform(-2, 2);
        add(slivers, x, y, -10);
        add(slivers, x + 1e-3, y, -10);
        add(slivers, x + uniform(-1, 1), y + uniform(-1, 1), 0);
        for (int corner = 0; corner < 3; ++corner) // the origin of this mesh is 2 km away
            add(small, 2000 + uniform(-3, 3), uniform(-2, 2), uniform(-11, -5));
    }
    const double rows[][12] = {{1, 0, 0, 0, 0, 1, 0, -3, 0, 0, 1, 0}, // below all
                               {-1, 0, 0, 0, 0, 1, 0, 0, 0, 0, 1, 0}, // a mirror
                               {0.6, 0, 0.8, -1194, 0, 1, 0, 0, -0.8, 0, 0.6, 1596},
                               {100, 0, 0, -200000, 0, 0.01, 0, 1, 0, 0, 1, 0}};
    const std::vector<float>* positions[] = {&ground, &slivers, &small, &small};
    for (size_t i = 0; i < std::size(rows); ++i) {
        const CndOccluderMesh mesh{.positions = positions[i]->data(),
                                   .vertexCount = uint32_t(positions[i]->size() / 3),
                                   .triangleCount = uint32_t(positions[i]->size() / 9)};
        CndOccluderInstance instance{};
        std::ranges::copy(rows[i], instance.worldFromMesh);
        CndError error{};
        ASSERT_EQ(cndAddOccluderMeshes(lighting(), 1, &mesh, &meshes_.emplace_back(), &error),
                  CND_SUCCESS)
            << error.message;
        instance.mesh = meshes_.back();
        ASSERT_EQ(cndAddOccluders(lighting(), 1, &instance, &occluders_.emplace_back(), &error),
                  CND_SUCCESS)
            << error.message;
    }
    for (const CndLightType type :
         {CND_LIGHT_SPHERE, CND_LIGHT_TUBE, CND_LIGHT_RECTANGLE, CND_LIGHT_POLYGON}) {
        const auto lights = lightsOf(type, surfaces, 25, type + 1);
        const LightingResult listed = draw(lights, {.countPairs = true});
        const LightingResult walked = draw(lights, {.shadowBudget = 4096});
        EXPECT_GT(listed.stats.testedEntries, 50u) << type;
        EXPECT_GT(listed.stats.partlyLitPairs, 500u) << type;
        EXPECT_TRUE(agree(listed.radiance, walked.radiance)) << type;
    }
}

// Any camera, size and depth convention, lights of all types, and occluders of any shape and size.
// Five scenes by default, 1,000 with tools/test --full.
TEST_F(VisibilityFrames, RandomScenesEqualBruteForce)
{
    const uint32_t scenes = fullTests() ? 1000 : 5;
    uint64_t won = 0, hidden = 0, tested = 0, walked = 0, partlyLit = 0;
    for (uint32_t seed = 0; seed < scenes; ++seed) {
        RandomFrame frame(seed);
        const CpuGBuffer g = frame.gbuffer();
        std::vector<CndLight> lights = frame.lights(g);
        lights.resize(std::min<size_t>(lights.size(), 30));
        const std::vector<CndLight> others = everyType(g, 2);
        lights.insert(lights.end(), others.begin(), others.end());
        removeOccluders();
        addOccluders(seed % 50, seed);
        addBoxes(seed % 30, seed % 2 ? 0.5 + seed % 7 : 10, seed);
        addSheets(bentSheet(float(seed % 5) * 0.2f), seed);
        RunOptions options{.specular = CND_SPECULAR_CONIC, .countPairs = true};
        options.lighting = lighting();
        const LightingResult listed = run(g, lights, options);
        won += listed.stats.wonProofs;
        hidden += listed.stats.hiddenEntries;
        tested += listed.stats.testedEntries;
        walked += listed.stats.walkedEntries;
        partlyLit += listed.stats.partlyLitPairs;
        options.culling = CND_CULLING_BRUTE;
        const LightingResult brute = run(g, lights, options);
        EXPECT_TRUE(agree(listed.radiance, brute.radiance, batchesOnLlvmpipe))
            << "seed " << seed << ", " << g.width << "x" << g.height;
        EXPECT_EQ(listed.stats.unfinishedPairs + brute.stats.unfinishedPairs, 0u) << seed;
    }
    std::cout << won << " proofs won; of the lights in lists " << hidden << " are hidden, "
              << tested << " tested and " << walked << " walked for; " << partlyLit
              << " pixels see part of a light\n";
    for (const uint64_t count : {won, hidden, tested, walked, partlyLit})
        EXPECT_GT(count, scenes);
}

// Lights that boxes are proven to hide are in no list, and no pixel changes: brute force has no
// lists.
TEST_F(VisibilityFrames, ProofsChangeNoPixel)
{
    // A polygon light with this outline emits only far from its centre.
    const CndPolygon aside{4, {{0.8f, 0.8f}, {1, 0.8f}, {1, 1}, {0.8f, 1}}};
    uint64_t won = 0, tried = 0, hidden = 0;
    for (uint32_t type = 0; type < CND_LIGHT_TYPE_COUNT; ++type) {
        if (cndIsDistant(type))
            continue;
        for (uint32_t seed = 0; seed < (fullTests() ? 40u : 2u); ++seed) {
            removeOccluders();
            addBoxes(30, seed % 2 ? 3 : 12, seed);
            auto lights = lightsOf(CndLightType(type), surfaces, 60, type + seed);
            for (size_t i = 0; i < lights.size(); ++i) {
                lights[i].influenceRadius *= 4;
                lights[i].unshadowed = i % 16 == 0;
                lights[i].unshadowedBy = i % 4 == 0 ? 2 : 0;
                if (type == CND_LIGHT_POLYGON && i % 3 == 0)
                    lights[i].polygon = &aside;
            }
            const LightingResult listed = draw(lights);
            EXPECT_LE(listed.stats.wonProofs, listed.stats.triedProofs);
            EXPECT_GT(listed.stats.wonProofs, 0u) << type << ", " << seed;
            won += listed.stats.wonProofs;
            tried += listed.stats.triedProofs;
            hidden += listed.stats.hiddenEntries;
            const LightingResult brute = draw(lights, {.culling = CND_CULLING_BRUTE});
            EXPECT_TRUE(agree(listed.radiance, brute.radiance, batchesOnLlvmpipe))
                << type << ", " << seed;
        }
    }
    std::cout << won << " of " << tried << " proofs won; " << hidden << " lights hidden in lists\n";
    EXPECT_GT(hidden, 1000u);
}

// Lists that lack lights are made anew when the occluders move that hid them.
TEST_F(VisibilityFrames, ProofsHoldForTheirOccluders)
{
    const auto lights = lightsOf(CND_LIGHT_SPHERE, surfaces, 60, 1);
    addBoxes(30, 12, 1);
    const auto moved = [&] {
        for (CndOccluderInstance& instance : instances_)
            instance.worldFromMesh[11] += 5;
        CndError error{};
        EXPECT_EQ(cndUpdateOccluders(lighting(), uint32_t(occluders_.size()), occluders_.data(),
                                     instances_.data(), &error),
                  CND_SUCCESS)
            << error.message;
    };
    int drawn = 0;
    RunOptions options{.frames = 2, .unchanged = true};
    options.beforeFrame = [&] {
        if (++drawn == 2)
            moved();
    };
    const LightingResult kept = draw(lights, options);
    EXPECT_TRUE(sameBits(kept, draw(lights)));
}

// A frame without shadows has the bits that a module without shadows gives it, and so does every
// pixel that sees all of its lights.
TEST_F(VisibilityFrames, WhatNothingHidesHasTheSameBits)
{
    const auto lights = everyType(surfaces, 8);
    const LightingResult without =
        run(surfaces, lights, {.specular = CND_SPECULAR_CONIC, .ownLighting = true});
    EXPECT_TRUE(agree(without.radiance, draw(lights).radiance)); // no occluder
    addOccluders(12, 2);
    RunOptions off;
    off.withFrame = [](CndLightingFrame& frame) { frame.shadowsOff = VK_TRUE; };
    EXPECT_TRUE(agree(without.radiance, draw(lights, off).radiance));
    off.withFrame = [](CndLightingFrame& frame) { frame.shadowsOff = VK_FALSE; };
    RunOptions counted{.countPairs = true};
    const Images shadows = uploadImages(surfaces);
    context().submitAndWait([&](VkCommandBuffer cmd) { clearRadiance(cmd, shadows); });
    counted.withFrame = [&](CndLightingFrame& frame) {
        frame.shadowImage = shadows.radiance.view.get();
    };
    LightingResult shadowed = draw(lights, counted);
    const std::vector<glm::vec4> counts = readRadiance(shadows);
    glm::dvec3 sum(0);
    size_t lit = 0, hidden = 0;
    for (size_t i = 0; i < counts.size(); ++i) {
        sum += glm::dvec3(counts[i]);
        const bool isLit = counts[i].y == 0 && counts[i].z == 0;
        ++(isLit ? lit : hidden);
        if (!isLit)
            shadowed.radiance[i] = without.radiance[i];
    }
    EXPECT_GT(lit, counts.size() / 20);
    EXPECT_GT(hidden, counts.size() / 20);
    EXPECT_TRUE(agree(without.radiance, shadowed.radiance));
    EXPECT_EQ(uint64_t(sum.x), shadowed.stats.askedPairs);
    EXPECT_EQ(uint64_t(sum.y), shadowed.stats.partlyLitPairs);
    EXPECT_EQ(uint64_t(sum.z), shadowed.stats.darkPairs);
}

// Each light of a list that several groups share keeps its slot.
TEST_F(VisibilityFrames, SharedListsHaveTheirShadows)
{
    size_t pixel = surfaces.depth.size() / 2 + surfaces.width / 2;
    while (surfaces.depth[pixel] == surfaces.clearDepth)
        ++pixel;
    const glm::dvec3 p =
        viewPosition(surfaces, uint32_t(pixel % surfaces.width), uint32_t(pixel / surfaces.width)) +
        0.2 * storedNormal(surfaces, pixel);
    std::vector<CndLight> lights = randomSpheres(surfaces, gpu::SHARED_FROM + 200, 3);
    for (CndLight& light : lights) {
        for (int k = 0; k < 3; ++k)
            light.position[k] = float(p[k] + uniform(-0.1, 0.1));
        light.radius = 0.02f;
        light.influenceRadius = 0.5f;
    }
    addOccluders(3, 2);
    CndOccluderInstance near = someInstance(meshes_.back(), 0);
    for (int k = 0; k < 12; ++k)
        near.worldFromMesh[k] = k % 4 == 3 ? float(p[k / 4]) : 0.2f * near.worldFromMesh[k];
    addInstances({near});
    const LightingResult shared = draw(lights);
    EXPECT_GT(shared.stats.maxListLength, gpu::SHARED_FROM);
    EXPECT_EQ(shared.stats.unlistedClusters, 0u);
    const LightingResult walked = draw(lights, {.listBudget = 4096});
    EXPECT_GT(walked.stats.unlistedClusters, 0u);
    EXPECT_TRUE(agree(shared.radiance, walked.radiance, batchesOnLlvmpipe));
    EXPECT_TRUE(sameBits(draw(lights, {.frames = 3, .unchanged = true}), shared));
    RunOptions off;
    off.withFrame = [](CndLightingFrame& frame) { frame.shadowsOff = VK_TRUE; };
    EXPECT_FALSE(sameBits(draw(lights, off), shared));
}

TEST_F(VisibilityFrames, LightsIgnoreTheOccludersThatTheyName)
{
    auto lights = everyType(surfaces, 6);
    addOccluders(20, 3, 2);
    const LightingResult ofLayer2 = draw(lights);
    addOccluders(20, 4, 5);
    const LightingResult ofBoth = draw(lights);
    RunOptions off;
    off.withFrame = [](CndLightingFrame& frame) { frame.shadowsOff = VK_TRUE; };
    const LightingResult none = draw(lights, off);
    EXPECT_FALSE(sameBits(ofLayer2, ofBoth));
    const auto withAll = [&](VkBool32 unshadowed, uint32_t by) {
        for (CndLight& light : lights) {
            light.unshadowed = unshadowed;
            light.unshadowedBy = by;
        }
        return draw(lights);
    };
    EXPECT_TRUE(sameBits(withAll(VK_TRUE, 0), none));
    EXPECT_TRUE(sameBits(withAll(VK_FALSE, 1u << 2 | 1u << 5), none));
    EXPECT_TRUE(sameBits(withAll(VK_FALSE, 1u << 5), ofLayer2));
    EXPECT_TRUE(sameBits(withAll(VK_FALSE, 1u << 3), ofBoth));
}

// Occluders of other layers than the frame's hide nothing.
TEST_F(VisibilityFrames, OccludersAreInLayers)
{
    const auto lights = everyType(surfaces, 5);
    addOccluders(20, 6);
    const LightingResult all = draw(lights);
    for (CndOccluderInstance& instance : instances_)
        instance.layers = 2;
    CndError error{};
    EXPECT_EQ(cndUpdateOccluders(lighting(), uint32_t(occluders_.size()), occluders_.data(),
                                 instances_.data(), &error),
              CND_SUCCESS)
        << error.message;
    RunOptions off;
    off.withFrame = [](CndLightingFrame& frame) { frame.shadowsOff = VK_TRUE; };
    EXPECT_FALSE(sameBits(draw(lights, off), all));
    EXPECT_TRUE(sameBits(draw(lights), all));
    EXPECT_TRUE(sameBits(draw(lights, {.layers = 2}), all));
    EXPECT_TRUE(sameBits(draw(lights, {.layers = 1}), draw(lights, off)));
}

// After many edits the image is that of a new set, however the tree has come about.
TEST_F(VisibilityFrames, EditsGiveTheImageOfANewSet)
{
    const auto lights = everyType(surfaces, 5);
    addOccluders(40, 5);
    CndError error{};
    for (int i = 0; i < 1000; ++i) {
        const size_t k = random_() % occluders_.size();
        instances_[k] = someInstance(meshes_.back(), 0);
        if (i % 4) {
            EXPECT_EQ(cndUpdateOccluders(lighting(), 1, &occluders_[k], &instances_[k], &error),
                      CND_SUCCESS)
                << error.message;
        } else {
            EXPECT_EQ(cndRemoveOccluders(lighting(), 1, &occluders_[k], &error), CND_SUCCESS)
                << error.message;
            EXPECT_EQ(cndAddOccluders(lighting(), 1, &instances_[k], &occluders_[k], &error),
                      CND_SUCCESS)
                << error.message;
        }
        if (i % 200 == 0)
            draw(lights);
    }
    const LightingResult edited = draw(lights);
    RunOptions off;
    off.withFrame = [](CndLightingFrame& frame) { frame.shadowsOff = VK_TRUE; };
    EXPECT_FALSE(sameBits(edited, draw(lights, off)));
    EXPECT_EQ(
        cndRemoveOccluders(lighting(), uint32_t(occluders_.size()), occluders_.data(), &error),
        CND_SUCCESS)
        << error.message;
    EXPECT_EQ(cndAddOccluders(lighting(), uint32_t(occluders_.size()), instances_.data(),
                              occluders_.data(), &error),
              CND_SUCCESS)
        << error.message;
    EXPECT_TRUE(sameBits(draw(lights), edited));
}

TEST_F(VisibilityFrames, TenRunsHaveTheSameBits)
{
    const auto lights = everyType(surfaces, 3);
    addOccluders(30, 7);
    const LightingResult first = draw(lights);
    RunOptions off;
    off.withFrame = [](CndLightingFrame& frame) { frame.shadowsOff = VK_TRUE; };
    EXPECT_FALSE(sameBits(first, draw(lights, off)));
    for (int i = 1; i < 10; ++i)
        EXPECT_TRUE(sameBits(draw(lights, {.frames = 1 + i % 3, .unchanged = i % 2 == 0}), first));
}

// A pose on the device gives the picture of a mesh that is added in this pose, also with lists that
// an earlier pose made, and however far it is from the pose that the tree was built for.
TEST_F(VisibilityFrames, PosesOnTheDeviceGiveTheShadowsOfANewMesh)
{
    const auto lights = lightsOf(CND_LIGHT_SPHERE, surfaces, 25, 1);
    std::vector<glm::vec3> far = bentSheet(0.3f), point = far, line = far;
    for (size_t i = 0; i < far.size(); ++i) {
        far[i].x += 500;
        point[i] = {0, 1, 0};
        line[i].y = line[i].z = 0;
    }
    const std::vector<std::vector<glm::vec3>> poses = {bentSheet(0.6f), point, line, bentSheet(0)};
    const gpu::Buffer buffer = posesOnDevice(poses);
    std::vector<LightingResult> expected;
    for (const auto& pose : poses)
        expected.push_back(drawAnew(lights, pose, 9));
    EXPECT_FALSE(sameBits(expected[0], expected[3]));
    EXPECT_TRUE(sameBits(expected[1], expected[2])) << "without an area nothing casts a shadow";
    removeOccluders();
    addOccluders(1, 1); // another mesh
    addSheets(far, 9);
    const CndOccluderId other = occluders_[0];
    EXPECT_EQ(cndRemoveOccluders(lighting(), 1, &other, nullptr), CND_SUCCESS);
    occluders_.erase(occluders_.begin());
    for (size_t i = 0; i < poses.size(); ++i) {
        takeFrom(buffer, i * poses[0].size() * sizeof(glm::vec3));
        EXPECT_TRUE(sameBits(draw(lights), expected[i])) << i;
    }
    int drawn = 0;
    RunOptions kept{.frames = 2, .unchanged = true};
    kept.beforeFrame = [&] {
        if (++drawn == 2)
            takeFrom(buffer);
    };
    EXPECT_TRUE(sameBits(draw(lights, kept), expected[0]));
}

// A closed mesh of shared vertices, whose positions are on the device, hides lights from whole
// clusters. No pixel changes by that.
TEST_F(VisibilityFrames, BoxesOnTheDeviceProveDarkness)
{
    std::vector<glm::vec3> corners;
    for (int i = 0; i < 8; ++i)
        corners.emplace_back(i & 1 ? 0.5 : -0.5, i & 2 ? 0.5 : -0.5, i & 4 ? 0.5 : -0.5);
    const uint32_t indices[] = {0, 1, 2, 2, 1, 3, 4, 6, 5, 5, 6, 7, 0, 4, 1, 1, 4, 5,
                                2, 3, 6, 6, 3, 7, 0, 2, 4, 4, 2, 6, 1, 5, 3, 3, 5, 7};
    std::vector<glm::vec3> small = corners;
    for (glm::vec3& corner : small)
        corner *= 0.01f;
    addMesh({.positions = &small[0].x, .vertexCount = 8, .indices = indices, .triangleCount = 12});
    addFlatInstances(30, 12, 1);
    auto lights = lightsOf(CND_LIGHT_SPHERE, surfaces, 60, 1);
    for (CndLight& light : lights)
        light.influenceRadius *= 4;
    const gpu::Buffer buffer = posesOnDevice({corners});
    takeFrom(buffer);
    const LightingResult listed = draw(lights);
    EXPECT_GT(listed.stats.wonProofs, 0u);
    const LightingResult brute = draw(lights, {.culling = CND_CULLING_BRUTE});
    EXPECT_TRUE(agree(listed.radiance, brute.radiance, batchesOnLlvmpipe));
}

// Each of two frames in flight has the pose that it was recorded with.
TEST_F(VisibilityFrames, FramesInFlightKeepTheirPoses)
{
    const auto lights = lightsOf(CND_LIGHT_SPHERE, surfaces, 25, 1);
    const std::vector<std::vector<glm::vec3>> poses = {bentSheet(0.7f), bentSheet(-0.4f)};
    const gpu::Buffer buffer = posesOnDevice(poses);
    const LightingResult expected[] = {drawAnew(lights, poses[0], 10),
                                       drawAnew(lights, poses[1], 10)};
    const CndLightingViewDesc desc{
        .structSize = sizeof desc, .maxWidth = surfaces.width, .maxHeight = surfaces.height};
    CndLightingView view = nullptr;
    ASSERT_EQ(cndCreateLightingView(lighting(), &desc, &view, nullptr), CND_SUCCESS);
    const Images images[] = {uploadImages(surfaces), uploadImages(surfaces)};
    context().submitAndWait([&](VkCommandBuffer cmd) {
        for (uint32_t slot = 0; slot < 2; ++slot) {
            clearRadiance(cmd, images[slot]);
            takeFrom(buffer, slot * poses[0].size() * sizeof(glm::vec3));
            CndLightingFrame frame =
                frameOf(surfaces, images[slot], {.specular = CND_SPECULAR_CONIC});
            frame.frameSlot = slot;
            EXPECT_EQ(cndRecordLighting(view, cmd, &frame, nullptr), CND_SUCCESS);
        }
    });
    for (uint32_t slot = 0; slot < 2; ++slot)
        EXPECT_TRUE(sameBits(readRadiance(images[slot]), expected[slot].radiance)) << slot;
    cndDestroyLightingView(view);
}

// Lists that were made without shadows are not kept for a frame with shadows.
TEST_F(VisibilityFrames, ShadowsMayComeWhileNothingMoves)
{
    const auto lights = everyType(surfaces, 5);
    addOccluders(30, 8);
    const LightingResult shadowed = draw(lights);
    int drawn = 0;
    RunOptions options{.frames = 3, .unchanged = true};
    options.withFrame = [](CndLightingFrame& f) { f.shadowsOff = VK_TRUE; };
    options.beforeFrame = [&] { ++drawn; };
    EXPECT_FALSE(sameBits(draw(lights, options), shadowed));
    options.changeFrame = [&](CndLightingFrame& f) { f.shadowsOff = drawn % 3 == 1; };
    EXPECT_TRUE(sameBits(draw(lights, options), shadowed));
}

// A frame in which nothing has moved keeps what its pixels see of lights, and has the bits of one
// that asks.
TEST_F(VisibilityFrames, StillFramesAskNothing)
{
    std::vector<CndLight> lights;
    for (uint32_t type = 0; type < CND_LIGHT_TYPE_COUNT; ++type)
        for (const CndLight& light : lightsOf(CndLightType(type), surfaces,
                                              cndIsDistant(CndLightType(type)) ? 1 : 8, type + 1))
            lights.push_back(light);
    addBoxes(20, 3, 9);
    RunOptions still{.countPairs = true, .frames = 3, .unchanged = true};
    still.beforeFrame = [&] { // a mesh without instances moves nothing
        const float triangle[9] = {0, 0, 0, 1, 0, 0, 0, 1, 0};
        addMesh({.positions = triangle, .vertexCount = 3, .triangleCount = 1});
    };
    // Two distant lights have room in a view twice as wide. With the small budget some lists find
    // no slots.
    const std::pair<VkDeviceSize, bool> cases[] = {{0, true}, {0, false}, {300 * 256, true}};
    for (const auto& [budget, fits] : cases) {
        const uint32_t width = surfaces.width * (fits ? 2 : 1);
        still.maxWidth = width;
        still.shadowBudget = budget;
        const LightingResult asking =
            draw(lights, {.shadowBudget = budget, .maxWidth = width, .countPairs = true});
        const LightingResult kept = draw(lights, still);
        EXPECT_TRUE(agree(asking.radiance, kept.radiance));
        const CndLightingStats &a = asking.stats, &k = kept.stats;
        for (const char* pass : {"ask_pairs", "list_occluders", "pair_visibility"}) {
            EXPECT_TRUE(runs(a, pass)) << pass;
            EXPECT_EQ(runs(k, pass), !fits) << pass;
        }
        for (const char* pass : {"prepare_occluders", "polygon_facets", "prove_dark"})
            EXPECT_FALSE(runs(k, pass)) << pass;
        EXPECT_GT(a.testedEntries + a.walkedEntries, 200u);
        EXPECT_EQ(k.testedEntries + k.walkedEntries > 0, !fits);
        EXPECT_EQ(a.unlistedClusters > 0, budget > 0);
        EXPECT_EQ(k.missingShadowSlots > 0, budget > 0);
        if (budget)
            continue; // the schedule decides which lists find slots
        EXPECT_TRUE(sameBits(asking, kept));
        EXPECT_EQ(a.shadowSlots, k.shadowSlots);
        EXPECT_EQ(a.askedPairs, k.askedPairs);
        EXPECT_EQ(a.partlyLitPairs, k.partlyLitPairs);
        EXPECT_EQ(a.darkPairs, k.darkPairs);
        EXPECT_EQ(a.wonProofs, k.wonProofs);
    }
}

// What moves is asked for again, and kept from then on.
TEST_F(VisibilityFrames, WhatMovesIsAskedForAgain)
{
    auto lights = everyType(surfaces, 4);
    addBoxes(20, 3, 10);
    const LightingResult before = draw(lights);
    int drawn = 0;
    const auto moveOccluder = [&] {
        instances_[0].worldFromMesh[3] += 1;
        CndError error{};
        EXPECT_EQ(cndUpdateOccluders(lighting(), 1, occluders_.data(), instances_.data(), &error),
                  CND_SUCCESS)
            << error.message;
    };
    const auto moveLight = [&] {
        lights[6].position[0] += 0.5f;
        setLights(lighting(), lights);
    };
    const std::function<void()> moves[] = {moveOccluder, moveLight, [] {}};
    for (const std::function<void()>& move : moves)
        for (const int frames : {3, 4}) { // the third one moves
            const bool movesCamera = &move == &moves[2];
            drawn = 0;
            RunOptions options{.maxWidth = 8 * surfaces.width, .frames = frames};
            options.unchanged = true;
            options.beforeFrame = [&] {
                if (++drawn == 3)
                    move();
            };
            options.changeFrame = [&](CndLightingFrame& frame) {
                if (movesCamera && drawn == 3) {
                    frame.surfacesUnchanged = VK_FALSE;
                    frame.camera.viewFromWorld[12] += 0.3;
                }
            };
            const LightingResult result = draw(lights, options);
            EXPECT_EQ(runs(result.stats, "pair_visibility"), frames == 3);
            RunOptions fresh;
            fresh.withFrame = [&](CndLightingFrame& frame) {
                frame.camera.viewFromWorld[12] += movesCamera ? 0.3 : 0;
            };
            EXPECT_TRUE(sameBits(result, draw(lights, fresh)));
            EXPECT_FALSE(sameBits(result, before));
        }
}

// A module without shadows has none of their passes.
TEST_F(VisibilityFrames, PassesOfShadowsBelongToModulesWithShadows)
{
    const auto lights = everyType(surfaces, 2);
    const auto passes = [](const LightingResult& result) {
        std::set<std::string> names;
        for (uint32_t i = 0; i < result.stats.passCount; ++i)
            names.insert(result.stats.passes[i].name);
        return names;
    };
    const std::set<std::string> without =
        passes(run(surfaces, lights, {.specular = CND_SPECULAR_CONIC}));
    std::set<std::string> with = passes(draw(lights));
    EXPECT_EQ(without.size(), 16u);
    for (const char* name : {"refit_occluders", "prepare_occluders", "polygon_facets", "prove_dark",
                             "ask_pairs", "list_occluders", "pair_visibility", "count_shadows"})
        EXPECT_EQ(with.erase(name), 1u) << name;
    EXPECT_EQ(with, without);
}

} // namespace candelabra::test
