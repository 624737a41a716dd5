// SPDX-License-Identifier: Apache-2.0
// The device has the meshes, trees and records of occluders that the host has, after any edits, and
// prepare_occluders transforms instances as double precision does.
#include <random>

#include <glm/gtc/matrix_transform.hpp>
#include <glm/gtc/type_ptr.hpp>

#include "harness/gpu_fixture.h"
#include "harness/occluder_host.h"

namespace candelabra::test
{
namespace
{

using lighting::OccluderId;
using lighting::OccluderInstance;
using lighting::OccluderMesh;
using lighting::OccluderMeshId;

constexpr glm::dvec3 somewhere(1e6, -2e5, 300);

class OccluderTest : public GpuTest
{
protected:
    double number(double low, double high)
    {
        return low + (high - low) * double(random_()) / double(random_.max());
    }
    glm::dvec3 point(double size)
    {
        return {number(-size, size), number(-size, size), number(-size, size)};
    }
    std::vector<glm::vec3> positions(uint32_t triangles)
    {
        std::vector<glm::vec3> out(3 * size_t(triangles));
        for (glm::vec3& p : out)
            p = glm::vec3(point(1));
        return out;
    }
    OccluderMeshId addMesh(OccluderHost& host, uint32_t triangles)
    {
        const std::vector<glm::vec3> p = positions(triangles);
        const OccluderMesh mesh{
            .positions = &p[0].x, .vertexCount = uint32_t(p.size()), .triangleCount = triangles};
        OccluderMeshId id = 0;
        host.set.addMeshes({&mesh, 1}, &id);
        return id;
    }
    OccluderInstance instance(OccluderMeshId mesh)
    {
        OccluderInstance out{.mesh = mesh, .surfaceError = float(number(0, 1)), .layers = 5};
        const glm::dvec3 position = somewhere + point(10);
        const double size = std::exp2(number(-20, 20));
        for (int row = 0; row < 3; ++row) {
            for (int column = 0; column < 3; ++column)
                out.worldFromMesh[4 * row + column] =
                    size * (number(-0.4, 0.4) + (row == column) * number(0.9, 2));
            out.worldFromMesh[4 * row + 3] = position[row];
        }
        return out;
    }
    void record(OccluderHost& host, const glm::dmat4& view)
    {
        double viewFromWorld[16];
        std::memcpy(viewFromWorld, glm::value_ptr(view), sizeof viewFromWorld);
        context().submitAndWait([&](VkCommandBuffer cmd) { host.record(cmd, viewFromWorld); });
    }
    // Expects that a buffer of the device begins with these elements.
    template <typename T>
    void expectOnDevice(const gpu::Buffer& buffer, std::span<const T> expected)
    {
        if (expected.empty())
            return;
        const std::vector<T> found = read<T>(buffer, expected.size());
        EXPECT_EQ(std::memcmp(found.data(), expected.data(), expected.size_bytes()), 0);
    }
    template <typename T>
    std::vector<T> read(const gpu::Buffer& buffer, size_t count)
    {
        const gpu::Buffer copy = readback("copy", count * sizeof(T));
        context().submitAndWait([&](VkCommandBuffer cmd) {
            const VkBufferCopy all{.size = count * sizeof(T)};
            device().CmdCopyBuffer(cmd, buffer.get(), copy.get(), 1, &all);
            fullBarrier(cmd);
        });
        const auto mapped = copy.as<T>();
        return {mapped.begin(), mapped.begin() + std::ptrdiff_t(count)};
    }
    // Room for the tree over instances that no tree has used yet is zero here and undefined there.
    void expectNodesOnDevice(const lighting::MeshTable& meshes)
    {
        const auto nodes = meshes.allNodes();
        const auto found = read<gpu::OccluderNode>(meshes.nodes(), nodes.size());
        const gpu::OccluderNode unused{};
        for (size_t i = 0; i < nodes.size(); ++i)
            if (std::memcmp(&nodes[i], &unused, sizeof unused) != 0) {
                EXPECT_EQ(std::memcmp(&found[i], &nodes[i], sizeof unused), 0) << "node " << i;
            }
    }
    void expectAllOnDevice(const lighting::OccluderSet& set)
    {
        expectNodesOnDevice(set.meshes());
        expectOnDevice(set.meshes().triangles(), set.meshes().allTriangles());
        expectOnDevice(set.meshes().neighbours(), set.meshes().allNeighbours());
        EXPECT_EQ(set.meshes().triangles().size % 16, 0u); // texels of four floats hold all of them
        expectOnDevice(set.instances().recordBuffer(), set.instances().records());
    }

