// SPDX-License-Identifier: Apache-2.0
#include "render/scene_upload.h"

#include <algorithm>
#include <cmath>
#include <deque>
#include <map>
#include <numbers>
#include <numeric>
#include <optional>
#include <utility>
#include <vector>

#include "candelabra/glm.hpp"
#include "render/check.h"
#include "scene/shadow_casters.h"

namespace candelabra::app
{
namespace
{

// The half side of the square that stands for a plane, in radii of the scene. An own surface is
// told from others by 2^-21 of that, which is 3e-5 radii.
constexpr double planeReach = 64;

// What the module copies, until it has done so.
struct Occluders {
    std::vector<CndOccluderMesh> meshes;
    std::vector<CndOccluderInstance> instances; // CndOccluderInstance::mesh is an index of `meshes`
    std::deque<std::vector<uint32_t>> indices;
    std::deque<std::vector<glm::vec3>> positions;

    size_t addMesh(const glm::vec3& first, size_t stride, size_t count,
                   const std::vector<uint32_t>& triangles)
    {
        meshes.push_back({.positions = &first.x,
                          .stride = uint32_t(stride),
                          .vertexCount = uint32_t(count),
                          .indices = triangles.data(),
                          .triangleCount = uint32_t(triangles.size() / 3)});
        return meshes.size() - 1;
    }
    size_t addMesh(std::vector<glm::vec3> corners, std::vector<uint32_t> triangles)
    {
        positions.push_back(std::move(corners));
        indices.push_back(std::move(triangles));
        return addMesh(positions.back()[0], sizeof(glm::vec3), positions.back().size(),
                       indices.back());
    }
    CndOccluderInstance& place(size_t mesh, const glm::dmat4& worldFromMesh, uint32_t layer)
    {
        CndOccluderInstance& out = instances.emplace_back();
        out.mesh = mesh;
        out.occluderLayer = layer;
        for (int row = 0; row < 3; ++row)
            for (int column = 0; column < 4; ++column)
                out.worldFromMesh[4 * row + column] = worldFromMesh[column][row];
        return out;
    }
};

// Tells whether the module takes the transform: its columns are not nearly in one plane.
bool isTaken(const glm::dmat4& worldFromMesh)
{
    glm::dmat3 columns(worldFromMesh);
    for (int i = 0; i < 3; ++i) {
        const double length = glm::length(columns[i]);
        if (!(length > 1.01e-15))
            return false;
        columns[i] /= length;
    }
    return std::abs(glm::determinant(columns)) > 1.01e-4;
}

class InstanceOccluders
{
public:
    InstanceOccluders(const Scene& scene, const std::vector<Material>& materials, Occluders& out)
        : scene_(scene), materials_(materials), out_(out)
    {
    }

    void add(const Instance& instance)
    {
        const auto mesh = meshOf(instance);
        if (!mesh)
            return;
        glm::dmat4 placed = instance.worldFromObject;
        if (isTaken(placed)) {
            out_.place(*mesh, placed, instance.occluderLayer);
            return;
        }
        // The transform goes into a mesh of its own, and only its translation is left.
        std::vector<glm::vec3> turned;
        for (const Vertex& vertex : scene_.meshes[instance.mesh].vertices)
            turned.emplace_back(glm::dmat3(placed) * glm::dvec3(vertex.position));
        const CndOccluderMesh& source = out_.meshes[*mesh];
        std::vector<uint32_t> triangles(source.indices, source.indices + 3 * source.triangleCount);
        glm::dmat4 moved(1);
        moved[3] = placed[3];
        out_.place(out_.addMesh(std::move(turned), std::move(triangles)), moved,
                   instance.occluderLayer);
    }

private:
    // The index of the mesh of what casts shadows; none if nothing does.
    std::optional<size_t> meshOf(const Instance& instance)
    {
        // Only with a masked material does it depend on the material which triangles that are.
        const Material& material = materials_[instance.material];
        if (material.alphaMode == AlphaMode::Blend)
            return std::nullopt;
        const bool masked = material.alphaMode == AlphaMode::Mask;
        const auto key = std::pair(instance.mesh, masked ? int64_t{instance.material} : -1);
        if (const auto found = known_.find(key); found != known_.end())
            return found->second;
        const Mesh& mesh = scene_.meshes[instance.mesh];
        const std::vector<uint32_t>* triangles = &mesh.indices;
        if (masked)
            triangles = &castersOf(mesh, material);
        std::optional<size_t> index;
        if (triangles->size() >= 3)
            index = out_.addMesh(mesh.vertices[0].position, sizeof(Vertex), mesh.vertices.size(),
                                 *triangles);
        return known_[key] = index;
    }
    const std::vector<uint32_t>& castersOf(const Mesh& mesh, const Material& material)
    {
        std::vector<uint32_t>& out = out_.indices.emplace_back();
        for (size_t t = 0; 3 * t + 2 < mesh.indices.size(); ++t)
            if (castsShadow(scene_, material, mesh, t))
                out.insert(out.end(),
                           {mesh.indices[3 * t], mesh.indices[3 * t + 1], mesh.indices[3 * t + 2]});
        return out;
    }

