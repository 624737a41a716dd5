// SPDX-License-Identifier: Apache-2.0
#include "scene/fit_camera.h"

#include <algorithm>
#include <cmath>
#include <limits>

namespace candelabra::app
{
namespace
{

// With more vertices than this, all instances together, the corners of bounds represent them.
constexpr size_t mostVertices = 4'000'000;

// Positions of the vertices that triangles use. Files may hold others, anywhere.
std::vector<glm::vec3> usedPositions(const Mesh& mesh)
{
    std::vector<bool> used(mesh.vertices.size());
    for (const uint32_t index : mesh.indices)
        used[index] = true;
    std::vector<glm::vec3> out;
    for (size_t i = 0; i < used.size(); ++i)
        if (used[i])
            out.push_back(mesh.vertices[i].position);
    return out;
}

std::vector<glm::vec3> cornersOf(const std::vector<glm::vec3>& positions)
{
    std::vector<glm::vec3> out;
    if (positions.empty())
        return out;
    glm::vec3 low = positions.front(), high = low;
    for (const glm::vec3& p : positions) {
        low = glm::min(low, p);
        high = glm::max(high, p);
    }
    for (int corner = 0; corner < 8; ++corner)
        out.emplace_back(corner & 1 ? high.x : low.x, corner & 2 ? high.y : low.y,
                         corner & 4 ? high.z : low.z);
    return out;
}

struct Range {
    double low = std::numeric_limits<double>::infinity();
    double high = -std::numeric_limits<double>::infinity();

    void add(double value)
    {
        low = std::min(low, value);
        high = std::max(high, value);
    }
    double middle() const { return 0.5 * (low + high); }
    double length() const { return high - low; }
};

struct Axes {
    glm::dvec3 right, up, forward;

    explicit Axes(const Camera& camera)
        : right(glm::normalize(glm::cross(camera.forward, camera.up))),
          up(glm::normalize(glm::cross(right, camera.forward))),
          forward(glm::normalize(camera.forward))
    {
    }
    glm::dvec3 world(double x, double y, double depth) const
    {
        return x * right + y * up + depth * forward;
    }
};

// One direction of a picture, along its width or its height, in perspective. A point at the offset
// `a` and the depth z is inside the picture of a camera at the offset c and the depth d if
// |a - c| <= slope (z - d). So c - slope d >= a - slope z and -c - slope d >= -a - slope z for all
// points, of which only the largest right sides matter.
struct Wedge {
    double slope;
    double up = -std::numeric_limits<double>::infinity();   // largest a - slope z
    double down = -std::numeric_limits<double>::infinity(); // largest -a - slope z

