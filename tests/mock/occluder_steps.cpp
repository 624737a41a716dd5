// SPDX-License-Identifier: Apache-2.0
// Steps of a host that gives a module occluders, edits them and records shadows.
#include "mock/host_steps.h"

namespace candelabra::test
{
namespace
{

// Each number needs larger buffers than the one before.
constexpr uint32_t fewTriangles = 2, manyTriangles = 1000, fewOccluders = 2, manyOccluders = 700;

// Static, so that nothing of it is allocated while the heap fails.
struct OccluderInputs {
    float positions[9 * manyTriangles];
    CndOccluderInstance instances[manyOccluders];
    CndOccluderId ids[fewOccluders + manyOccluders];
    CndOccluderMeshId largeMesh;
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

CndResult addMesh(Host& h, uint32_t triangles, CndOccluderMeshId* id, CndError* error)
{
    const CndOccluderMesh mesh{.positions = occluderInputs().positions,
                               .vertexCount = 3 * triangles,
                               .triangleCount = triangles};
    return cndAddOccluderMeshes(h.lighting, 1, &mesh, id, error);
}

CndResult addOccluders(Host& h, uint32_t first, uint32_t count, CndError* error)
{
    OccluderInputs& in = occluderInputs();
    for (CndOccluderInstance& instance : in.instances)
        instance.mesh = h.occluderMesh;
    const CndResult result =
        cndAddOccluders(h.lighting, count, in.instances, in.ids + first, error);
    if (result == CND_SUCCESS)
        h.occluderCount += count;
    return result;
}

CndResult recordShadows(Host& h, CndError* error)
{
    auto frame = surfacesOf<CndLightingFrame>();
    frame.countPairs = VK_TRUE;
    frame.shadowImage = MockVulkan::imageView();
    return cndRecordLighting(h.view, MockVulkan::commandBuffer(), &frame, error);
}

// Creates a module with shadows, a view, and lights.
std::vector<Step> shadowCreationSteps()
{
    return {
        {"create lighting", false,
         [](Host& h, CndError* error) {
             h.lightCount = h.occluderCount = 0;
             const CndLightingDesc desc{.structSize = sizeof desc,
                                        .framesInFlight = 1,
                                        .shading =
                                            CND_SHADING_CLUSTERED_BIT | CND_SHADING_COUNT_PAIRS_BIT,
                                        .forwardStages = VK_SHADER_STAGE_FRAGMENT_BIT,
                                        .lightTypes = 1u << CND_LIGHT_POLYGON,
                                        .shadows = {.points = 64}};
             return cndCreateLighting(&h.device, &desc, &h.lighting, error);
         }},
        {"create view", false,
         [](Host& h, CndError* error) {
             const CndLightingViewDesc desc{.structSize = sizeof desc,
                                            .maxWidth = 64,
                                            .maxHeight = 48,
                                            .listBudget = 1 << 16,
                                            .shadowBudget = 1 << 16};
             return cndCreateLightingView(h.lighting, &desc, &h.view, error);
         }},
        {"add lights", false,
         [](Host& h, CndError* error) {
             static constexpr CndPolygon polygon{3, {{-1, -1}, {1, -1}, {0, 1}}};
             const CndLight lights[] = {
                 {.type = CND_LIGHT_SPHERE, .radius = 0.1f, .influenceRadius = 5},
                 {.type = CND_LIGHT_POLYGON,
                  .influenceRadius = 5,
                  .axisU = {0.5f, 0, 0},
                  .axisV = {0, 0.5f, 0},
                  .polygon = &polygon,
                  .unshadowedBy = 1},
                 {.type = CND_LIGHT_DISTANT_SPHERE, .radius = 0.1f, .direction = {0, -1, 0}}};
             CndLightId ids[3];
             const CndResult result = cndAddLights(h.lighting, 3, lights, ids, error);
             if (result == CND_SUCCESS)
                 h.lightCount = 3;
             return result;
         }},
    };
}

// Both meshes from buffers on the device.
CndResult useDevicePositions(Host& h, VkDeviceSize offset, CndError* error)
{
    const CndDevicePositions positions[] = {
        {.mesh = h.occluderMesh, .buffer = MockVulkan::hostBuffer(), .offset = offset},
        {.mesh = occluderInputs().largeMesh, .buffer = MockVulkan::hostBuffer(), .stride = 32}};
    return cndReplaceOccluderPositionsOnDevice(h.lighting, 2, positions, error);
}

// Adds, changes and removes occluders, and records after each.
std::vector<Step> occluderEditSteps()
{
    return {
        {"record without occluders", true, recordShadows},
        {"add mesh", false,
         [](Host& h, CndError* error) { return addMesh(h, fewTriangles, &h.occluderMesh, error); }},
        {"add occluders", false,
         [](Host& h, CndError* error) { return addOccluders(h, 0, fewOccluders, error); }},
        {"record", true, recordShadows},
        {"add a larger mesh", false,
         [](Host& h, CndError* error) {
             return addMesh(h, manyTriangles, &occluderInputs().largeMesh, error);
         }},
        {"add more occluders", false,
         [](Host& h, CndError* error) {
             return addOccluders(h, fewOccluders, manyOccluders, error);
         }},
        {"record more occluders", true, recordShadows},
        {"update occluders", false,
         [](Host& h, CndError* error) {
             return cndUpdateOccluders(h.lighting, 9, occluderInputs().ids,
                                       occluderInputs().instances + 5, error);
         }},
        {"replace positions", false,
         [](Host& h, CndError* error) {
             return cndReplaceOccluderPositions(h.lighting, h.occluderMesh,
                                                occluderInputs().positions + 3, 0, error);
         }},
        {"record what has moved", true, recordShadows},
        // The next call follows an edit that is not recorded yet.
        {"update an occluder", false,
         [](Host& h, CndError* error) {
             return cndUpdateOccluders(h.lighting, 1, occluderInputs().ids,
                                       occluderInputs().instances + 5, error);
         }},
        {"use positions on the device", false,
         [](Host& h, CndError* error) { return useDevicePositions(h, 0, error); }},
        {"record what is on the device", true, recordShadows},
        {"use other positions on the device", false,
         [](Host& h, CndError* error) { return useDevicePositions(h, 1004, error); }},
        {"record what is there now", true, recordShadows},
        {"remove occluders", false,
         [](Host& h, CndError* error) {
             const CndResult result =
                 cndRemoveOccluders(h.lighting, 600, occluderInputs().ids, error);
             if (result == CND_SUCCESS)
                 h.occluderCount -= 600;
             return result;
         }},
        {"remove mesh", false,
         [](Host& h, CndError* error) {
             return cndRemoveOccluderMeshes(h.lighting, 1, &occluderInputs().largeMesh, error);
         }},
        {"record what is left", true, recordShadows},
    };
}

} // namespace

const std::vector<Step>& occluderSteps()
{
    static const std::vector<Step> all = [] {
        (void)occluderInputs();
        std::vector<Step> out = shadowCreationSteps();
        const std::vector<Step> edits = occluderEditSteps();
        out.insert(out.end(), edits.begin(), edits.end());
        return out;
    }();
    return all;
}

} // namespace candelabra::test
