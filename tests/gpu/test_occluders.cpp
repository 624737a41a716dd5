// SPDX-License-Identifier: Apache-2.0
// The device has the meshes, trees and records of occluders that the host has, after any edits, and
// prepare_occluders transforms instances as double precision does.
#include <bit>
#include <limits>
#include <random>

#include <glm/gtc/matrix_transform.hpp>
#include <glm/gtc/type_ptr.hpp>

#include "harness/gpu_fixture.h"
#include "harness/occluder_host.h"

namespace candelabra::test
{
namespace
{

using lighting::DevicePositions;
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
    // Adds a grid of squares, whose triangles share vertices, and returns its id.
    OccluderMeshId addGrid(OccluderHost& host, uint32_t side)
    {
        std::vector<glm::vec3> p;
        std::vector<uint32_t> indices;
        for (uint32_t y = 0; y <= side; ++y)
            for (uint32_t x = 0; x <= side; ++x) {
                p.emplace_back(x, y, 0);
                if (const uint32_t i = y * (side + 1) + x; x < side && y < side)
                    indices.insert(indices.end(),
                                   {i, i + 1, i + side + 1, i + side + 1, i + 1, i + side + 2});
            }
        const OccluderMesh mesh{.positions = &p[0].x,
                                .vertexCount = uint32_t(p.size()),
                                .indices = indices.data(),
                                .triangleCount = uint32_t(indices.size() / 3)};
        OccluderMeshId id = 0;
        host.set.addMeshes({&mesh, 1}, &id);
        return id;
    }
    // A buffer of the host, as a kernel of its own leaves it: `offset` bytes, then the positions.
    gpu::Buffer written(const std::vector<glm::vec3>& positions, size_t offset, size_t stride)
    {
        gpu::Buffer out =
            gpu::createBuffer(device(), "pose", offset + positions.size() * stride,
                              VK_BUFFER_USAGE_STORAGE_BUFFER_BIT, gpu::MemoryUse::Upload);
        for (size_t i = 0; i < positions.size(); ++i)
            std::memcpy(out.mapped + offset + i * stride, &positions[i], sizeof positions[i]);
        return out;
    }
    // Expects that the device has fitted the tree over instances: no node lacks any of its items,
    // as double precision transforms them, and none is much larger. (Leaves of removed instances
    // keep their boxes.)
    void expectFittedInstances(const lighting::OccluderSet& set,
                               std::span<const gpu::OccluderNode> nodes)
    {
        const lighting::InstanceTable& instances = set.instances();
        const auto tree = nodes.subspan(set.meshes().firstInstanceNode());
        const uint32_t count = instances.places() ? tree[0].skip : 0;
        for (uint32_t node = 0; node < count && !HasFailure(); ++node) {
            glm::dvec3 low(1e30), high(-1e30);
            bool removed = false;
            for (uint32_t n = node; n < tree[node].skip; ++n)
                for (uint32_t place = lighting::leafFirst(tree[n]);
                     tree[n].leaf && place < lighting::leafEnd(tree[n]); ++place) {
                    const gpu::OccluderRecord& r = instances.records()[place];
                    removed |= r.flags == 0;
                    if (r.flags)
                        addCorners(r, lighting::boxOf(nodes[r.firstNode]), instances.origin(), low,
                                   high);
                }
            const lighting::Box found = lighting::boxOf(tree[node]);
            const double slack = 1e-4 * (glm::length(high - low) + glm::length(low));
            for (int axis = 0; axis < 3; ++axis) {
                EXPECT_LE(found.low[axis], low[axis]) << node;
                EXPECT_GE(found.high[axis], high[axis]) << node;
                EXPECT_TRUE(removed || found.low[axis] > low[axis] - slack) << node;
                EXPECT_TRUE(removed || found.high[axis] < high[axis] + slack) << node;
            }
        }
    }
    // Adds the corners of a mesh's box, relative to the origin of the tree over instances.
    static void addCorners(const gpu::OccluderRecord& r, const lighting::Box& box,
                           const glm::dvec3& origin, glm::dvec3& low, glm::dvec3& high)
    {
        for (int corner = 0; corner < 8; ++corner) {
            glm::dvec3 p;
            for (int axis = 0; axis < 3; ++axis)
                p[axis] = (corner >> axis & 1 ? box.high : box.low)[axis];
            p = glm::dmat3(r.worldFromLocal) * p + glm::dvec3(r.positionHi) +
                glm::dvec3(r.positionLo) - origin;
            low = glm::min(low, p);
            high = glm::max(high, p);
        }
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

// After any pose on the device, triangles and nodes have the bits that the host would upload.
TEST_F(OccluderTest, PositionsOnTheDeviceGiveTheTreesOfTheHost)
{
    OccluderHost host(device()), twin(device()); // the twin gets every pose from the CPU
    std::vector<OccluderMeshId> meshes, twins;
    const auto addMeshes = [&] {
        for (const uint32_t side : {1u, 3u, 20u, 100u}) {
            meshes.push_back(addGrid(host, side));
            twins.push_back(addGrid(twin, side));
        }
    };
    addMeshes();
    const auto vertexCount = [&](size_t mesh) {
        return host.set.meshes()[meshes[mesh]].vertexCount;
    };
    std::vector<gpu::Buffer> buffers;
    const auto pose = [&](size_t mesh, float size, size_t offset, size_t stride) {
        std::vector<glm::vec3> p(vertexCount(mesh));
        for (glm::vec3& q : p)
            q = glm::vec3(point(size));
        buffers.push_back(written(p, offset, stride));
        const DevicePositions given{.mesh = meshes[mesh],
                                    .buffer = buffers.back().get(),
                                    .offset = offset,
                                    .stride = stride == 12 ? 0 : uint32_t(stride)};
        host.set.replacePositionsOnDevice({&given, 1});
        twin.set.replacePositions(twins[mesh], &p[0].x, 0);
    };
    const auto expectSame = [&] {
        record(host, glm::dmat4(1));
        record(twin, glm::dmat4(1));
        const lighting::MeshTable& table = host.set.meshes();
        const auto nodes = read<gpu::OccluderNode>(table.nodes(), table.allNodes().size());
        const auto triangles =
            read<gpu::OccluderTriangle>(table.triangles(), table.allTriangles().size());
        for (size_t i = 0; i < meshes.size(); ++i) {
            const auto &m = table[meshes[i]], &t = twin.set.meshes()[twins[i]];
            const auto expected = twin.set.meshes().nodesOf(t);
            EXPECT_EQ(std::memcmp(&nodes[m.firstNode], expected.data(), expected.size_bytes()), 0)
                << "nodes of mesh " << i;
            const auto theirs =
                twin.set.meshes().allTriangles().subspan(t.firstTriangle, t.triangleCount);
            EXPECT_EQ(std::memcmp(&triangles[m.firstTriangle], theirs.data(), theirs.size_bytes()),
                      0)
                << "triangles of mesh " << i;
        }
        expectFittedInstances(host.set, nodes);
    };
    for (const size_t mesh : {0u, 2u, 3u})
        pose(mesh, 1, 0, 12);
    expectSame(); // before there is an instance
    std::vector<OccluderId> ids(300);
    for (OccluderId& id : ids) {
        const OccluderInstance added = instance(meshes[random_() % meshes.size()]);
        host.set.add({&added, 1}, &id);
    }
    expectSame();
    pose(0, 1e6f, 4, 16); // far from the first pose
    pose(3, 1e-6f, 260, 32);
    expectSame();
    pose(1, 1, 52, 20); // these share blocks of uploads with other meshes
    twin.set.replacePositions(twins[2], std::vector<float>(3 * vertexCount(2)).data(), 0);
    host.set.replacePositions(meshes[2], std::vector<float>(3 * vertexCount(2)).data(), 0);
    expectSame();
    addMeshes(); // buffers grow, and everything is uploaded again
    host.set.remove(std::span(ids).first(120));
    const OccluderInstance moved = instance(meshes[1]);
    host.set.update({&ids[200], 1}, {&moved, 1});
    expectSame();
    host.set.remove(std::span(ids).subspan(120));
    host.set.removeMeshes({&meshes[3], 1});
    meshes.erase(meshes.begin() + 3);
    twins.erase(twins.begin() + 3);
    pose(5, 1, 0, 12);
    expectSame();
}

// What no host could give counts as 0.
TEST_F(OccluderTest, PositionsOnTheDeviceAreMadeFinite)
{
    constexpr float endless = std::numeric_limits<float>::infinity();
    OccluderHost host(device());
    const OccluderMeshId mesh = addGrid(host, 1);
    const std::vector<glm::vec3> p = {{std::nanf(""), 1, -2e15f},
                                      {-0.f, endless, 1e15f},
                                      {3, -endless, -std::nanf("")},
                                      {std::bit_cast<float>(1u), -1e15f, 5}};
    const gpu::Buffer buffer = written(p, 0, 12);
    const DevicePositions given{.mesh = mesh, .buffer = buffer.get()};
    host.set.replacePositionsOnDevice({&given, 1});
    record(host, glm::dmat4(1));
    const glm::vec3 a(0, 1, 0), b(0, 0, 1e15f), c(3, 0, 0), d(std::bit_cast<float>(1u), -1e15f, 5);
    std::vector<gpu::OccluderTriangle> expected;
    for (const glm::uvec3& corners : host.set.meshes()[mesh].corners) {
        const glm::vec3 all[] = {a, b, c, d};
        expected.push_back({{all[corners.x], all[corners.y], all[corners.z]}});
    }
    expectOnDevice(host.set.meshes().triangles(), std::span<const gpu::OccluderTriangle>(expected));
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
