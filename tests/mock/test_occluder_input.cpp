// SPDX-License-Identifier: Apache-2.0
// Wrong descriptions of shadows, and wrong meshes and instances of occluders, are refused with one
// sentence that names the offending element, and everything stays as it was.
#include <limits>
#include <set>

#include <gtest/gtest.h>

#include "candelabra/candelabra.hpp"
#include "candelabra_shaders.h"
#include "gpu/spirv.h"
#include "mock/mock_vulkan.h"
#include "shared/occluder_data.h"

namespace candelabra::test
{
namespace
{

constexpr float notANumber = std::numeric_limits<float>::quiet_NaN();
constexpr float oneTriangle[] = {0, 0, 0, 1, 0, 0, 0, 1, 0};

class OccluderInput : public ::testing::Test
{
protected:
    void SetUp() override { create({.points = 64}); }
    void TearDown() override
    {
        for (const std::string& what : vulkan_.misuse)
            ADD_FAILURE() << what;
    }
    // Creates a module, a view, and one instance of one mesh.
    void create(const CndShadowDesc& shadows)
    {
        view_ = {};
        lighting_ = {};
        auto made = Lighting::create(vulkan_.desc(), {.framesInFlight = 1, .shadows = shadows});
        ASSERT_TRUE(made) << made.error().message;
        lighting_ = std::move(made.value());
        auto view = lighting_.createView(
            {.maxWidth = 64, .maxHeight = 48, .listBudget = 1 << 16, .shadowBudget = 1 << 16});
        ASSERT_TRUE(view) << view.error().message;
        view_ = std::move(view.value());
        auto mesh = lighting_.addOccluderMesh(mesh_);
        ASSERT_TRUE(mesh) << mesh.error().message;
        instance_ = {.mesh = mesh.value()};
        for (int i = 0; i < 3; ++i)
            instance_.worldFromMesh[5 * i] = 1;
        auto occluder = lighting_.addOccluder(instance_);
        ASSERT_TRUE(occluder) << occluder.error().message;
        id_ = occluder.value();
    }

    static void expectSentence(const CndError& error, const std::string& sentence,
                               CndResult code = CND_ERROR_INVALID_ARGUMENT)
    {
        EXPECT_EQ(error.message, sentence);
        EXPECT_EQ(error.code, code);
    }
    void record()
    {
        CndLightingFrame frame{.width = 64, .height = 48, .camera = MockVulkan::camera()};
        frame.normalRoughness = frame.albedo = frame.specular = frame.depth = frame.radiance =
            MockVulkan::imageView();
        const auto recorded = view_.record(MockVulkan::commandBuffer(), frame);
        ASSERT_TRUE(recorded) << recorded.error().message;
        vulkan_.finish(vulkan_.submit());
    }
    // Expects that the one instance is still the only one, and that a frame can be recorded.
    void expectUnchanged()
    {
        expectSentence(lighting_.removeOccluderMeshes({&instance_.mesh, 1}).error(),
                       "cndRemoveOccluderMeshes: ids[0] is " + std::to_string(instance_.mesh) +
                           ", a mesh that has 1 occluder");
        record();
    }
    void refused(const Result<void>& result, const std::string& sentence,
                 CndResult code = CND_ERROR_INVALID_ARGUMENT)
    {
        expectSentence(result.error(), sentence, code);
        expectUnchanged();
    }
    // Adds a correct mesh and this one, which is refused.
    void refusedMesh(const CndOccluderMesh& mesh, const std::string& why)
    {
        const CndOccluderMesh meshes[] = {mesh_, mesh};
        CndOccluderMeshId ids[2] = {7, 7};
        refused(lighting_.addOccluderMeshes(meshes, ids),
                "cndAddOccluderMeshes: meshes[1]: " + why);
        EXPECT_TRUE(ids[0] == 7 && ids[1] == 7);
    }
    void refusedInstance(const CndOccluderInstance& instance, const std::string& why)
    {
        const CndOccluderInstance instances[] = {instance_, instance};
        CndOccluderId ids[2] = {7, 7};
        const bool isMesh = why.starts_with(".mesh");
        refused(lighting_.addOccluders(instances, ids),
                "cndAddOccluders: instances[1]" + (isMesh ? why : ": " + why));
        EXPECT_TRUE(ids[0] == 7 && ids[1] == 7);
        refused(lighting_.updateOccluders({&id_, 1}, {&instance, 1}),
                "cndUpdateOccluders: instances[0]" +
                    (isMesh ? why : " (id " + std::to_string(id_) + "): " + why));
    }

