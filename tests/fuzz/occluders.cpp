// SPDX-License-Identifier: Apache-2.0
// Fuzzes the set of occluders, on the mock driver: an input is a sequence of edits and recordings,
// with raw bytes as positions, indices, transforms and ids.
#include <cmath>
#include <cstring>

#include "fuzz/fuzz_target.h"
#include "harness/occluder_host.h"
#include "mock/mock_vulkan.h"

namespace candelabra::test
{
namespace
{

using lighting::OccluderInstance;
using lighting::OccluderMesh;

// Reads values from the input; zeros after its end.
class Input
{
public:
    Input(const uint8_t* data, size_t size) : data_(data), left_(size) {}
    bool ended() const { return left_ == 0; }
    template <typename T>
    T read()
    {
        T out{};
        const size_t count = std::min(sizeof out, left_);
        std::memcpy(&out, data_, count);
        data_ += count;
        left_ -= count;
        return out;
    }
    uint32_t below(uint32_t end) { return read<uint8_t>() % end; }

private:
    const uint8_t* data_;
    size_t left_;
};

class Edits
{
public:
    explicit Edits(Input input) : input_(input) {}
    void run()
    {
        while (!input_.ended()) {
            const uint64_t number = host_.set.number();
            const uint32_t count = host_.set.instances().count();
            try {
                edit(input_.below(7));
            } catch (const gpu::Failure& failure) {
                require(failure.message.size() > 10, "a failure without a sentence");
                require(failure.message.find('\n') == std::string::npos, "two lines");
                require(host_.set.number() == number, "a failed call has changed something");
                require(host_.set.instances().count() == count, "a failed call has added");
            }
        }
        record();
        require(vulkan_.misuse.empty(), "misuse of Vulkan");
    }

private:
    void edit(uint32_t what)
    {
        if (what == 0)
            addMesh();
        else if (what == 1)
            host_.set.replacePositions(id(meshes_), positions(64, 3).data(), stride());
        else if (what == 2)
            removeMesh();
        else if (what == 3)
            addInstances();
        else if (what == 4)
            update();
        else if (what == 5)
            removeInstances();
        else
            record();
    }
    // Mostly one of these ids, otherwise any number.
    uint64_t id(const std::vector<uint64_t>& ids)
    {
        const uint32_t which = input_.below(16);
        return which < ids.size() ? ids[ids.size() - 1 - which] : input_.read<uint64_t>();
    }
    std::vector<float> positions(uint32_t count, uint32_t stride)
    {
        const bool raw = input_.below(4) == 0;
        std::vector<float> out(size_t(count) * stride);
        for (float& p : out)
            p = raw ? input_.read<float>() : float(input_.read<int8_t>()) / 8;
        return out;
    }
    uint32_t stride() { return input_.below(8) == 0 ? input_.below(12) : 0; }
    void addMesh()
    {
        OccluderMesh mesh{
            .stride = stride(), .vertexCount = input_.below(64), .triangleCount = input_.below(32)};
        if (input_.below(4) == 0)
            mesh.stride = 4 * input_.below(8);
        const std::vector<float> points = positions(mesh.vertexCount, 8);
        std::vector<uint32_t> indices(size_t(3) * mesh.triangleCount);
        for (uint32_t& index : indices)
            index = input_.below(64);
        mesh.positions = points.data();
        if (input_.below(4))
            mesh.indices = indices.data();
        else if (input_.below(4))
            mesh.triangleCount = mesh.vertexCount / 3;
        else
            mesh.triangleCount = input_.read<uint32_t>() | 1u << 29; // too many
        uint64_t added = 0;
        host_.set.addMeshes({&mesh, 1}, &added);
        meshes_.push_back(added);
    }
    void removeMesh()
    {
        const uint64_t mesh = id(meshes_);
        host_.set.removeMeshes({&mesh, 1});
        std::erase(meshes_, mesh);
    }
    OccluderInstance instance()
    {
        OccluderInstance out{.mesh = id(meshes_)};
        const bool raw = input_.below(4) == 0;
        for (double& m : out.worldFromMesh)
            m = raw ? input_.read<double>() : double(input_.read<int8_t>()) / 16;
        for (int axis = 0; axis < 3; ++axis)
            out.worldFromMesh[5 * axis] += raw ? 0 : 20;
        out.surfaceError = raw ? input_.read<float>() : 0;
        out.occluderLayer = input_.below(7);
        out.layers = raw ? input_.read<uint32_t>() : input_.read<uint16_t>();
        return out;
    }
    void addInstances()
    {
        OccluderInstance some[3];
        const uint32_t count = input_.below(4);
        for (OccluderInstance& i : some)
            i = instance();
        uint64_t ids[3];
        host_.set.add({some, count}, ids);
        ids_.insert(ids_.end(), ids, ids + count);
    }
    void update()
    {
        const OccluderInstance with[] = {instance(), instance()};
        const uint64_t ids[] = {id(ids_), id(ids_)};
        const uint32_t count = 1 + input_.below(2);
        host_.set.update({ids, count}, {with, count});
    }
    void removeInstances()
    {
        const uint64_t ids[] = {id(ids_), id(ids_)};
        const uint32_t count = 1 + input_.below(2);
        host_.set.remove({ids, count});
        std::erase_if(ids_, [&](uint64_t i) { return std::count(ids, ids + count, i) != 0; });
    }
    void record()
    {
        constexpr double unmoved[16] = {1, 0, 0, 0, 0, 1, 0, 0, 0, 0, 1, 0, 0, 0, 0, 1};
        host_.record(MockVulkan::commandBuffer(), unmoved);
        vulkan_.finish(vulkan_.submit());
        for (const gpu::OccluderNode& node : host_.set.instances().nodes())
            require(std::isfinite(lighting::halfSurface(lighting::boxOf(node))), "a box");
        host_.crossed({glm::dvec3(-30, 1, 2), glm::dvec3(30, 2, 1)}, 0xFFFF);
    }

    Input input_;
    MockVulkan vulkan_;
    gpu::Device device_{vulkan_.desc(), gpu::lightingModule};
    OccluderHost host_{device_};
    std::vector<uint64_t> meshes_, ids_;
};

} // namespace

Seeds fuzzSeeds()
{
    Seeds seeds(3);
    uint32_t state = 1;
    for (std::string& seed : seeds)
        for (int i = 0; i < 2000; ++i) {
            state = state * 1664525 + 1013904223;
            seed.push_back(char(state >> 24));
        }
    return seeds;
}

} // namespace candelabra::test

extern "C" int LLVMFuzzerTestOneInput(const uint8_t* data, size_t size)
{
    candelabra::test::Edits(candelabra::test::Input(data, size)).run();
    return 0;
}
