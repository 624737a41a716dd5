// SPDX-License-Identifier: Apache-2.0
#include "unit/scene_invariants.h"

#include <cmath>

namespace candelabra::test
{

namespace
{

using namespace candelabra::app;

template <typename V>
bool isFinite(const V& v)
{
    for (int i = 0; i < v.length(); ++i)
        if (!std::isfinite(v[i]))
            return false;
    return true;
}

template <typename V>
bool isUnit(const V& v)
{
    return isFinite(v) && std::abs(glm::length(v) - 1) < 1e-3;
}

bool isIn(const glm::vec3& v, float low, float high)
{
    return isFinite(v) && v.x >= low && v.y >= low && v.z >= low && v.x <= high && v.y <= high &&
           v.z <= high;
}

std::string checkMesh(const Mesh& mesh)
{
    if (mesh.vertices.empty() || mesh.indices.empty() || mesh.indices.size() % 3 != 0)
        return "no triangles";
    for (const uint32_t i : mesh.indices)
        if (i >= mesh.vertices.size())
            return "index out of range";
    for (const Vertex& v : mesh.vertices) {
        if (!isFinite(v.position) || !isFinite(v.uv[0]) || !isFinite(v.uv[1]))
            return "vertex not finite";
        if (!isUnit(v.normal) || !isUnit(glm::vec3(v.tangent)) || std::abs(v.tangent.w) != 1)
            return "normal or tangent not unit";
        if (std::abs(glm::dot(v.normal, glm::vec3(v.tangent))) > 1e-2f)
            return "tangent not perpendicular";
        if (!isIn(glm::vec3(v.color), 0, 1) || !(v.color.w >= 0 && v.color.w <= 1))
            return "vertex colour outside 0..1";
    }
    return "";
}

std::string checkMaterial(const Scene& scene, const Material& m)
{
    if (!isIn(m.baseColor, 0, 1) || !isIn(m.dielectricF0, 0, 1) || !isIn(m.emission, 0, 3.4e38f))
        return "colour out of range";
    for (const float x :
         {m.alpha, m.metalness, m.perceptualRoughness, m.diffuseWeight, m.specularWeight})
        if (!(x >= 0 && x <= 1))
            return "factor outside 0..1";
    if (!std::isfinite(m.normalScale) || !std::isfinite(m.alphaCutoff))
        return "scale or cutoff not finite";
    for (const TextureRef* ref :
         {&m.baseColorTexture, &m.metallicRoughnessTexture, &m.normalTexture, &m.emissiveTexture})
        if (ref->texture < -1 || ref->texture >= static_cast<int32_t>(scene.textures.size()) ||
            ref->uvSet > 1 || !isFinite(ref->uRow) || !isFinite(ref->vRow))
            return "texture reference out of range";
    return "";
}

glm::vec3 vec(const float (&v)[3])
{
    return {v[0], v[1], v[2]};
}

std::string checkLight(const CndLight& l)
{
    if (l.type >= CND_LIGHT_TYPE_COUNT)
        return "unknown type";
    const uint32_t fields = cndLightFields(l.type);
    const bool distant = cndIsDistant(l.type);
    if (!isFinite(vec(l.position)) || !isIn(vec(l.emission), 0, 3.4e38f))
        return "position or emission";
    if (fields & CND_LIGHT_FIELD_RADIUS_BIT && !(l.radius > 0 && std::isfinite(l.radius)))
        return "radius";
    if (fields & CND_LIGHT_FIELD_RADIUS_BIT && distant && !(l.radius <= 1))
        return "sine of the angular radius";
    if (fields & CND_LIGHT_FIELD_POLYGON_BIT &&
        (!l.polygon || l.polygon->cornerCount < 3 || l.polygon->cornerCount > CND_MAX_CORNERS))
        return "corners";
    if (!distant && !(l.influenceRadius > cndEmitterBoundingRadius(&l)))
        return "influence radius";
    if (fields & CND_LIGHT_FIELD_DIRECTION_BIT && !isUnit(vec(l.direction)))
        return "direction";
    if (fields & CND_LIGHT_FIELD_AXIS_U_BIT &&
        !(isFinite(vec(l.axisU)) && glm::length(vec(l.axisU)) > 0))
        return "axisU";
    if (fields & CND_LIGHT_FIELD_AXIS_V_BIT) {
        if (!(isFinite(vec(l.axisV)) && glm::length(vec(l.axisV)) > 0))
            return "axisV";
        const glm::vec3 u = glm::normalize(vec(l.axisU)), v = glm::normalize(vec(l.axisV));
        if (!(std::abs(glm::dot(u, v)) <= 1e-3f))
            return "axes not perpendicular";
    }
    if (fields & CND_LIGHT_FIELD_CONE_BIT &&
        !(l.innerConeAngle >= 0 && l.innerConeAngle < l.outerConeAngle &&
          l.outerConeAngle <= 1.5707963267948966))
        return "cone";
    return "";
}

std::string checkCamera(const Camera& c)
{
    if (!isFinite(c.position) || !isUnit(c.forward) || !isUnit(c.up) ||
        std::abs(glm::dot(c.forward, c.up)) > 1e-6)
        return "frame";
    if (!(c.verticalFov > 0 && c.verticalFov < 3.1416) || !(c.orthographicHeight > 0))
        return "lens";
    if (!(c.nearPlane >= 0) || (!c.orthographic && c.nearPlane == 0) ||
        (c.farPlane != 0 && !(c.farPlane > c.nearPlane)) || (c.aspect && !(*c.aspect > 0)))
        return "planes or aspect";
    return "";
}

// Applies `check` to each element; returns the first complaint with the element's index.
template <typename T, typename Check>
std::string each(const char* what, const std::vector<T>& items, Check check)
{
    for (size_t i = 0; i < items.size(); ++i)
        if (const std::string problem = check(items[i]); !problem.empty())
            return std::string(what) + " " + std::to_string(i) + ": " + problem;
    return "";
}

} // namespace

std::string brokenInvariant(const Scene& scene)
{
    const auto instance = [&](const Instance& x) -> std::string {
        if (x.mesh >= scene.meshes.size() || x.material >= scene.materials.size())
            return "mesh or material out of range";
        for (int i = 0; i < 4; ++i)
            if (!isFinite(x.worldFromObject[i]))
                return "transform not finite";
        return glm::determinant(glm::dmat3(x.worldFromObject)) > 0 ? "" : "mirrored or flat";
    };
    const auto texture = [](const Texture& t) -> std::string {
        return t.width && t.height && t.rgba.size() == size_t{t.width} * t.height * 4 ? "" : "size";
    };
    const auto analytic = [&](const AnalyticObject& a) -> std::string {
        return a.material < scene.materials.size() && isFinite(a.point) && isUnit(a.normal) &&
                       a.radius > 0
                   ? ""
                   : "out of range";
    };
    const auto material = [&](const Material& m) { return checkMaterial(scene, m); };
    std::string problems[] = {each("mesh", scene.meshes, checkMesh),
                              each("material", scene.materials, material),
                              each("texture", scene.textures, texture),
                              each("instance", scene.instances, instance),
                              each("analytic object", scene.analyticObjects, analytic),
                              each("light", scene.lights, checkLight),
                              each("camera", scene.cameras, checkCamera)};
    for (const std::string& problem : problems)
        if (!problem.empty())
            return problem;
    if (scene.cameras.empty())
        return "no camera";
    if (!isFinite(scene.lightOrigin) || !isIn(scene.background, 0, 3.4e38f))
        return "light origin or background";
    return "";
}

} // namespace candelabra::test
