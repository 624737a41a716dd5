// SPDX-License-Identifier: Apache-2.0
// Steps of the set of occluders, whose C++ interface throws what the C ABI will report.
#include "harness/occluder_host.h"
#include "mock/host_steps.h"

namespace candelabra::test
{

struct OccluderModule {
    explicit OccluderModule(const CndDeviceDesc& desc) : device(desc, gpu::lightingModule) {}
    gpu::Device device;
    OccluderHost host{device};
};

namespace
{

using lighting::OccluderInstance;
using lighting::OccluderMesh;

// Each number needs larger buffers than the one before.
constexpr uint32_t fewTriangles = 2, manyTriangles = 3000, fewOccluders = 2, manyOccluders = 700;

// Static, so that nothing of it is allocated while the heap fails.
struct OccluderInputs {
    float positions[9 * manyTriangles];
    OccluderInstance instances[manyOccluders];
    lighting::OccluderId ids[fewOccluders + manyOccluders];
    lighting::OccluderMeshId meshes[2];
};
OccluderInputs& occluderInputs()
{
    static OccluderInputs in = [] {
        OccluderInputs out{};
        for (size_t i = 0; i < std::size(out.positions); ++i)
            out.positions[i] = float(i * 7919 % 1000);
        for (size_t i = 0; i < manyOccluders; ++i) {
            out.instances[i].worldFromMesh[3] = double(i % 26);
            for (int axis = 0; axis < 3; ++axis)
                out.instances[i].worldFromMesh[5 * axis] = 1;
        }
        return out;
    }();
    return in;
}

lighting::OccluderSet& occludersOf(Host& h)
{
    return h.occluders->host.set;
}

CndResult addMesh(Host& h, uint32_t which, uint32_t triangles, CndError* error)
{
    const OccluderMesh mesh{.positions = occluderInputs().positions,
                            .vertexCount = 3 * triangles,
                            .triangleCount = triangles};
    return gpu::guard(error, [&] {
        occludersOf(h).addMeshes({&mesh, 1}, &occluderInputs().meshes[which]);
    });
}

CndResult addOccluders(Host& h, uint32_t first, uint32_t count, CndError* error)
{
    for (OccluderInstance& instance : occluderInputs().instances)
        instance.mesh = occluderInputs().meshes[0];
    return gpu::guard(error, [&] {
        occludersOf(h).add(std::span(occluderInputs().instances, count),
                           occluderInputs().ids + first);
        h.occluderCount += count;
    });
}

CndResult recordOccluders(Host& h, CndError*)
{
    constexpr double viewFromWorld[16] = {1, 0, 0, 0, 0, 1, 0, 0, 0, 0, 1, 0, 0, 0, 0, 1};
    h.occluders->host.record(MockVulkan::commandBuffer(), viewFromWorld);
    return CND_SUCCESS;
}

} // namespace

uint32_t Host::countedOccluders() const
{
    return occluders ? occluders->host.set.instances().count() : 0;
}

const std::vector<Step>& occluderSteps()
{
    static const std::vector<Step> all = {
        {"create occluders", false,
         [](Host& h, CndError* error) {
             return gpu::guard(error, [&] {
                 h.occluderCount = 0;
                 h.occluders = std::make_shared<OccluderModule>(h.device);
             });
         }},
        {"add mesh", false,
         [](Host& h, CndError* error) { return addMesh(h, 0, fewTriangles, error); }},
        {"add occluders", false,
         [](Host& h, CndError* error) { return addOccluders(h, 0, fewOccluders, error); }},
        {"record", true, recordOccluders},
        {"add a larger mesh", false,
         [](Host& h, CndError* error) { return addMesh(h, 1, manyTriangles, error); }},
        {"add more occluders", false,
         [](Host& h, CndError* error) {
             return addOccluders(h, fewOccluders, manyOccluders, error);
         }},
        {"record more occluders", true, recordOccluders},
        {"update occluders", false,
         [](Host& h, CndError* error) {
             return gpu::guard(error, [&] {
                 occludersOf(h).update(std::span(occluderInputs().ids, 9),
                                       std::span(occluderInputs().instances + 5, 9));
             });
         }},
        {"replace positions", false,
         [](Host& h, CndError* error) {
             return gpu::guard(error, [&] {
                 occludersOf(h).replacePositions(occluderInputs().meshes[0],
                                                 occluderInputs().positions + 3, 0);
             });
         }},
        {"record what has moved", true, recordOccluders},
        {"remove occluders", false,
         [](Host& h, CndError* error) {
             return gpu::guard(error, [&] {
                 occludersOf(h).remove(std::span(occluderInputs().ids, 600));
                 h.occluderCount -= 600;
             });
         }},
        {"remove mesh", false,
         [](Host& h, CndError* error) {
             return gpu::guard(error, [&] {
                 occludersOf(h).removeMeshes({&occluderInputs().meshes[1], 1});
             });
         }},
        {"record what is left", true, recordOccluders},
    };
    (void)occluderInputs();
    return all;
}

} // namespace candelabra::test