    void add(double a, double z)
    {
        up = std::max(up, a - slope * z);
        down = std::max(down, -a - slope * z);
    }
    double greatestDepth() const { return -0.5 * (up + down) / slope; }
    // Returns the place where a camera has as much room on one side as on the other.
    double middle() const { return 0.5 * (up - down); }
};

void fitPerspective(const std::vector<glm::dvec3>& points, const Axes& axes, double aspect,
                    Camera& camera)
{
    const double slope = fitShare * std::tan(0.5 * camera.verticalFov);
    Wedge across{slope * aspect}, along{slope};
    Range depth;
    for (const glm::dvec3& p : points) {
        const double z = glm::dot(p, axes.forward);
        across.add(glm::dot(p, axes.right), z);
        along.add(glm::dot(p, axes.up), z);
        depth.add(z);
    }
    double at = std::min(across.greatestDepth(), along.greatestDepth());
    // A single point, or points in a line away from the camera, can be approached without end.
    const double size = std::max(1e-3, 0.01 * depth.length());
    at = std::min(at, depth.low - size);
    camera.position = axes.world(across.middle(), along.middle(), at);
    camera.nearPlane = std::min(camera.nearPlane, 0.5 * (depth.low - at));
    if (camera.farPlane > 0)
        camera.farPlane = std::max(camera.farPlane, 1.01 * (depth.high - at));
}

void fitOrthographic(const std::vector<glm::dvec3>& points, const Axes& axes, double aspect,
                     Camera& camera)
{
    Range x, y, depth;
    for (const glm::dvec3& p : points) {
        x.add(glm::dot(p, axes.right));
        y.add(glm::dot(p, axes.up));
        depth.add(glm::dot(p, axes.forward));
    }
    const double height = std::max(y.length(), x.length() / aspect) / fitShare;
    camera.orthographicHeight = std::max(height, 1e-3);
    const double room = std::max({0.01 * depth.length(), camera.orthographicHeight, 1e-3});
    camera.position = axes.world(x.middle(), y.middle(), depth.low - room);
    camera.nearPlane = std::min(camera.nearPlane, 0.5 * room);
    camera.farPlane = std::max(camera.farPlane, room + 1.01 * depth.length());
}

} // namespace

void visitVertices(const Scene& scene, const InstanceRange& range,
                   const std::function<void(const glm::dvec3&)>& visit)
{
    size_t vertices = 0;
    std::vector<bool> wanted(scene.meshes.size());
    for (size_t i = range.first; i < range.first + range.count; ++i) {
        wanted[scene.instances[i].mesh] = true;
        vertices += scene.meshes[scene.instances[i].mesh].vertices.size();
    }
    std::vector<std::vector<glm::vec3>> positions(scene.meshes.size());
    for (size_t mesh = 0; mesh < scene.meshes.size(); ++mesh)
        if (wanted[mesh]) {
            positions[mesh] = usedPositions(scene.meshes[mesh]);
            if (vertices > mostVertices)
                positions[mesh] = cornersOf(positions[mesh]);
        }
    for (size_t i = range.first; i < range.first + range.count; ++i) {
        const Instance& instance = scene.instances[i];
        for (const glm::vec3& p : positions[instance.mesh])
            visit(glm::dvec3(instance.worldFromObject * glm::dvec4(p, 1)));
    }
}

Camera cameraOfPicture(const Camera& camera, double aspect)
{
    Camera out = camera;
    out.aspect.reset();
    const double wider = camera.aspect ? *camera.aspect / aspect : 1;
    if (wider > 1) { // rather than cutting off the sides, the picture shows more above and below
        out.orthographicHeight *= wider;
        out.verticalFov = 2 * std::atan(wider * std::tan(camera.verticalFov / 2));
    }
    return out;
}

PictureShare pictureShare(const std::vector<glm::dvec3>& points, const Camera& camera,
                          double aspect)
{
    const Camera whole = cameraOfPicture(camera, aspect);
    const Axes axes(whole);
    const double slope = std::tan(0.5 * whole.verticalFov);
    Range across, along; // in half widths and half heights of the picture
    size_t behind = 0, left = 0, right = 0, below = 0, above = 0;
    for (const glm::dvec3& p : points) {
        const glm::dvec3 d = p - whole.position;
        const double z = glm::dot(d, axes.forward);
        const double half = whole.orthographic ? 0.5 * whole.orthographicHeight : slope * z;
        const double x = glm::dot(d, axes.right), y = glm::dot(d, axes.up);
        const double edge = half * aspect;
        behind += z <= 0;
        left += x < -edge;
        right += x > edge;
        below += y < -half;
        above += y > half;
        if (z > 0) {
            across.add(x / edge);
            along.add(y / half);
        }
    }
    const bool outside = left + right + below + above > 0;
    PictureShare out;
    out.isEmpty = std::max({behind, left, right, below, above}) == points.size();
    if (!out.isEmpty && !outside && behind == 0) {
        out.width = 0.5 * across.length();
        out.height = 0.5 * along.length();
    }
    return out;
}

Camera fitCamera(std::vector<glm::dvec3> points, Camera camera, double aspect)
{
    if (points.empty())
        return camera;
    camera = cameraOfPicture(camera, aspect);
    // Far from the origin, differences of positions would lose digits.
    Bounds bounds{points.front(), points.front()};
    for (const glm::dvec3& p : points) {
        bounds.min = glm::min(bounds.min, p);
        bounds.max = glm::max(bounds.max, p);
    }
    const glm::dvec3 middle = 0.5 * (bounds.min + bounds.max);
    for (glm::dvec3& p : points)
        p -= middle;
    const Axes axes(camera);
    if (camera.orthographic)
        fitOrthographic(points, axes, aspect, camera);
    else
        fitPerspective(points, axes, aspect, camera);
    camera.position += middle;
    return camera;
}

Camera fitCamera(const Scene& scene, const InstanceRange& range, const Camera& camera,
                 double aspect)
{
    std::vector<glm::dvec3> points;
    visitVertices(scene, range, [&](const glm::dvec3& p) { points.push_back(p); });
    return fitCamera(std::move(points), camera, aspect);
}

} // namespace candelabra::app
