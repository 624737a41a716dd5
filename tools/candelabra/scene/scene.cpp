// SPDX-License-Identifier: Apache-2.0
#include "scene/scene.h"

#include <algorithm>
#include <array>
#include <cassert>
#include <cmath>
#include <iterator>

#include "scene/mesh_bounds.h"

namespace candelabra::app
{

Bounds meshBounds(const Mesh& mesh)
{
    if (mesh.vertices.empty())
        return {};
    glm::vec3 low = mesh.vertices.front().position, high = low;
    for (const Vertex& vertex : mesh.vertices) {
        low = glm::min(low, vertex.position);
        high = glm::max(high, vertex.position);
    }
    return {glm::dvec3(low), glm::dvec3(high)};
}

Bounds transformBounds(const Bounds& bounds, const glm::dmat4& worldFromObject)
{
    const glm::dvec3 centre = 0.5 * (bounds.min + bounds.max);
    const glm::dvec3 half = 0.5 * (bounds.max - bounds.min);
    const glm::dvec3 middle(worldFromObject * glm::dvec4(centre, 1));
    glm::dvec3 reach(0);
    for (int column = 0; column < 3; ++column)
        reach += glm::abs(glm::dvec3(worldFromObject[column])) * half[column];
    return {middle - reach, middle + reach};
}

glm::vec3 meanOfSrgb(const Texture& texture)
{
    std::array<double, 256> linear; // IEC 61966-2-1
    for (size_t i = 0; i < linear.size(); ++i) {
        const double x = double(i) / 255;
        linear[i] = x <= 0.04045 ? x / 12.92 : std::pow((x + 0.055) / 1.055, 2.4);
    }
    glm::dvec3 sum{0};
    for (size_t i = 0; i < texture.rgba.size(); i += 4)
        for (size_t c = 0; c < 3; ++c)
            sum[int(c)] += linear[texture.rgba[i + c]];
    return glm::vec3(sum / (double(texture.rgba.size()) / 4));
}

bool hasDiffuseOnlySurfaces(const Scene& scene, const std::vector<Material>& materials)
{
    std::vector<bool> used(materials.size());
    for (const Instance& instance : scene.instances)
        used[instance.material] = true;
    for (const AnalyticObject& object : scene.analyticObjects)
        used[object.material] = true;
    for (size_t i = 0; i < materials.size(); ++i) {
        const Material& m = materials[i];
        if (!used[i] || m.unlit)
            continue;
        if (m.specularWeight == 0 && m.dielectricF0 == glm::vec3(0) && m.metalness == 0)
            return true;
    }
    return false;
}

Bounds sceneBounds(const Scene& scene)
{
    std::vector<Bounds> meshBoxes;
    for (const Mesh& mesh : scene.meshes)
        meshBoxes.push_back(meshBounds(mesh));
    Bounds all;
    bool first = true;
    for (const Instance& instance : scene.instances) {
        if (scene.meshes[instance.mesh].vertices.empty())
            continue;
        const Bounds box = transformBounds(meshBoxes[instance.mesh], instance.worldFromObject);
        all.min = first ? box.min : glm::min(all.min, box.min);
        all.max = first ? box.max : glm::max(all.max, box.max);
        first = false;
    }
    return all;
}

namespace
{

void move(CndLight& light, const LightMotion& motion, double time)
{
    if (cndIsDistant(light.type))
        return; // it has no position
    // The angle is a double until its sine and cosine are taken, so that the motion stays smooth
    // after hours.
    const double angle = motion.phase + double(motion.angularSpeed) * time;
    const float c = float(std::cos(angle));
    const float s = float(std::sin(angle));
    for (int axis = 0; axis < 3; ++axis)
        light.position[axis] += motion.axisU[axis] * c + motion.axisV[axis] * s;
}

} // namespace

bool isShown(const CndLight& light, const Camera& camera)
{
    return !light.layers || !camera.layers || light.layers & camera.layers;
}

std::vector<CndLight> lightsShown(const std::vector<CndLight>& lights, const Camera& camera)
{
    std::vector<CndLight> shown;
    std::ranges::copy_if(lights, std::back_inserter(shown),
                         [&](const CndLight& light) { return isShown(light, camera); });
    return shown;
}

CndLight lightAtTime(const Scene& scene, size_t light, double time)
{
    CndLight out = scene.lights[light];
    if (light < scene.lightMotions.size())
        move(out, scene.lightMotions[light], time);
    return out;
}

void lightsAtTime(const Scene& scene, double time, std::vector<CndLight>& out)
{
    out = scene.lights;
    for (size_t i = 0; i < scene.lightMotions.size() && i < out.size(); ++i)
        move(out[i], scene.lightMotions[i], time);
}

void placeLights(Scene& scene, const std::vector<glm::dvec3>& worldPositions)
{
    assert(worldPositions.size() == scene.lights.size());
    constexpr double nearOrigin = 1024; // metres
    glm::dvec3 low{0}, high{0};
    bool first = true;
    for (size_t i = 0; i < worldPositions.size(); ++i) {
        if (cndIsDistant(scene.lights[i].type))
            continue;
        low = first ? worldPositions[i] : glm::min(low, worldPositions[i]);
        high = first ? worldPositions[i] : glm::max(high, worldPositions[i]);
        first = false;
    }
    const glm::dvec3 extent = glm::max(glm::abs(low), glm::abs(high));
    const bool isNear = extent.x <= nearOrigin && extent.y <= nearOrigin && extent.z <= nearOrigin;
    scene.lightOrigin = isNear ? glm::dvec3(0) : 0.5 * (low + high);
    for (size_t i = 0; i < worldPositions.size(); ++i)
        for (int k = 0; k < 3 && !cndIsDistant(scene.lights[i].type); ++k)
            scene.lights[i].position[k] = float(worldPositions[i][k] - scene.lightOrigin[k]);
}

} // namespace candelabra::app
