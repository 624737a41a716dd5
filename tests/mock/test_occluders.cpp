// SPDX-License-Identifier: Apache-2.0
// The set of occluders on the mock driver: edits lead to what a fresh set has, and only what has
// changed is uploaded.
#include <cmath>
#include <map>
#include <numeric>
#include <random>

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
using Positions = std::vector<glm::vec3>;

constexpr double unmoved[16] = {1, 0, 0, 0, 0, 1, 0, 0, 0, 0, 1, 0, 0, 0, 0, 1};

OccluderMesh meshOf(const Positions& positions)
{
    return {.positions = &positions[0].x,
            .vertexCount = uint32_t(positions.size()),
            .triangleCount = uint32_t(positions.size() / 3)};
}

class OccluderRandom
{
public:
    explicit OccluderRandom(uint32_t seed) : random_(seed) {}
    uint32_t below(uint32_t end) { return uint32_t(random_() % end); }
    double number(double low, double high)
    {
        return low + (high - low) * double(random_()) / double(random_.max());
    }
    glm::dvec3 point(double size)
    {
        return {number(-size, size), number(-size, size), number(-size, size)};
    }
    Positions positions(uint32_t triangles)
    {
        Positions out(3 * size_t(triangles));
        for (glm::vec3& p : out)
            p = glm::vec3(point(1));
        return out;
    }
    // Rotated, mirrored, stretched and sheared, far from the origin of the world.
    OccluderInstance instance(OccluderMeshId mesh, float surfaceError)
    {
        OccluderInstance out{.mesh = mesh,
                             .surfaceError = surfaceError,
                             .occluderLayer = below(6),
                             .layers = below(3)};
        const glm::dvec3 position = world + point(5);
        for (int row = 0; row < 3; ++row) {
            for (int column = 0; column < 3; ++column)
                out.worldFromMesh[4 * row + column] =
                    number(-0.4, 0.4) + (row == column) * number(0.9, 2);
            out.worldFromMesh[4 * row + 3] = position[row];
        }
        return out;
    }
    Segment segment() { return {world + point(7), world + point(7)}; }

    const glm::dvec3 world{1e6, -2e5, 300};

private:
    std::mt19937 random_;
};

class Occluders : public ::testing::Test
{
protected:
    void record(OccluderHost& host)
    {
        host.record(MockVulkan::commandBuffer(), unmoved);
        vulkan_.finish(vulkan_.submit());
    }
    void TearDown() override
    {
        for (const std::string& what : vulkan_.misuse)
            ADD_FAILURE() << what;
    }
    // Returns the bytes that the host's memory gave to copies recorded since the last submission.
    size_t copiedBytes() const
    {
        size_t sum = 0;
        for (const MockVulkan::Commands::Read& read : vulkan_.recorded.reads)
            sum += read.bytes.size();
        return sum;
    }

    MockVulkan vulkan_;
    gpu::Device device_{vulkan_.desc(), gpu::lightingModule};
};

// What a host knows of its occluders.
struct Model {
    std::map<OccluderMeshId, Positions> meshes;
    std::map<OccluderId, OccluderInstance> instances;

    bool isUsed(OccluderMeshId mesh) const
    {
        return std::ranges::any_of(instances, [&](const auto& i) { return i.second.mesh == mesh; });
    }
    template <typename Map>
    static auto any(Map& map, OccluderRandom& random)
    {
        return std::next(map.begin(), random.below(uint32_t(map.size())));
    }

