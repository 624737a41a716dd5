// SPDX-License-Identifier: Apache-2.0
#include "generate/field.h"
#include "generate/generators.h"

#include <utility>

namespace candelabra::app
{

Scene generateField(const SceneOptions& options)
{
    const uint32_t count = options.lights.value_or(defaultLightCount);
    checkLightOptions("field", count, options);
    field::Kit kit{};
    kit.builder.scene.name = "field";
    Random random(options.seed);
    field::addMeshes(kit);
    field::addMaterials(kit, random);
    field::addCity(kit, random);
    field::addLandmarks(kit, random);

    Scene& scene = kit.builder.scene;
    // Blue hour: the sky about as bright as the streets.
    scene.background = field::skyLuminance;
    // In the middle of what the default camera sees near by, where precision is wanted most.
    scene.lightOrigin = {0, 0, 1100};
    scene.cameras = {
        makeUprightCamera("terrace", field::cameraPosition, {-0.09, -0.155, -1},
                          glm::radians(46.0)),
        makeUprightCamera("overview", {-1500, 620, 1900}, {0.75, -0.38, -1}, glm::radians(50.0))};
    for (Camera& camera : scene.cameras)
        camera.nearPlane = 0.5;
    addSphereLights(scene, field::lightSites(kit, count, options), options);
    return std::move(kit.builder.scene);
}

} // namespace candelabra::app