    std::mt19937 random_{1};
};

} // namespace

TEST_F(OccluderTest, TheDeviceHasWhatTheHostHas)
{
    OccluderHost host(device());
    std::vector<OccluderMeshId> meshes;
    std::vector<OccluderId> ids;
    for (int round = 0; round < 12; ++round) {
        meshes.push_back(addMesh(host, 1 + round * 300));
        for (int i = 0; i < 1 + round * 40; ++i) {
            const OccluderInstance added = instance(meshes[random_() % meshes.size()]);
            host.set.add({&added, 1}, &ids.emplace_back());
        }
        record(host, glm::dmat4(1));
        expectAllOnDevice(host.set);
        for (int i = 0; i < 5 + round; ++i) {
            const OccluderInstance with = instance(meshes[random_() % meshes.size()]);
            host.set.update({&ids[random_() % ids.size()], 1}, {&with, 1});
        }
        std::swap(ids.back(), ids[random_() % ids.size()]);
        host.set.remove({&ids.back(), 1});
        ids.pop_back();
        const std::vector<glm::vec3> moved = positions(1 + round * 300);
        host.set.replacePositions(meshes.back(), &moved[0].x, 0);
        record(host, glm::dmat4(1));
        expectAllOnDevice(host.set);
    }
}

// Meshes and the tree over instances share a buffer, and one upload: it must have room for both.
TEST_F(OccluderTest, EditsOfInstancesAndMeshesFitIntoOneUpload)
{
    OccluderHost host(device(), 20000, 20000); // nothing grows, which would upload everything
    const OccluderMeshId mesh = addMesh(host, 1);
    for (const size_t count : {1u, 4000u}) {
        const std::vector<OccluderInstance> added(count, instance(mesh));
        std::vector<OccluderId> ids(count);
        host.set.add(added, ids.data());
    }
    addMesh(host, 9000);
    record(host, glm::dmat4(1));
    expectAllOnDevice(host.set);
}

TEST_F(OccluderTest, InstancesAreTransformedAsInDoublePrecision)
{
    OccluderHost host(device());
    const OccluderMeshId mesh = addMesh(host, 3), other = addMesh(host, 4);
    constexpr uint32_t count = 300;
    std::vector<OccluderInstance> given;
    for (uint32_t i = 0; i < count; ++i)
        given.push_back(instance(i % 2 ? mesh : other));
    std::vector<OccluderId> ids(count);
    host.set.add(given, ids.data());
    const glm::dmat4 view =
        glm::lookAt(somewhere + glm::dvec3(20, 5, 3), somewhere, glm::dvec3(0.1, 0.2, 1));
    record(host, view);
    const auto found = read<gpu::OccluderInstance>(host.prepared.buffer(), count);
    for (uint32_t place = 0; place < count; ++place) {
        const gpu::OccluderRecord& record = host.set.instances().records()[place];
        const gpu::OccluderInstance& f = found[place];
        const glm::dmat3 linear(record.worldFromLocal), rotation(view);
        const glm::dvec3 position = glm::dvec3(record.positionHi) + glm::dvec3(record.positionLo);
        const glm::dvec3 inView = view * glm::dvec4(position, 1);
        const double size = glm::length(linear[0]);
        for (int column = 0; column < 3; ++column)
            EXPECT_LT(
                glm::length(glm::dvec3(f.viewFromLocal[column]) - (rotation * linear)[column]),
                1e-6 * size);
        // The difference of two positions of 1e6 m, each exact to 4e-9 m.
        EXPECT_LT(glm::length(glm::dvec3(f.localInView) - inView), 1e-5);
        const glm::dmat3 both = glm::dmat3(f.localFromView) * rotation * linear;
        for (int column = 0; column < 3; ++column)
            EXPECT_LT(glm::length(both[column] - glm::dmat3(1)[column]), 1e-5);
        const glm::dvec3 origin = glm::dmat3(f.localFromView) * inView + glm::dvec3(f.viewInLocal);
        EXPECT_LT(glm::length(origin) * size, 1e-4);
        EXPECT_EQ(f.firstNode, record.firstNode);
        EXPECT_EQ(f.firstTriangle, record.firstTriangle);
        EXPECT_EQ(f.flags, record.flags);
        EXPECT_EQ(f.flags, 5u | 1u << gpu::OCCLUDER_LAYERS_SHIFT);
        EXPECT_EQ(f.surfaceError, record.surfaceError);
    }
}

} // namespace candelabra::test