    void addMesh(OccluderHost& host, OccluderRandom& random)
    {
        Positions positions = random.positions(1 + random.below(50));
        const OccluderMesh mesh = meshOf(positions);
        OccluderMeshId id = 0;
        host.set.addMeshes({&mesh, 1}, &id);
        meshes[id] = std::move(positions);
    }
    void edit(OccluderHost& host, OccluderRandom& random)
    {
        const uint32_t what = random.below(16);
        if (meshes.empty() || what == 0) {
            addMesh(host, random);
        } else if (what == 1) {
            const auto mesh = any(meshes, random);
            mesh->second = random.positions(uint32_t(mesh->second.size() / 3));
            host.set.replacePositions(mesh->first, &mesh->second[0].x, 0);
        } else if (what == 2) {
            const auto mesh = any(meshes, random);
            if (isUsed(mesh->first))
                return;
            host.set.removeMeshes({&mesh->first, 1});
            meshes.erase(mesh);
        } else if (instances.empty() || what < 8) {
            const OccluderInstance added = random.instance(any(meshes, random)->first, ++tag_);
            OccluderId id = 0;
            host.set.add({&added, 1}, &id);
            instances[id] = added;
        } else if (what < 11) {
            const auto instance = any(instances, random);
            host.set.remove({&instance->first, 1});
            instances.erase(instance);
        } else {
            const auto instance = any(instances, random);
            instance->second = random.instance(any(meshes, random)->first, ++tag_);
            host.set.update({&instance->first, 1}, {&instance->second, 1});
        }
    }
    void giveTo(OccluderHost& host) const
    {
        std::map<OccluderMeshId, OccluderMeshId> ids;
        for (const auto& [id, positions] : meshes) {
            const OccluderMesh mesh = meshOf(positions);
            host.set.addMeshes({&mesh, 1}, &ids[id]);
        }
        for (const auto& [id, given] : instances) {
            OccluderInstance instance = given;
            instance.mesh = ids[instance.mesh];
            OccluderId added = 0;
            host.set.add({&instance, 1}, &added);
        }
    }
    // Returns what a segment crosses, found by a look at all triangles.
    std::vector<Crossing> crossed(const Segment& s, uint32_t layers) const
    {
        std::vector<Crossing> out;
        for (const auto& [id, instance] : instances) {
            if (instance.layers && !(instance.layers & layers))
                continue;
            glm::dmat3 linear;
            glm::dvec3 position;
            for (int row = 0; row < 3; ++row) {
                for (int column = 0; column < 3; ++column)
                    linear[column][row] = float(instance.worldFromMesh[4 * row + column]);
                position[row] = instance.worldFromMesh[4 * row + 3];
            }
            const glm::dmat3 inverse = glm::inverse(linear);
            const Segment local{inverse * (s.from - position), inverse * (s.to - position)};
            const Positions& p = meshes.at(instance.mesh);
            for (size_t i = 0; i < p.size(); i += 3)
                if (crosses(local, {{p[i], p[i + 1], p[i + 2]}}))
                    out.push_back({instance.surfaceError, p[i].x, p[i + 1].y});
        }
        std::ranges::sort(out);
        return out;
    }

private:
    float tag_ = 0;
};

} // namespace

TEST_F(Occluders, EditsLeadToWhatAFreshSetHas)
{
    OccluderHost edited(device_);
    Model model;
    OccluderRandom random(1);
    size_t crossings = 0;
    for (int i = 1; i <= 1000 && !HasFailure(); ++i) {
        model.edit(edited, random);
        if (random.below(3) == 0)
            record(edited);
        if (i % 50)
            continue;
        record(edited);
        OccluderHost fresh(device_);
        model.giveTo(fresh);
        record(fresh);
        EXPECT_EQ(edited.set.instances().count(), model.instances.size());
        for (int segment = 0; segment < 100; ++segment) {
            const Segment s = random.segment();
            const uint32_t layers = 1 + random.below(3);
            const std::vector<Crossing> expected = model.crossed(s, layers);
            EXPECT_EQ(edited.crossed(s, layers), expected) << i;
            EXPECT_EQ(fresh.crossed(s, layers), expected) << i;
            crossings += expected.size();
        }
    }
    EXPECT_GT(crossings, 1000u);
}

// Instances move without additions, until their tree is made anew: both before and after.
TEST_F(Occluders, InstancesThatMoveAreFound)
{
    OccluderHost host(device_);
    Model model;
    OccluderRandom random(2);
    model.addMesh(host, random);
    for (int i = 0; i < 300; ++i) {
        const OccluderInstance added = random.instance(model.meshes.begin()->first, float(i));
        OccluderId id = 0;
        host.set.add({&added, 1}, &id);
        model.instances[id] = added;
    }
    record(host);
    const glm::dvec3 origin = host.set.instances().origin();
    bool madeAnew = false;
    for (int round = 0; round < 40 && !HasFailure(); ++round) {
        for (auto& [id, instance] : model.instances) {
            for (int row = 0; row < 3; ++row)
                instance.worldFromMesh[4 * row + 3] += random.number(-2, 2);
            host.set.update({&id, 1}, {&instance, 1});
        }
        record(host);
        madeAnew |= host.set.instances().origin() != origin;
        for (int segment = 0; segment < 20; ++segment) {
            const Segment s = random.segment();
            EXPECT_EQ(host.crossed(s, 3), model.crossed(s, 3));
        }
    }
    EXPECT_TRUE(madeAnew);
}

// Instances that change places within the same outermost box.
TEST_F(Occluders, ATreeWhoseBoxesHaveGrownInsideIsMadeAnew)
{
    OccluderHost host(device_);
    OccluderRandom random(4);
    const Positions positions = random.positions(10);
    const OccluderMesh mesh = meshOf(positions);
    OccluderMeshId meshId = 0;
    host.set.addMeshes({&mesh, 1}, &meshId);
    std::vector<OccluderInstance> instances;
    for (int i = 0; i < 200; ++i) {
        instances.push_back({.mesh = meshId, .surfaceError = float(i), .layers = 3});
        for (int row = 0; row < 3; ++row)
            instances.back().worldFromMesh[4 * row + row] = 1;
        instances.back().worldFromMesh[3] = 100.0 * i;
    }
    std::vector<OccluderId> ids(instances.size());
    host.set.add(instances, ids.data());
    record(host);
    const auto order = [&] {
        std::vector<float> out;
        for (const gpu::OccluderRecord& r : host.set.instances().records())
            out.push_back(r.surfaceError);
        return out;
    };
    const std::vector<float> first = order();
    for (size_t i = 1; i < 100; ++i) // the first and the last stay where they are
        std::swap(instances[i].worldFromMesh[3], instances[199 - i].worldFromMesh[3]);
    for (size_t i = 1; i < 199; i += 2) // half of them move
        host.set.update({&ids[i], 1}, {&instances[i], 1});
    record(host);
    EXPECT_NE(order(), first);
}

