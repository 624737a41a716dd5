// SPDX-License-Identifier: Apache-2.0
#include "truth/reference_scene.h"

#include <algorithm>
#include <cmath>

#include <fmt/format.h>

#include "io/hash.h"
#include "scene/fit_camera.h"
#include "scene/shadow_casters.h"

namespace candelabra::app
{

namespace
{

reference::Material toReference(const Material& m)
{
    if (m.unlit)
        return {.emission = m.emission};
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

void add(Hash& hash, const reference::Triangle& triangle)
{
    for (size_t i = 0; i < 3; ++i) {
        add(hash, triangle.corners[i]);
        add(hash, triangle.normals[i]);
    }
    hash.add(triangle.material);
    hash.add(triangle.occluderLayer);
    hash.add(triangle.twoSided);
    hash.add(triangle.blocks);
}

bool isSeen(const Material& m)
{
    return m.alphaMode == AlphaMode::Opaque ||
           m.alpha >= (m.alphaMode == AlphaMode::Mask ? m.alphaCutoff : 0.5f);
}

void addTriangles(const Scene& scene, const Instance& instance,
                  std::vector<reference::Triangle>& out)
{
    const Material& material = scene.materials[instance.material];
    const glm::dmat4& world = instance.worldFromObject;
    const double determinant = glm::determinant(glm::dmat3(world));
    if (!std::isnormal(determinant) || !isSeen(material))
        return;
    const glm::dmat3 normalMatrix = glm::transpose(glm::inverse(glm::dmat3(world)));
    const Mesh& mesh = scene.meshes[instance.mesh];
    for (size_t i = 0; i + 2 < mesh.indices.size(); i += 3) {
        reference::Triangle triangle{.material = instance.material,
                                     .occluderLayer = instance.occluderLayer,
                                     .twoSided = material.doubleSided,
                                     .blocks = castsShadow(scene, material, mesh, i / 3)};
        for (size_t k = 0; k < 3; ++k) {
            // Mirroring turns the order of corners.
            const size_t corner = determinant < 0 ? 2 - k : k;
            const Vertex& vertex = mesh.vertices[mesh.indices[i + k]];
            triangle.corners[corner] = glm::dvec3(world * glm::dvec4(vertex.position, 1));
            const glm::dvec3 normal = normalMatrix * glm::dvec3(vertex.normal);
            const double length = glm::length(normal);
            triangle.normals[corner] = length > 0 ? normal / length : glm::dvec3(0);
        }
        out.push_back(triangle);
    }
}

} // namespace

reference::Scene toReference(const Scene& scene, const Camera& camera, double imageAspect,
                             bool lightsVisible, std::vector<uint32_t>* instances)
{
    reference::Scene out;
    const Camera whole = cameraOfPicture(camera, imageAspect);
    out.camera = {.position = whole.position,
                  .forward = whole.forward,
                  .up = whole.up,
                  .verticalFov = whole.verticalFov,
                  .aspect = imageAspect,
                  .orthographicHeight = whole.orthographic ? whole.orthographicHeight : 0};
    for (const Material& material : scene.materials)
        out.materials.push_back(toReference(material));
    for (const AnalyticObject& object : scene.analyticObjects)
        out.objects.push_back({.type = object.type == AnalyticObject::Type::Plane
                                           ? reference::Object::Type::Plane
                                           : reference::Object::Type::Ball,
                               .point = object.point,
                               .normal = object.normal,
                               .radius = object.radius,
                               .material = object.material,
                               .occluderLayer = object.occluderLayer});
    for (uint32_t i = 0; i < scene.instances.size(); ++i) {
        addTriangles(scene, scene.instances[i], out.triangles);
        if (instances)
            instances->resize(out.triangles.size(), i);
    }
    out.lights = lightsShown(scene.lights, camera);
    for (const CndLight& light : out.lights)
        out.ignoredLayers.push_back(light.unshadowed ? ~0u : light.unshadowedBy);
    out.lightOrigin = scene.lightOrigin;
    out.background = scene.background;
    out.lightsVisible = lightsVisible;
    out.lobes = scene.lobes;
    out.energyCompensation = scene.energyCompensation;
    return out;
}

std::vector<std::string> leftOutByReference(const Scene& scene)
{
    size_t textured = 0;
    for (const Instance& instance : scene.instances) {
        const Material& m = scene.materials[instance.material];
        const auto& colours = scene.meshes[instance.mesh].vertices;
        textured +=
            std::ranges::any_of(colours, [](const Vertex& v) { return v.color != glm::vec4(1); }) ||
            std::max({m.baseColorTexture.texture, m.metallicRoughnessTexture.texture,
                      m.normalTexture.texture, m.emissiveTexture.texture}) >= 0;
    }
    std::vector<std::string> out;
    if (textured)
        out.push_back(fmt::format("{} of {} objects have textures or vertex colours, which the "
                                  "truth leaves out",
                                  textured, scene.instances.size()));
    if (scene.environment)
        out.push_back("the truth leaves out the light of the environment");
    return out;
}

uint64_t referenceHash(const reference::Scene& scene, const reference::TruthOptions& options)
{
    Hash hash;
    hash.add(reference::truthVersion);
    hash.add(options.shadows ? 1 + options.seed : 0);
    const reference::Camera& camera = scene.camera;
    for (const glm::dvec3& v :
         {camera.position, camera.forward, camera.up, scene.lightOrigin, scene.background})
        add(hash, v);
    hash.add(camera.verticalFov);
    hash.add(camera.orthographicHeight);
    hash.add(camera.aspect);
    hash.add(scene.lightsVisible);
    hash.add(int(scene.lobes));
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
        hash.add(int(object.type));
        add(hash, object.point);
        add(hash, object.normal);
        hash.add(object.radius);
        hash.add(object.material);
        hash.add(object.occluderLayer);
    }
    hash.add(scene.triangles.size());
    for (const reference::Triangle& triangle : scene.triangles)
        add(hash, triangle);
    hash.add(scene.lights.size());
    for (const CndLight& light : scene.lights)
        add(hash, light);
    hash.add(std::span<const uint32_t>(scene.ignoredLayers));
    return hash.value();
}

} // namespace candelabra::app
