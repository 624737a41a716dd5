// SPDX-License-Identifier: Apache-2.0
#include "truth/reference_scene.h"

#include <algorithm>

#include "io/hash.h"
#include "scene/fit_camera.h"
#include "scene/light_layers.h"
#include "scene/scene_error.h"

namespace candelabra::app
{

namespace
{

reference::Material toReference(const Material& m)
{
    const double roughness = m.perceptualRoughness;
    return {.diffuseAlbedo = glm::dvec3(m.baseColor) * double((1 - m.metalness) * m.diffuseWeight),
            .f0 =
                glm::mix(glm::dvec3(m.dielectricF0), glm::dvec3(m.baseColor), double(m.metalness)),
            .specularWeight = m.specularWeight,
            // The lobe of alpha 0 is not a function. A lobe of alpha 1e-4 looks like a mirror and
            // is the narrowest that reference/direction_domain.h integrates.
            .alpha = std::max(roughness * roughness, 1e-4),
            .emission = m.emission};
}

void add(Hash& hash, const glm::dvec3& v)
{
    for (int i = 0; i < 3; ++i)
        hash.add(v[i]);
}

void add(Hash& hash, const CndLight& light)
{
    hash.add(light.type);
    for (const auto& values :
         {light.position, light.direction, light.emission, light.axisU, light.axisV})
        hash.add(std::span<const float>(values, 3));
    for (const float value :
         {light.radius, light.influenceRadius, light.innerConeAngle, light.outerConeAngle})
        hash.add(value);
    hash.add(light.twoSided);
    if (light.type == CND_LIGHT_POLYGON)
        for (uint32_t i = 0; i < light.polygon->cornerCount; ++i)
            hash.add(std::span<const float>(light.polygon->corners[i], 2));
}

} // namespace

reference::Scene toReference(const Scene& scene, const Camera& camera, double imageAspect,
                             bool lightsVisible)
{
    if (!scene.instances.empty())
        throw SceneError(scene.name +
                         ": has meshes; the exact image can be computed for planes and balls only");
    if (scene.environment)
        throw SceneError(scene.name +
                         ": has an environment; the exact image can be computed for lights only");
    if (camera.orthographic)
        throw SceneError(
            scene.name + ": camera " + camera.name +
            " is orthographic; the exact image can be computed for pinhole cameras only");
    reference::Scene out;
    const Camera whole = cameraOfPicture(camera, imageAspect);
    out.camera = {whole.position, whole.forward, whole.up, whole.verticalFov, imageAspect};
    for (const Material& material : scene.materials)
        out.materials.push_back(toReference(material));
    for (const AnalyticObject& object : scene.analyticObjects)
        out.objects.push_back({.type = object.type == AnalyticObject::Type::Plane
                                           ? reference::Object::Type::Plane
                                           : reference::Object::Type::Ball,
                               .point = object.point,
                               .normal = object.normal,
                               .radius = object.radius,
                               .material = object.material});
    out.lights = lightsShown(scene.lights, camera);
    out.lightOrigin = scene.lightOrigin;
    out.background = scene.background;
    out.lightsVisible = lightsVisible;
    out.lobes = scene.lobes;
    out.energyCompensation = scene.energyCompensation;
    return out;
}

uint64_t referenceHash(const reference::Scene& scene)
{
    Hash hash;
    hash.add(reference::truthVersion);
    const reference::Camera& camera = scene.camera;
    for (const glm::dvec3& v :
         {camera.position, camera.forward, camera.up, scene.lightOrigin, scene.background})
        add(hash, v);
    hash.add(camera.verticalFov);
    hash.add(camera.aspect);
    hash.add(scene.lightsVisible);
    hash.add(static_cast<int>(scene.lobes));
    hash.add(scene.energyCompensation);
    hash.add(scene.materials.size());
    for (const reference::Material& material : scene.materials) {
        add(hash, material.diffuseAlbedo);
        add(hash, material.f0);
        hash.add(material.specularWeight);
        hash.add(material.alpha);
        add(hash, material.emission);
    }
    hash.add(scene.objects.size());
    for (const reference::Object& object : scene.objects) {
        hash.add(static_cast<int>(object.type));
        add(hash, object.point);
        add(hash, object.normal);
        hash.add(object.radius);
        hash.add(object.material);
    }
    hash.add(scene.lights.size());
    for (const CndLight& light : scene.lights)
        add(hash, light);
    return hash.value();
}

} // namespace candelabra::app