TEST_F(Occluders, OnlyWhatHasChangedIsUploaded)
{
    OccluderHost host(device_);
    OccluderRandom random(3);
    const Positions small = random.positions(10), large = random.positions(20000);
    const OccluderMesh meshes[] = {meshOf(small), meshOf(large)};
    OccluderMeshId meshIds[2];
    host.set.addMeshes(meshes, meshIds);
    std::vector<OccluderInstance> instances;
    for (int i = 0; i < 5000; ++i)
        instances.push_back(random.instance(meshIds[0], 0));
    std::vector<OccluderId> ids(instances.size());
    host.set.add(instances, ids.data());
    EXPECT_TRUE(host.set.isChanged());
    const auto bytesOfRecording = [&] {
        host.record(MockVulkan::commandBuffer(), unmoved);
        const size_t bytes = copiedBytes();
        vulkan_.finish(vulkan_.submit());
        return bytes;
    };
    EXPECT_GT(bytesOfRecording(), 20000 * sizeof(gpu::OccluderTriangle));
    EXPECT_FALSE(host.set.isChanged());
    EXPECT_EQ(bytesOfRecording(), 0u);
    // One record, and the boxes above it.
    host.set.update({&ids[99], 1}, {&instances[98], 1});
    EXPECT_LE(bytesOfRecording(), 20u * 4096);
    host.set.remove({&ids[99], 1});
    EXPECT_LE(bytesOfRecording(), 2u * 4096);
    const Positions moved = random.positions(20000);
    host.set.replacePositions(meshIds[1], &moved[0].x, 0);
    const size_t triangles = 20000 * sizeof(gpu::OccluderTriangle);
    EXPECT_LT(bytesOfRecording(), triangles + 40000 * sizeof(gpu::OccluderNode));
}

TEST_F(Occluders, PositionsMayHaveAStrideAndIndices)
{
    OccluderHost host(device_);
    const float vertices[][5] = {{-0.f, 0, 0, 9, 9}, {1, -0.f, 0, 9, 9}, {0, 1, 0, 9, 9}};
    const uint32_t indices[] = {2, 0, 1};
    const OccluderMesh mesh{.positions = vertices[0],
                            .stride = 20,
                            .vertexCount = 3,
                            .indices = indices,
                            .triangleCount = 1};
    OccluderMeshId id = 0;
    host.set.addMeshes({&mesh, 1}, &id);
    EXPECT_GE(id, uint64_t(1) << 32);
    const gpu::OccluderTriangle& t = host.set.meshes().allTriangles()[0];
    EXPECT_EQ(t.corners[0], glm::vec3(0, 1, 0));
    EXPECT_FALSE(std::signbit(t.corners[1].x)) << "-0 is stored as +0";
    EXPECT_FALSE(std::signbit(t.corners[2].y));
}

TEST_F(Occluders, MemoryOfRemovedMeshesIsUsedAgain)
{
    OccluderHost host(device_, 100);
    OccluderRandom random(4);
    const Positions positions[] = {random.positions(30), random.positions(20)};
    const OccluderMesh meshes[] = {meshOf(positions[0]), meshOf(positions[1])};
    const gpu::Buffer& triangles = host.set.meshes().triangles();
    const VkBuffer buffer = triangles.get();
    OccluderMeshId ids[2];
    for (int i = 0; i < 200; ++i) {
        host.set.addMeshes(meshes, ids);
        if (i % 3)
            record(host);
        host.set.removeMeshes({&ids[i % 2], 1});
        host.set.removeMeshes({&ids[1 - i % 2], 1});
    }
    EXPECT_EQ(triangles.get(), buffer);
    EXPECT_EQ(triangles.size, 100 * sizeof(gpu::OccluderTriangle));
}

// Columns of any length, at right angles or nearly so, mirrored or not.
TEST_F(Occluders, TransformsMayStretchAndMirror)
{
    OccluderHost host(device_);
    OccluderRandom random(5);
    const Positions positions = random.positions(10);
    const OccluderMesh mesh = meshOf(positions);
    OccluderMeshId meshId = 0;
    host.set.addMeshes({&mesh, 1}, &meshId);
    const OccluderInstance instance{
        .mesh = meshId, .worldFromMesh = {1e-15, 0, 0, 1e15, 0, 1e15, 0.3, 0, 0, 0, -1, 0}};
    OccluderId id = 0;
    host.set.add({&instance, 1}, &id);
    record(host);
    EXPECT_TRUE(
        std::isfinite(lighting::halfSurface(lighting::boxOf(host.set.instances().nodes()[0]))));
}

} // namespace candelabra::test