    const Scene& scene_;
    const std::vector<Material>& materials_;
    Occluders& out_;
    std::map<std::pair<uint32_t, int64_t>, std::optional<size_t>> known_;
};

// The corners of the triangles of an icosahedron on the unit ball, three each.
std::vector<glm::dvec3> icosahedron()
{
    std::vector<glm::dvec3> corners, out;
    for (int axis = 0; axis < 3; ++axis)
        for (const double a : {-1.0, 1.0})
            for (const double b : {-std::numbers::phi, std::numbers::phi}) {
                glm::dvec3& corner = corners.emplace_back(0);
                corner[axis] = a;
                corner[(axis + 1) % 3] = b;
            }
    const auto areNeighbours = [](const glm::dvec3& a, const glm::dvec3& b) {
        return glm::distance(a, b) < 2.1; // edges are 2 long
    };
    for (size_t i = 0; i < corners.size(); ++i)
        for (size_t j = 0; j < i; ++j)
            for (size_t k = 0; k < j; ++k)
                if (areNeighbours(corners[i], corners[j]) &&
                    areNeighbours(corners[j], corners[k]) && areNeighbours(corners[k], corners[i]))
                    out.insert(out.end(), {corners[i], corners[j], corners[k]});
    for (glm::dvec3& corner : out)
        corner = glm::normalize(corner);
    return out;
}

// Balls are drawn exactly and hide what a mesh of 1,280 triangles hides. Finer meshes take longer:
// lamps in their holders are behind many triangles.
size_t addUnitBall(Occluders& out)
{
    std::vector<glm::dvec3> corners = icosahedron(); // of triangles, three each
    for (int split = 0; split < 3; ++split) {
        std::vector<glm::dvec3> finer;
        for (size_t i = 0; i < corners.size(); i += 3) {
            const glm::dvec3 &a = corners[i], &b = corners[i + 1], &c = corners[i + 2];
            const glm::dvec3 ab = glm::normalize(a + b), bc = glm::normalize(b + c),
                             ca = glm::normalize(c + a);
            finer.insert(finer.end(), {a, ab, ca, ab, b, bc, ca, bc, c, ab, bc, ca});
        }
        corners = std::move(finer);
    }
    std::vector<uint32_t> indices(corners.size());
    std::iota(indices.begin(), indices.end(), 0u);
    return out.addMesh({corners.begin(), corners.end()}, std::move(indices));
}

void addBalls(const Scene& scene, Occluders& out)
{
    std::optional<size_t> mesh;
    for (const AnalyticObject& object : scene.analyticObjects) {
        if (object.type != AnalyticObject::Type::Ball)
            continue;
        if (!mesh)
            mesh = addUnitBall(out);
        glm::dmat4 placed(object.radius);
        placed[3] = glm::dvec4(object.point, 1);
        // The mesh is inside of the ball, so it hides nothing from a point of the ball above whose
        // horizon the light is. Only rounding moves such a point.
        out.place(*mesh, placed, object.occluderLayer).surfaceError = float(1e-4 * object.radius);
    }
}

// A ball around everything but planes: its centre and its radius.
std::pair<glm::dvec3, double> ballAround(const Scene& scene)
{
    Bounds box{glm::dvec3(INFINITY), glm::dvec3(-INFINITY)};
    const auto include = [&](const glm::dvec3& centre, double radius) {
        box.min = glm::min(box.min, centre - radius);
        box.max = glm::max(box.max, centre + radius);
    };
    if (!scene.instances.empty()) {
        const Bounds meshes = sceneBounds(scene);
        include(meshes.min, 0);
        include(meshes.max, 0);
    }
    for (const AnalyticObject& object : scene.analyticObjects)
        include(object.point, object.type == AnalyticObject::Type::Ball ? object.radius : 0);
    for (const CndLight& light : scene.lights)
        if (!cndIsDistant(light.type))
            include(scene.lightOrigin + glm::dvec3(toGlm(light.position)),
                    double(cndEmitterBoundingRadius(&light)));
    for (const Camera& camera : scene.cameras)
        include(camera.position, 0);
    return {0.5 * (box.min + box.max), 0.5 * glm::length(box.max - box.min)};
}

void addPlanes(const Scene& scene, Occluders& out)
{
    std::optional<size_t> mesh;
    const auto [centre, radius] = ballAround(scene);
    for (const AnalyticObject& object : scene.analyticObjects) {
        if (object.type != AnalyticObject::Type::Plane || !(radius > 0))
            continue;
        if (!mesh)
            mesh =
                out.addMesh({{-1, 0, -1}, {-1, 0, 1}, {1, 0, 1}, {1, 0, -1}}, {0, 1, 2, 0, 2, 3});
        const glm::dvec3& up = object.normal;
        const glm::dvec3 other = std::abs(up.x) < 0.5 ? glm::dvec3(1, 0, 0) : glm::dvec3(0, 0, 1);
        const glm::dvec3 x = glm::normalize(glm::cross(up, other)), z = glm::cross(x, up);
        const double side = planeReach * radius;
        const glm::dvec3 foot = centre - glm::dot(centre - object.point, up) * up;
        out.place(*mesh,
                  glm::dmat4(glm::dvec4(side * x, 0), glm::dvec4(side * up, 0),
                             glm::dvec4(side * z, 0), glm::dvec4(foot, 1)),
                  object.occluderLayer);
    }
}

} // namespace

void addOccluders(Lighting& lighting, const Scene& scene, const std::vector<Material>& materials)
{
    Occluders out;
    InstanceOccluders instances(scene, materials, out);
    for (const Instance& instance : scene.instances)
        instances.add(instance);
    addBalls(scene, out);
    addPlanes(scene, out);
    if (out.instances.empty())
        return;
    std::vector<CndOccluderMeshId> meshes(out.meshes.size());
    valueOrThrow(lighting.addOccluderMeshes(out.meshes, meshes));
    for (CndOccluderInstance& instance : out.instances)
        instance.mesh = meshes[instance.mesh];
    std::vector<CndOccluderId> ids(out.instances.size());
    valueOrThrow(lighting.addOccluders(out.instances, ids));
}

} // namespace candelabra::app
