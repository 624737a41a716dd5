// SPDX-License-Identifier: Apache-2.0
#include "generate/ray_caster.h"

#include <algorithm>
#include <cmath>
#include <limits>
#include <numeric>

#include "scene/mesh_bounds.h"

namespace candelabra::app
{
namespace
{

constexpr uint32_t mostNodesLeft = 64; // of a traversal; 2^32 items need 32 levels
constexpr double far = std::numeric_limits<double>::infinity();
// Balls cast the shadows of meshes. So many of their triangles face a point, and so many boxes are
// on the way to one.
constexpr double ballTriangles = 400;
constexpr uint64_t ballPath = 30;

// lesser() and greater() return the other number if one is NaN, as std::fmin and std::fmax do,
// which are slower, because they are calls.
double lesser(double a, double b)
{
    return a < b || std::isnan(b) ? a : b;
}

double greater(double a, double b)
{
    return a > b || std::isnan(b) ? a : b;
}

// The distance at which the ray enters the box, or infinity if the ray misses the box or enters it
// beyond `nearest`.
double enterBox(const Ray& ray, const glm::dvec3& inverseDirection, const Bounds& box,
                double nearest)
{
    double enter = 0, leave = nearest;
    for (int axis = 0; axis < 3; ++axis) {
        const double a = (box.min[axis] - ray.origin[axis]) * inverseDirection[axis];
        const double b = (box.max[axis] - ray.origin[axis]) * inverseDirection[axis];
        // If the ray runs within a side of the box, 0 * infinity gives NaN.
        enter = greater(enter, lesser(a, b));
        leave = lesser(leave, greater(a, b));
    }
    return enter <= leave ? enter : far;
}

// The distance along a ray in object space, whose direction may have any length, and the
// barycentric coordinates (Moeller and Trumbore 1997). Both sides of the triangle are hit.
struct TriangleHit {
    double distance = far, u = 0, v = 0;
};

TriangleHit hitTriangle(const glm::dvec3& origin, const glm::dvec3& direction, const glm::dvec3& a,
                        const glm::dvec3& b, const glm::dvec3& c)
{
    const glm::dvec3 edge1 = b - a, edge2 = c - a;
    const glm::dvec3 p = glm::cross(direction, edge2);
    const double determinant = glm::dot(edge1, p);
    if (determinant == 0)
        return {};
    const glm::dvec3 s = origin - a;
    const glm::dvec3 q = glm::cross(s, edge1);
    const double u = glm::dot(s, p) / determinant;
    const double v = glm::dot(direction, q) / determinant;
    const double t = glm::dot(edge2, q) / determinant;
    const bool inside = u >= 0 && v >= 0 && u + v <= 1 && t > 0;
    return inside ? TriangleHit{t, u, v} : TriangleHit{};
}

Bounds triangleBounds(const Mesh& mesh, size_t triangle)
{
    const glm::dvec3 a(mesh.vertices[mesh.indices[3 * triangle]].position);
    const glm::dvec3 b(mesh.vertices[mesh.indices[3 * triangle + 1]].position);
    const glm::dvec3 c(mesh.vertices[mesh.indices[3 * triangle + 2]].position);
    return {glm::min(a, glm::min(b, c)), glm::max(a, glm::max(b, c))};
}

bool isInvertible(const glm::dmat4& m)
{
    const double determinant = glm::determinant(glm::dmat3(m));
    return std::isnormal(determinant);
}

} // namespace

// A shaft that many boxes are compared with.
struct TestedShaft : Shaft {
    explicit TestedShaft(const Shaft& shaft) : Shaft(shaft) {}

