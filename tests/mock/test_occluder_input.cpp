// SPDX-License-Identifier: Apache-2.0
// Wrong meshes and instances of occluders are refused with one sentence that names the offending
// element, and the set stays as it was.
#include <cmath>
#include <limits>

#include <gtest/gtest.h>

#include "harness/occluder_host.h"
#include "mock/mock_vulkan.h"

namespace candelabra::test
{
namespace
{

using lighting::OccluderId;
using lighting::OccluderInstance;
using lighting::OccluderMesh;
using lighting::OccluderMeshId;

constexpr float notANumber = std::numeric_limits<float>::quiet_NaN();
constexpr float oneTriangle[] = {0, 0, 0, 1, 0, 0, 0, 1, 0};

class OccluderInput : public ::testing::Test
{
protected:
    void SetUp() override
    {
        host_.set.addMeshes({&mesh_, 1}, &meshId_);
        instance_.mesh = meshId_;
        for (int i = 0; i < 3; ++i)
            instance_.worldFromMesh[5 * i] = 1;
        host_.set.add({&instance_, 1}, &id_);
    }

    // Expects that a call is refused with this sentence and changes nothing.
    template <typename Call>
    void refused(const std::string& sentence, Call&& call,
                 CndResult code = CND_ERROR_INVALID_ARGUMENT)
    {
        const uint64_t number = host_.set.number();
        const size_t triangles = host_.set.meshes().allTriangles().size();
        try {
            call();
            ADD_FAILURE() << "accepted: " << sentence;
        } catch (const gpu::Failure& failure) {
            EXPECT_EQ(failure.message, sentence);
            EXPECT_EQ(failure.code, code);
        }
        EXPECT_EQ(host_.set.number(), number);
        EXPECT_EQ(host_.set.meshes().allTriangles().size(), triangles);
        EXPECT_EQ(host_.set.instances().count(), 1u);
    }
    // Adds a correct mesh and this one, which is refused.
    void refusedMesh(const std::string& why, const OccluderMesh& mesh,
                     CndResult code = CND_ERROR_INVALID_ARGUMENT)
    {
        const OccluderMesh meshes[] = {mesh_, mesh};
        OccluderMeshId ids[2];
        refused(
            "cndAddOccluderMeshes: " + why, [&] { host_.set.addMeshes(meshes, ids); }, code);
    }
    void refusedInstance(const std::string& why, const OccluderInstance& instance)
    {
        const OccluderInstance instances[] = {instance_, instance};
        OccluderId ids[2];
        refused("cndAddOccluders: occluder 1: " + why, [&] { host_.set.add(instances, ids); });
        refused("cndUpdateOccluders: occluder 0: " + why, [&] {
            host_.set.update({&id_, 1}, {&instance, 1});
        });
    }

