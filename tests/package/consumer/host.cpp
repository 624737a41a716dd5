// SPDX-License-Identifier: Apache-2.0
// Calls the C++ interface without a device, in C++17 and in C++20: all of it must compile, and
// arrays, vectors and initializer lists must be taken as elements.
#include <candelabra/candelabra.hpp>
#include <cstdio>
#include <vector>

// Instantiates what needs a device to be called.
[[maybe_unused]] static bool draw(candelabra::Lighting& lighting, candelabra::LightingView& view,
                                  candelabra::Environment& environment,
                                  candelabra::Exposure& exposure)
{
    std::vector<CndLight> lights(1);
    std::vector<CndLightId> ids(1);
    const std::vector<uint8_t> weights(1);
    const std::vector<CndOccluderMesh> meshes(1);
    const std::vector<CndDevicePositions> positions(1);
    const std::vector<CndOccluderInstance> instances(1);
    return lighting.setLights(lights, {0, 0, 0}) && lighting.addLights(lights, ids) &&
           lighting.addLight(lights[0]) && lighting.updateLights({&ids[0], 1}, {&lights[0], 1}) &&
           lighting.removeLights(ids) && lighting.addOccluderMeshes(meshes, ids) &&
           lighting.addOccluderMesh(meshes[0]) &&
           lighting.replaceOccluderPositions(ids[0], nullptr) &&
           lighting.replaceOccluderPositionsOnDevice(positions) &&
           lighting.addOccluders(instances, ids) && lighting.addOccluder(instances[0]) &&
           lighting.updateOccluders(ids, instances) && lighting.removeOccluders(ids) &&
           lighting.removeOccluderMeshes(ids) && view.record(nullptr, {}) && view.stats(0) &&
           view.recordOverlay(nullptr, {}, {}) && environment.record(nullptr, {}) &&
           environment.recordMap(nullptr, {}) && exposure.setMask(weights, 1, 1) &&
           exposure.record(nullptr, {}) && exposure.stats(0);
}

int main()
{
    const std::array<float, 3> corners[] = {{0, 2, 0}, {1, 2, 0}, {1.5f, 2, 1}, {0, 2, 1}};
    CndLight window{};
    CndPolygon polygon{};
    if (!candelabra::polygonFromCorners(corners, window, polygon))
        return 1;
    std::array<CndLightingViewDesc, 2> views{};
    if (candelabra::Lighting::plan({}, {}, views) || candelabra::Lighting::plan({}, {}))
        return 2;
    auto lighting = candelabra::Lighting::create({}, {});
    auto exposure = candelabra::Exposure::create({}, {});
    auto environment = candelabra::Environment::create({}, {});
    if (lighting || exposure || environment || lighting.error().message[0] == 0)
        return 3;
    std::puts(lighting.error().message);
    return candelabra::luminousPowerOfLight(window) ? 0 : 4;
}