    MockVulkan vulkan_;
    Lighting lighting_;
    LightingView view_;
    const CndOccluderMesh mesh_{.positions = oneTriangle, .vertexCount = 3, .triangleCount = 1};
    CndOccluderInstance instance_{};
    CndOccluderId id_ = 0;
};

} // namespace

TEST_F(OccluderInput, MeshesAreChecked)
{
    CndOccluderMesh mesh = mesh_;
    mesh.positions = nullptr;
    refusedMesh(mesh, "positions is null");
    mesh = mesh_;
    for (const uint32_t stride : {8u, 13u}) {
        mesh.stride = stride;
        refusedMesh(mesh, "stride is " + std::to_string(stride) +
                              ", must be 0 or a multiple of 4 that is at least 12");
    }
    mesh = mesh_;
    mesh.triangleCount = 0;
    refusedMesh(mesh, "triangleCount is 0, must be 1..2^28");
    mesh.triangleCount = (1u << 28) + 1;
    refusedMesh(mesh, "triangleCount is 268435457, must be 1..2^28");
    mesh.triangleCount = 2;
    refusedMesh(mesh, "vertexCount is 3, must be 3 triangleCount = 6 without indices");
    const uint32_t indices[] = {0, 1, 3};
    mesh.triangleCount = 1;
    mesh.indices = indices;
    refusedMesh(mesh, "indices[2] is 3, must be below vertexCount, 3");
    const float broken[] = {0, 0, 0, 1, notANumber, 0, 0, 1, 0},
                far[] = {0, 0, 0, 1, 0, 0, 0, 1, 2e15f};
    mesh = mesh_;
    mesh.positions = broken;
    refusedMesh(mesh, "positions[1][1] is nan, must be finite and within 1e15");
    mesh.positions = far;
    refusedMesh(mesh, "positions[2][2] is 1999999973982208.000000, must be finite and within 1e15");
    const std::string replace = "cndReplaceOccluderPositions: ";
    refused(lighting_.replaceOccluderPositions(instance_.mesh, broken),
            replace + "positions[1][1] is nan, must be finite and within 1e15");
    refused(lighting_.replaceOccluderPositions(7, oneTriangle),
            replace + "mesh is 7, the id of no occluder mesh");
    refused(lighting_.replaceOccluderPositions(instance_.mesh, oneTriangle, 4),
            replace + "stride is 4, must be 0 or a multiple of 4 that is at least 12");
}

TEST_F(OccluderInput, PositionsOnTheDeviceAreChecked)
{
    const CndDevicePositions right{.mesh = instance_.mesh, .buffer = MockVulkan::hostBuffer()};
    const auto refusedPositions = [&](const CndDevicePositions& wrong, const std::string& why,
                                      CndResult code = CND_ERROR_INVALID_ARGUMENT) {
        const CndDevicePositions both[] = {right, wrong};
        refused(lighting_.replaceOccluderPositionsOnDevice(both),
                "cndReplaceOccluderPositionsOnDevice: " + why, code);
    };
    vulkan_.called.clear();
    CndDevicePositions wrong = right;
    refusedPositions(wrong, "positions[1].mesh is 4294967296, and so is positions[0].mesh");
    wrong.mesh = 7;
    refusedPositions(wrong, "positions[1].mesh is 7, the id of no occluder mesh");
    wrong.mesh = lighting_.addOccluderMesh(mesh_).value();
    wrong.buffer = nullptr;
    refusedPositions(wrong, "positions[1]: buffer is null");
    wrong.buffer = right.buffer;
    wrong.offset = 6;
    refusedPositions(wrong, "positions[1]: offset is 6, must be a multiple of 4");
    wrong.offset = 0;
    for (const uint32_t stride : {8u, 14u}) {
        wrong.stride = stride;
        refusedPositions(wrong, "positions[1]: stride is " + std::to_string(stride) +
                                    ", must be 0 or a multiple of 4 that is at least 12");
    }
    wrong.stride = 1u << 31;
    refusedPositions(wrong,
                     "positions[1]: they take 4294967308 bytes, too many for the device's "
                     "maxStorageBufferRange, " +
                         std::to_string(vulkan_.limits.maxStorageBufferRange),
                     CND_ERROR_UNSUPPORTED);
    EXPECT_FALSE(vulkan_.called.contains("CreateComputePipelines")) << "nothing uses it yet";
    ASSERT_TRUE(lighting_.replaceOccluderPositionsOnDevice({&right, 1}));
    EXPECT_TRUE(vulkan_.called.contains("CreateComputePipelines"));
    record();
    // Back to positions of the host, and gone.
    ASSERT_TRUE(lighting_.replaceOccluderPositions(instance_.mesh, oneTriangle));
    record();
    ASSERT_TRUE(lighting_.replaceOccluderPositionsOnDevice({&right, 1}));
    ASSERT_TRUE(lighting_.removeOccluders({&id_, 1}));
    ASSERT_TRUE(lighting_.removeOccluderMeshes({&instance_.mesh, 1}));
    record();
    EXPECT_FALSE(lighting_.replaceOccluderPositionsOnDevice({&right, 1}));
}

// Trees are fitted on the device after edits, and only if a mesh has positions there.
TEST_F(OccluderInput, PlansSayWhetherTreesAreFitted)
{
    const auto skipped = [&]() -> std::string {
        record();
        const CndLightingStats stats = view_.stats(0).value().value();
        for (uint32_t i = 0; i < stats.passCount; ++i)
            if (std::string(stats.passes[i].name) == "refit_occluders")
                return stats.passes[i].skipped ? stats.passes[i].skipped : "";
        return "no such pass";
    };
    EXPECT_EQ(skipped(), "no positions of the device's");
    const CndDevicePositions positions{.mesh = instance_.mesh, .buffer = MockVulkan::hostBuffer()};
    for (int i = 0; i < 3; ++i) {
        ASSERT_TRUE(lighting_.replaceOccluderPositionsOnDevice({&positions, 1}));
        EXPECT_EQ(skipped(), "");
        EXPECT_EQ(skipped(), "occluders unchanged");
    }
    ASSERT_TRUE(lighting_.updateOccluders({&id_, 1}, {&instance_, 1}));
    EXPECT_EQ(skipped(), "");
}

// The sentence comes before pipelines are made, which may take seconds.
TEST_F(OccluderInput, RaysOfTheHostNeedPoints)
{
    const gpu::Spirv& kernel = spirv::pair_visibility_comp_sphere;
    const CndKernelCode code{"pair_visibility_points", kernel.words.data(),
                             uint32_t(kernel.words.size())};
    vulkan_.called.clear();
    const auto made =
        Lighting::create(vulkan_.desc(), {.framesInFlight = 1, .hostKernels = {1, &code, {}}});
    expectSentence(made.error(), "CndLightingDesc: hostKernels have CND_HOST_VISIBLE_POINTS_BIT, "
                                 "which needs shadows.points of 32 or 64");
    EXPECT_FALSE(vulkan_.called.contains("CreateComputePipelines"));
}

// A forward shader that walks finds nothing in a module whose host has rays, and one that has rays
// may find nothing in a module without. The sets have other bindings, which validation compares.
TEST_F(OccluderInput, ForwardSetsFitOneKindOfShader)
{
    const auto codeOf = [](const char* name, const gpu::Spirv& kernel) {
        return CndKernelCode{name, kernel.words.data(), uint32_t(kernel.words.size())};
    };
    const CndKernelCode rays[] = {
        codeOf("pair_visibility_points", spirv::pair_visibility_comp_sphere),
        codeOf("shade_unlisted_points:CONIC", spirv::shade_unlisted_comp_shadows_conic)};
    std::set<uint32_t> found[2];
    for (const uint32_t count : {0u, 2u}) {
        auto lighting =
            Lighting::create(vulkan_.desc(), {.framesInFlight = 1,
                                              .forwardStages = VK_SHADER_STAGE_FRAGMENT_BIT,
                                              .hostKernels = {count, rays, {}},
                                              .shadows = {.points = 64}});
        ASSERT_TRUE(lighting) << lighting.error().message;
        view_ = {}; // before its module
        lighting_ = std::move(lighting.value());
        auto view = lighting_.createView({.maxWidth = 64, .maxHeight = 48});
        ASSERT_TRUE(view) << view.error().message;
        view_ = std::move(view.value());
        record();
        for (const auto& [binding, resource] : vulkan_.sets[view_.forwardSet(0).value()].resources)
            found[count / 2].insert(binding);
    }
    const std::set<uint32_t> ofWalks{gpu::SHADOW_INSTANCES, gpu::SHADOW_NODES,
                                     gpu::SHADOW_TRIANGLES, gpu::SHADOW_VIEW};
    for (const uint32_t binding : ofWalks)
        EXPECT_TRUE(found[0].erase(binding)) << binding;
    EXPECT_TRUE(found[1].erase(gpu::SHADOW_VIEW_OF_RAYS));
    EXPECT_EQ(found[0], found[1]); // all other bindings are the same
}

TEST_F(OccluderInput, InstancesAreChecked)
{
    CndOccluderInstance instance = instance_;
    instance.mesh = 5;
    refusedInstance(instance, ".mesh is 5, the id of no occluder mesh");
    instance = instance_;
    instance.surfaceError = -1;
    refusedInstance(instance, "surfaceError is -1.000000, must be finite and >= 0");
    instance.surfaceError = std::numeric_limits<float>::infinity();
    refusedInstance(instance, "surfaceError is inf, must be finite and >= 0");
    instance = instance_;
    instance.occluderLayer = 6;
    refusedInstance(instance, "occluderLayer is 6, must be below 6");
    instance = instance_;
    instance.layers = 1u << CND_LAYER_COUNT;
    refusedInstance(instance, "layers has bits beyond CND_LAYER_COUNT");
    instance = instance_;
    instance.worldFromMesh[3] = double(notANumber);
    refusedInstance(instance, "worldFromMesh[3] is nan, must be finite and within 1e15");
    instance = instance_;
    instance.worldFromMesh[5] = 0;
    refusedInstance(instance, "column 1 of worldFromMesh has a length beyond 1e-15..1e15");
    instance.worldFromMesh[4] = 1;
    instance.worldFromMesh[0] = instance.worldFromMesh[1] = 1;
    instance.worldFromMesh[5] = 1.0001;
    refusedInstance(instance,
                    "worldFromMesh is singular: the determinant of its columns, each divided by "
                    "its length, is 0.000050, must be beyond 1e-4 or -1e-4");
}

TEST_F(OccluderInput, IdsAreChecked)
{
    const CndOccluderId twice[] = {id_, id_}, unknown[] = {id_, 3};
    const CndOccluderInstance instances[] = {instance_, instance_};
    const std::string given = "ids[1] is 4294967296, and so is ids[0]";
    refused(lighting_.removeOccluders(twice), "cndRemoveOccluders: " + given);
    refused(lighting_.updateOccluders(twice, instances), "cndUpdateOccluders: " + given);
    refused(lighting_.removeOccluders(unknown),
            "cndRemoveOccluders: ids[1] is 3, the id of no occluder");
    const CndOccluderMeshId twoMeshes[] = {instance_.mesh, instance_.mesh};
    refused(lighting_.removeOccluderMeshes(twoMeshes), "cndRemoveOccluderMeshes: " + given);
    ASSERT_TRUE(lighting_.removeOccluders({&id_, 1}));
    ASSERT_TRUE(lighting_.removeOccluderMeshes({&instance_.mesh, 1}));
    EXPECT_NE(lighting_.addOccluderMesh(mesh_).value(), instance_.mesh) << "ids are never reused";
    EXPECT_FALSE(lighting_.removeOccluderMeshes({&instance_.mesh, 1}));
}

TEST_F(OccluderInput, NoPointerIsNull)
{
    const CndLighting none = nullptr, some = lighting_.get();
    CndError error{};
    const auto refusedNull = [&](CndResult result, const char* call) {
        EXPECT_EQ(result, CND_ERROR_INVALID_ARGUMENT);
        refused(error, std::string(call) + ": an argument is null");
    };
    uint64_t id = 7;
    for (const CndLighting l : {none, some}) {
        const CndOccluderMesh* const meshes = l ? nullptr : &mesh_;
        const CndOccluderInstance* const instances = l ? nullptr : &instance_;
        uint64_t* const ids = l ? nullptr : &id;
        refusedNull(cndAddOccluderMeshes(l, 1, meshes, &id, &error), "cndAddOccluderMeshes");
        refusedNull(cndAddOccluderMeshes(l, 1, &mesh_, ids, &error), "cndAddOccluderMeshes");
        refusedNull(
            cndReplaceOccluderPositions(l, instance_.mesh, l ? nullptr : oneTriangle, 0, &error),
            "cndReplaceOccluderPositions");
        const CndDevicePositions positions{};
        refusedNull(cndReplaceOccluderPositionsOnDevice(l, 1, l ? nullptr : &positions, &error),
                    "cndReplaceOccluderPositionsOnDevice");
        refusedNull(cndRemoveOccluderMeshes(l, 1, ids, &error), "cndRemoveOccluderMeshes");
        refusedNull(cndAddOccluders(l, 1, instances, &id, &error), "cndAddOccluders");
        refusedNull(cndAddOccluders(l, 1, &instance_, ids, &error), "cndAddOccluders");
        refusedNull(cndUpdateOccluders(l, 1, &id_, instances, &error), "cndUpdateOccluders");
        refusedNull(cndUpdateOccluders(l, 1, ids, &instance_, &error), "cndUpdateOccluders");
        refusedNull(cndRemoveOccluders(l, 1, ids, &error), "cndRemoveOccluders");
    }
    EXPECT_EQ(id, 7u);
    // Nothing is read if there is nothing to do.
    EXPECT_EQ(cndAddOccluderMeshes(some, 0, nullptr, nullptr, nullptr), CND_SUCCESS);
    EXPECT_EQ(cndReplaceOccluderPositionsOnDevice(some, 0, nullptr, nullptr), CND_SUCCESS);
    EXPECT_EQ(cndRemoveOccluderMeshes(some, 0, nullptr, nullptr), CND_SUCCESS);
    EXPECT_EQ(cndAddOccluders(some, 0, nullptr, nullptr, nullptr), CND_SUCCESS);
    EXPECT_EQ(cndUpdateOccluders(some, 0, nullptr, nullptr, nullptr), CND_SUCCESS);
    EXPECT_EQ(cndRemoveOccluders(some, 0, nullptr, nullptr), CND_SUCCESS);
    expectUnchanged();
}

TEST_F(OccluderInput, AModuleWithoutShadowsHasNone)
{
    Lighting lighting = std::move(Lighting::create(vulkan_.desc(), {.framesInFlight = 1}).value());
    const std::string why = ": CndLightingDesc::shadows.points was 0";
    uint64_t id = 0;
    expectSentence(lighting.addOccluderMesh(mesh_).error(), "cndAddOccluderMeshes" + why);
    expectSentence(lighting.replaceOccluderPositions(id, oneTriangle).error(),
                   "cndReplaceOccluderPositions" + why);
    const CndDevicePositions positions{.mesh = id};
    expectSentence(lighting.replaceOccluderPositionsOnDevice({&positions, 1}).error(),
                   "cndReplaceOccluderPositionsOnDevice" + why);
    expectSentence(lighting.removeOccluderMeshes({&id, 1}).error(),
                   "cndRemoveOccluderMeshes" + why);
    expectSentence(lighting.addOccluder(instance_).error(), "cndAddOccluders" + why);
    expectSentence(lighting.updateOccluders({&id, 1}, {&instance_, 1}).error(),
                   "cndUpdateOccluders" + why);
    expectSentence(lighting.removeOccluders({&id, 1}).error(), "cndRemoveOccluders" + why);
}

TEST_F(OccluderInput, TheDeviceLimitsTheNumbers)
{
    vulkan_.limits.maxStorageBufferRange = 1 << 20;
    create({.points = 32});
    constexpr uint32_t mostTriangles = (1 << 20) / sizeof(gpu::OccluderTriangle);
    constexpr uint32_t most = (1 << 20) / sizeof(gpu::OccluderInstance);
    const std::vector<float> positions(9 * (mostTriangles + 1));
    CndOccluderMesh mesh{.positions = positions.data()};
    // Alone, and beside the triangle that is there.
    for (mesh.triangleCount = mostTriangles + 1; mesh.triangleCount >= mostTriangles;
         --mesh.triangleCount) {
        mesh.vertexCount = 3 * mesh.triangleCount;
        CndOccluderMeshId id = 0;
        refused(lighting_.addOccluderMeshes({&mesh, 1}, {&id, 1}),
                "cndAddOccluderMeshes: the occluders need a buffer of 1048608 bytes, more than the "
                "device's maxStorageBufferRange, 1048576",
                CND_ERROR_UNSUPPORTED);
    }
    const std::vector<CndOccluderInstance> instances(most, instance_);
    std::vector<CndOccluderId> ids(most);
    refused(lighting_.addOccluders(instances, ids),
            "cndAddOccluders: " + std::to_string(most + 1) +
                " occluders are more than the device can take, " + std::to_string(most),
            CND_ERROR_UNSUPPORTED);
    // Occluders that have been removed do not count towards this limit.
    ids.pop_back();
    ASSERT_TRUE(lighting_.addOccluders(std::span(instances).first(most - 1), ids));
    const std::span<CndOccluderId> some = std::span(ids).first(10);
    for (int i = 0; i < 3; ++i) {
        record();
        ASSERT_TRUE(lighting_.removeOccluders(some));
        const auto added = lighting_.addOccluders(std::span(instances).first(10), some);
        ASSERT_TRUE(added) << added.error().message;
    }
}

// The memory of the device, or the heap, has too little left for an edit.
TEST_F(OccluderInput, MemoryMayRunOut)
{
    const std::vector<float> positions(9 * 3000);
    const CndOccluderMesh mesh{
        .positions = positions.data(), .vertexCount = 9000, .triangleCount = 3000};
    const std::vector<CndOccluderInstance> instances(700, instance_);
    std::vector<uint64_t> ids(instances.size(), 7);
    const auto addMesh = [&](CndError* error) {
        return cndAddOccluderMeshes(lighting_.get(), 1, &mesh, ids.data(), error);
    };
    const auto addInstances = [&](CndError* error) {
        return cndAddOccluders(lighting_.get(), uint32_t(instances.size()), instances.data(),
                               ids.data(), error);
    };
    const auto failsTwice = [&](const auto& call, const std::string& buffer) {
        CndError error{};
        vulkan_.failingCall = vulkan_.failableCalls.size();
        vulkan_.error = VK_ERROR_OUT_OF_DEVICE_MEMORY;
        EXPECT_EQ(call(&error), CND_ERROR_OUT_OF_MEMORY);
        refused(error, "creating buffer " + buffer + " failed (VK_ERROR_OUT_OF_DEVICE_MEMORY)",
                CND_ERROR_OUT_OF_MEMORY);
        CndResult result = CND_SUCCESS;
        {
            const HostAllocations heap(0);
            result = call(&error);
        }
        EXPECT_EQ(result, CND_ERROR_OUT_OF_MEMORY);
        refused(error, "out of host memory", CND_ERROR_OUT_OF_MEMORY);
        EXPECT_EQ(ids, std::vector<uint64_t>(instances.size(), 7));
    };
    failsTwice(addMesh, "occluder nodes");
    failsTwice(addInstances, "occluder instances");
}

TEST_F(OccluderInput, CreationIsChecked)
{
    const auto refusedModule = [&](const CndLightingDesc& desc, const std::string& sentence,
                                   CndResult code = CND_ERROR_INVALID_ARGUMENT) {
        expectSentence(Lighting::create(vulkan_.desc(), desc).error(), sentence, code);
        expectSentence(Lighting::plan(vulkan_.desc(), desc).error(), sentence, code);
    };
    CndLightingDesc desc{.framesInFlight = 1, .shadows = {.points = 16}};
    refusedModule(desc, "CndShadowDesc: points must be 0, 32 or 64, is 16");
    desc.shadows.points = 32;
    const auto refusedDepth = [&](VkFormat format, const char* name, CndDepthKind kind) {
        desc.gbuffer = {.depthFormat = format, .depthKind = kind};
        refusedModule(desc, std::string("CndShadowDesc: shadows need depth of at least 24 bits, "
                                        "CndGBufferDesc::depthFormat is ") +
                                name);
    };
    refusedDepth(VK_FORMAT_D16_UNORM, "VK_FORMAT_D16_UNORM", CND_DEPTH_PROJECTED);
    refusedDepth(VK_FORMAT_D16_UNORM_S8_UINT, "VK_FORMAT_D16_UNORM_S8_UINT", CND_DEPTH_PROJECTED);
    refusedDepth(VK_FORMAT_R16_SFLOAT, "VK_FORMAT_R16_SFLOAT", CND_DEPTH_LINEAR);
    refusedDepth(VK_FORMAT_R16G16B16A16_SFLOAT, "VK_FORMAT_R16G16B16A16_SFLOAT",
                 CND_DEPTH_POSITION_WORLD);
    desc.shadows.points = 0; // without shadows all of them are welcome
    EXPECT_TRUE(Lighting::create(vulkan_.desc(), desc));
    desc.gbuffer = {.depthFormat = VK_FORMAT_D24_UNORM_S8_UINT};
    desc.shadows.points = 32;
    EXPECT_TRUE(Lighting::create(vulkan_.desc(), desc));
    desc.shadows.triangleCapacity = 4000000;
    refusedModule(desc, "CndShadowDesc: triangleCapacity is 4000000, the device can take 3728270",
                  CND_ERROR_UNSUPPORTED);
    desc.shadows = {.points = 32, .instanceCapacity = 2000000};
    refusedModule(desc, "CndShadowDesc: instanceCapacity is 2000000, the device can take 1198372",
                  CND_ERROR_UNSUPPORTED);
    desc.shadows = {.points = 32, .triangleCapacity = 3700000, .instanceCapacity = 400000};
    refusedModule(desc,
                  "CndShadowDesc: triangleCapacity and instanceCapacity need a buffer of 144000000 "
                  "bytes for nodes, more than the device's maxStorageBufferRange, 134217728",
                  CND_ERROR_UNSUPPORTED);
}

TEST_F(OccluderInput, ViewsAreChecked)
{
    const auto refusedView = [&](const CndLightingViewDesc& desc, const std::string& sentence) {
        expectSentence(lighting_.createView(desc).error(), sentence, CND_ERROR_UNSUPPORTED);
        expectUnchanged();
    };
    refusedView({.maxWidth = 64, .maxHeight = 64, .shadowBudget = (1u << 27) + 1},
                "CndLightingViewDesc: shadowBudget 134217729 exceeds the device's "
                "maxStorageBufferRange 134217728");
    refusedView({.maxWidth = 8192, .maxHeight = 8192},
                "CndLightingViewDesc: shadows of maxWidth x maxHeight pixels need a buffer of "
                "268435456 bytes, more than the device's maxStorageBufferRange, 134217728");
}

} // namespace candelabra::test