    MockVulkan vulkan_;
    gpu::Device device_{vulkan_.desc(), gpu::lightingModule};
    OccluderHost host_{device_};
    const OccluderMesh mesh_{.positions = oneTriangle, .vertexCount = 3, .triangleCount = 1};
    OccluderInstance instance_{};
    OccluderMeshId meshId_ = 0;
    OccluderId id_ = 0;
};

} // namespace

TEST_F(OccluderInput, MeshesAreChecked)
{
    const std::string name = "mesh 1: ";
    OccluderMesh mesh = mesh_;
    mesh.positions = nullptr;
    refusedMesh(name + "positions is null", mesh);
    mesh = mesh_;
    for (const uint32_t stride : {8u, 13u}) {
        mesh.stride = stride;
        refusedMesh(name + "stride is " + std::to_string(stride) +
                        ", must be 0 or a multiple of 4 that is at least 12",
                    mesh);
    }
    mesh = mesh_;
    mesh.triangleCount = 0;
    refusedMesh(name + "triangleCount is 0, must be 1..2^28", mesh);
    mesh.triangleCount = (1u << 28) + 1;
    refusedMesh(name + "triangleCount is 268435457, must be 1..2^28", mesh);
    mesh.triangleCount = 2;
    refusedMesh(name + "vertexCount is 3, must be 3 triangleCount = 6 without indices", mesh);
    const uint32_t indices[] = {0, 1, 3};
    mesh.triangleCount = 1;
    mesh.indices = indices;
    refusedMesh(name + "indices[2] is 3, must be below vertexCount, 3", mesh);
    const float broken[] = {0, 0, 0, 1, notANumber, 0, 0, 1, 0},
                far[] = {0, 0, 0, 1, 0, 0, 0, 1, 2e15f};
    mesh = mesh_;
    mesh.positions = broken;
    refusedMesh(name + "positions[1][1] is nan, must be finite and within 1e15", mesh);
    mesh.positions = far;
    refusedMesh(name + "positions[2][2] is 1999999973982208.000000, must be finite and within 1e15",
                mesh);
    refused("cndReplaceOccluderPositions: positions[1][1] is nan, must be finite and within 1e15",
            [&] { host_.set.replacePositions(meshId_, broken, 0); });
    refused("cndReplaceOccluderPositions: no occluder mesh has the id 7 (generation 0)",
            [&] { host_.set.replacePositions(7, oneTriangle, 0); });
    refused("cndReplaceOccluderPositions: stride is 4, must be 0 or a multiple of 4 that is at "
            "least 12",
            [&] { host_.set.replacePositions(meshId_, oneTriangle, 4); });
}

TEST_F(OccluderInput, InstancesAreChecked)
{
    const float infinity = std::numeric_limits<float>::infinity();
    OccluderInstance instance = instance_;
    instance.mesh = 5;
    refusedInstance("no occluder mesh has the id 5 (generation 0)", instance);
    instance = instance_;
    instance.surfaceError = -1;
    refusedInstance("surfaceError is -1.000000, must be finite and >= 0", instance);
    instance.surfaceError = infinity;
    refusedInstance("surfaceError is inf, must be finite and >= 0", instance);
    instance = instance_;
    instance.occluderLayer = 6;
    refusedInstance("occluderLayer is 6, must be below 6", instance);
    instance = instance_;
    instance.layers = 1u << CND_LAYER_COUNT;
    refusedInstance("layers has bits beyond CND_LAYER_COUNT", instance);
    instance = instance_;
    instance.worldFromMesh[3] = double(notANumber);
    refusedInstance("worldFromMesh[3] is nan, must be finite and within 1e15", instance);
    instance = instance_;
    instance.worldFromMesh[5] = 0;
    refusedInstance("column 1 of worldFromMesh has a length beyond 1e-15..1e15", instance);
    instance.worldFromMesh[4] = 1;
    instance.worldFromMesh[0] = instance.worldFromMesh[1] = 1;
    instance.worldFromMesh[5] = 1.0001;
    refusedInstance("worldFromMesh is singular: the determinant of its columns, each divided by "
                    "its length, is 0.000050, must be beyond 1e-4 or -1e-4",
                    instance);
}

// Columns of any length, at right angles or nearly so, mirrored or not.
TEST_F(OccluderInput, TransformsMayStretchAndMirror)
{
    OccluderInstance instance = instance_;
    instance.worldFromMesh[0] = 1e-15;
    instance.worldFromMesh[5] = 1e15;
    instance.worldFromMesh[6] = 0.3;
    instance.worldFromMesh[10] = -1;
    instance.worldFromMesh[3] = 1e15;
    host_.set.update({&id_, 1}, {&instance, 1});
    host_.record(MockVulkan::commandBuffer(), {1, 0, 0, 0, 0, 1, 0, 0, 0, 0, 1, 0, 0, 0, 0, 1});
    vulkan_.finish(vulkan_.submit());
    EXPECT_TRUE(
        std::isfinite(lighting::halfSurface(lighting::boxOf(host_.set.instances().nodes()[0]))));
}

TEST_F(OccluderInput, IdsAreChecked)
{
    const OccluderId twice[] = {id_, id_}, unknown[] = {id_, 3};
    const OccluderInstance instances[] = {instance_, instance_};
    const std::string given = "the id 0 (generation 1) is given twice";
    refused("cndRemoveOccluders: " + given, [&] { host_.set.remove(twice); });
    refused("cndUpdateOccluders: " + given, [&] { host_.set.update(twice, instances); });
    refused("cndRemoveOccluders: no occluder has the id 3 (generation 0)",
            [&] { host_.set.remove(unknown); });
    const OccluderMeshId twoMeshes[] = {meshId_, meshId_};
    refused("cndRemoveOccluderMeshes: " + given, [&] { host_.set.removeMeshes(twoMeshes); });
    refused("cndRemoveOccluderMeshes: ids[0] is a mesh that 1 occluders use", [&] {
        host_.set.removeMeshes({&meshId_, 1});
    });
    host_.set.remove({&id_, 1});
    host_.set.removeMeshes({&meshId_, 1});
    OccluderMeshId other = 0;
    host_.set.addMeshes({&mesh_, 1}, &other);
    EXPECT_NE(other, meshId_) << "ids are never reused";
    EXPECT_THROW(host_.set.removeMeshes({&meshId_, 1}), gpu::Failure);
}

TEST_F(OccluderInput, TheDeviceLimitsTheNumbers)
{
    device_.limits.maxStorageBufferRange = 10 * sizeof(gpu::OccluderTriangle);
    const std::vector<float> positions(9 * 11);
    const OccluderMesh mesh{.positions = positions.data(), .vertexCount = 33, .triangleCount = 11};
    OccluderMeshId id = 0;
    refused(
        "cndAddOccluderMeshes: the meshes need a buffer of 396 bytes, more than the device's "
        "maxStorageBufferRange, 360",
        [&] {
            host_.set.addMeshes({&mesh, 1}, &id);
        },
        CND_ERROR_UNSUPPORTED);
    const OccluderMesh ten{.positions = positions.data(), .vertexCount = 30, .triangleCount = 10};
    refused(
        "cndAddOccluderMeshes: the meshes need a buffer of 396 bytes, more than the device's "
        "maxStorageBufferRange, 360",
        [&] {
            host_.set.addMeshes({&ten, 1}, &id);
        },
        CND_ERROR_UNSUPPORTED);
    const std::vector<OccluderInstance> instances(3, instance_);
    OccluderId ids[3];
    refused(
        "cndAddOccluders: 4 occluders are more than the device can take, 3",
        [&] { host_.set.add(instances, ids); }, CND_ERROR_UNSUPPORTED);
    EXPECT_THROW(OccluderHost(device_, 11), gpu::Failure);
    EXPECT_THROW(OccluderHost(device_, 0, 4), gpu::Failure);
}

} // namespace candelabra::test