    // Returns how wide the shaft is where it leaves the box, or nothing if it misses the box. The
    // box is widened by that, so some boxes that it misses count.
    std::optional<double> widthAt(const Bounds& box) const
    {
        const glm::dvec3 middle = 0.5 * (box.min + box.max) - start;
        const glm::dvec3 half = 0.5 * (box.max - box.min);
        const double leaves = (glm::dot(middle, axis) + glm::dot(half, absoluteAxis_)) / length2_;
        if (!(leaves >= 0))
            return std::nullopt;
        const double width = glm::mix(startRadius, endRadius, std::min(leaves, 1.0));
        const bool touches =
            enterBox({start, axis}, inverse_, {box.min - width, box.max + width}, 1) != far;
        return touches ? std::optional(width) : std::nullopt;
    }

private:
    glm::dvec3 inverse_ = 1.0 / axis, absoluteAxis_ = glm::abs(axis);
    double length2_ = glm::dot(axis, axis);
};

namespace
{

// Tells whether the plane of a triangle has the start of the shaft and some of its end on two
// sides. The plane of the surface from which a shaft starts has not.
bool separates(const Shaft& shaft, const Mesh& mesh, size_t triangle)
{
    const auto corner = [&](size_t i) {
        return glm::dvec3(mesh.vertices[mesh.indices[3 * triangle + i]].position);
    };
    const glm::dvec3 normal = glm::cross(corner(1) - corner(0), corner(2) - corner(0));
    const double before = glm::dot(normal, shaft.start - corner(0));
    const double after = before + glm::dot(normal, shaft.axis);
    const double length = glm::length(normal), width = shaft.endRadius * length;
    if (std::abs(before) <= 1e-4 * length * glm::length(shaft.axis))
        return false;
    return before > 0 ? after < width : after > -width;
}

} // namespace

BoxTree::BoxTree(const std::vector<Bounds>& boxes)
{
    order_.resize(boxes.size());
    std::iota(order_.begin(), order_.end(), 0u);
    if (!boxes.empty()) {
        nodes_.reserve(boxes.size());
        build(boxes, 0, uint32_t(boxes.size()));
    }
}

void BoxTree::build(const std::vector<Bounds>& boxes, uint32_t first, uint32_t count)
{
    const size_t self = nodes_.size();
    nodes_.emplace_back();
    Bounds all = boxes[order_[first]], centres{glm::dvec3(far), glm::dvec3(-far)};
    for (uint32_t i = first; i < first + count; ++i) {
        const Bounds& box = boxes[order_[i]];
        all.min = glm::min(all.min, box.min);
        all.max = glm::max(all.max, box.max);
        centres.min = glm::min(centres.min, box.min + box.max);
        centres.max = glm::max(centres.max, box.min + box.max);
    }
    nodes_[self].box = all;
    if (count <= 4) {
        nodes_[self].first = first;
        nodes_[self].count = count;
        return;
    }
    const glm::dvec3 extent = centres.max - centres.min;
    const int axis = extent.x >= extent.y && extent.x >= extent.z ? 0
                     : extent.y >= extent.z                       ? 1
                                                                  : 2;
    const uint32_t half = count / 2;
    std::nth_element(order_.begin() + first, order_.begin() + first + half,
                     order_.begin() + first + count, [&](uint32_t a, uint32_t b) {
                         return boxes[a].min[axis] + boxes[a].max[axis] <
                                boxes[b].min[axis] + boxes[b].max[axis];
                     });
    build(boxes, first, half);
    nodes_[self].first = uint32_t(nodes_.size());
    build(boxes, first + half, count - half);
}

template <typename Visit>
void BoxTree::traverse(const Ray& ray, double& nearest, Visit&& visit) const
{
    if (nodes_.empty())
        return;
    const glm::dvec3 inverseDirection = 1.0 / ray.direction;
    uint32_t stack[mostNodesLeft];
    uint32_t depth = 0;
    stack[depth++] = 0;
    while (depth > 0) {
        const uint32_t index = stack[--depth];
        const Node& node = nodes_[index];
        if (enterBox(ray, inverseDirection, node.box, nearest) == far)
            continue;
        for (uint32_t i = 0; i < node.count; ++i)
            visit(order_[node.first + i], nearest);
        if (node.count == 0) {
            const uint32_t left = index + 1, right = node.first;
            const double toLeft = enterBox(ray, inverseDirection, nodes_[left].box, nearest);
            const double toRight = enterBox(ray, inverseDirection, nodes_[right].box, nearest);
            stack[depth++] = toLeft < toRight ? right : left;
            stack[depth++] = toLeft < toRight ? left : right;
        }
    }
}

template <typename Visit>
uint64_t BoxTree::traverse(const TestedShaft& shaft, Visit&& visit) const
{
    uint64_t tested = 0;
    uint32_t stack[mostNodesLeft];
    uint32_t depth = 0;
    if (!nodes_.empty())
        stack[depth++] = 0;
    for (; depth > 0; ++tested) {
        const uint32_t index = stack[--depth];
        const Node& node = nodes_[index];
        if (!shaft.widthAt(node.box))
            continue;
        for (uint32_t i = 0; i < node.count; ++i)
            visit(order_[node.first + i]);
        if (node.count == 0) {
            stack[depth++] = node.first;
            stack[depth++] = index + 1;
        }
    }
    return tested;
}

RayCaster::RayCaster(const Scene& scene) : scene_(scene), meshTrees_(scene.meshes.size())
{
    std::vector<Bounds> meshBoxes;
    for (const Mesh& mesh : scene.meshes)
        meshBoxes.push_back(meshBounds(mesh));
    std::vector<Bounds> boxes;
    for (uint32_t i = 0; i < scene.instances.size(); ++i) {
        const Instance& instance = scene.instances[i];
        if (scene.meshes[instance.mesh].indices.empty() ||
            !isInvertible(instance.worldFromObject)) {
            continue;
        }
        boxes.push_back(transformBounds(meshBoxes[instance.mesh], instance.worldFromObject));
        instanceIds_.push_back(i);
        objectFromWorld_.push_back(glm::inverse(instance.worldFromObject));
    }
    instances_ = BoxTree(boxes);
}

std::optional<RayHit> RayCaster::cast(const Ray& ray)
{
    RayHit best;
    best.distance = far;
    instances_.traverse(ray, best.distance,
                        [&](uint32_t item, double&) { hitInstance(item, ray, best); });
    for (uint32_t i = 0; i < scene_.analyticObjects.size(); ++i)
        hitAnalytic(i, ray, best);
    if (best.distance == far)
        return std::nullopt;
    best.position = ray.origin + best.distance * ray.direction;
    if (glm::dot(best.normal, ray.direction) > 0)
        best.normal = -best.normal;
    return best;
}

ShaftContents RayCaster::contentsOf(const Shaft& asked, uint32_t ignoredLayers)
{
    const TestedShaft shaft(asked);
    ShaftContents out;
    uint64_t inMeshes = 0;
    out.boxes = instances_.traverse(shaft, [&](uint32_t item) {
        const Instance& instance = scene_.instances[instanceIds_[item]];
        if (scene_.materials[instance.material].alphaMode == AlphaMode::Blend ||
            (ignoredLayers >> instance.occluderLayer & 1))
            return;
        const glm::dmat4& m = objectFromWorld_[item];
        const glm::dmat3 turn(m);
        const double scale = std::cbrt(std::abs(glm::determinant(turn)));
        const TestedShaft local({glm::dvec3(m * glm::dvec4(shaft.start, 1)), turn * shaft.axis,
                                 scale * shaft.startRadius, scale * shaft.endRadius});
        const Mesh& mesh = scene_.meshes[instance.mesh];
        inMeshes += meshTree(instance.mesh).traverse(local, [&](uint32_t triangle) {
            out.triangles += separates(local, mesh, triangle) &&
                             local.widthAt(triangleBounds(mesh, triangle)).has_value();
        });
    });
    out.boxes += inMeshes;
    for (const AnalyticObject& object : scene_.analyticObjects) {
        const double radius = object.radius;
        if (object.type != AnalyticObject::Type::Ball ||
            (ignoredLayers >> object.occluderLayer & 1))
            continue;
        if (const auto width = shaft.widthAt({object.point - radius, object.point + radius})) {
            const double share = std::min(*width / radius, 1.0);
            const auto triangles = uint64_t(ballTriangles * share * share);
            out.triangles += triangles;
            out.boxes += ballPath + triangles;
        }
    }
    return out;
}

const BoxTree& RayCaster::meshTree(uint32_t mesh)
{
    std::optional<BoxTree>& tree = meshTrees_[mesh];
    if (!tree) {
        const Mesh& source = scene_.meshes[mesh];
        std::vector<Bounds> boxes(source.indices.size() / 3);
        for (size_t t = 0; t < boxes.size(); ++t)
            boxes[t] = triangleBounds(source, t);
        tree = BoxTree(boxes);
    }
    return *tree;
}

void RayCaster::hitInstance(uint32_t item, const Ray& ray, RayHit& best)
{
    const Instance& instance = scene_.instances[instanceIds_[item]];
    const Mesh& mesh = scene_.meshes[instance.mesh];
    const glm::dmat4& objectFromWorld = objectFromWorld_[item];
    // The direction is not normalised, so that distances are those along the ray in world space.
    const Ray local{glm::dvec3(objectFromWorld * glm::dvec4(ray.origin, 1)),
                    glm::dvec3(objectFromWorld * glm::dvec4(ray.direction, 0))};
    meshTree(instance.mesh).traverse(local, best.distance, [&](uint32_t triangle, double& nearest) {
        const Vertex& a = mesh.vertices[mesh.indices[3 * triangle]];
        const Vertex& b = mesh.vertices[mesh.indices[3 * triangle + 1]];
        const Vertex& c = mesh.vertices[mesh.indices[3 * triangle + 2]];
        const TriangleHit hit = hitTriangle(local.origin, local.direction, glm::dvec3(a.position),
                                            glm::dvec3(b.position), glm::dvec3(c.position));
        if (hit.distance >= nearest)
            return;
        nearest = hit.distance;
        const glm::dvec3 face = glm::cross(glm::dvec3(b.position) - glm::dvec3(a.position),
                                           glm::dvec3(c.position) - glm::dvec3(a.position));
        best.front = glm::dot(face, local.direction) < 0; // transforms do not mirror
        const glm::dvec3 normal = (1 - hit.u - hit.v) * glm::dvec3(a.normal) +
                                  hit.u * glm::dvec3(b.normal) + hit.v * glm::dvec3(c.normal);
        best.normal = glm::normalize(glm::transpose(glm::dmat3(objectFromWorld)) * normal);
        best.material = instance.material;
        best.object = instanceIds_[item];
        best.analytic = false;
    });
}

void RayCaster::hitAnalytic(uint32_t index, const Ray& ray, RayHit& best) const
{
    const AnalyticObject& object = scene_.analyticObjects[index];
    const glm::dvec3 toObject = object.point - ray.origin;
    double distance = far;
    if (object.type == AnalyticObject::Type::Plane) {
        const double down = -glm::dot(object.normal, ray.direction);
        if (down > 0)
            distance = -glm::dot(object.normal, toObject) / down;
    } else {
        const double along = glm::dot(toObject, ray.direction);
        const glm::dvec3 miss = toObject - along * ray.direction;
        const double rest = object.radius * object.radius - glm::dot(miss, miss);
        distance = rest >= 0 ? along - std::sqrt(rest) : far;
    }
    if (distance > 0 && distance < best.distance) {
        best.distance = distance;
        best.normal = object.type == AnalyticObject::Type::Plane
                          ? object.normal
                          : (distance * ray.direction - toObject) / object.radius;
        best.front = true;
        best.material = object.material;
        best.object = index;
        best.analytic = true;
    }
}

Ray cameraRay(const Camera& camera, uint32_t x, uint32_t y, uint32_t width, uint32_t height)
{
    const glm::dvec3 right = glm::normalize(glm::cross(camera.forward, camera.up));
    const glm::dvec3 up = glm::cross(right, camera.forward);
    const double aspect = camera.aspect.value_or(double(width) / height);
    const double ndcX = 2 * (x + 0.5) / width - 1, ndcY = 1 - 2 * (y + 0.5) / height;
    if (camera.orthographic) {
        const double half = 0.5 * camera.orthographicHeight;
        return {camera.position + half * (ndcX * aspect * right + ndcY * up), camera.forward};
    }
    const double slope = std::tan(0.5 * camera.verticalFov);
    return {camera.position,
            glm::normalize(camera.forward + slope * (ndcX * aspect * right + ndcY * up))};
}

} // namespace candelabra::app
