// SPDX-License-Identifier: Apache-2.0
#include "load/outside.h"

#include <algorithm>
#include <cmath>
#include <limits>
#include <numeric>
#include <optional>

#include "generate/shapes.h"
#include "scene/mesh_bounds.h"

namespace candelabra::app
{
namespace
{

constexpr int side = 96; // pixels of a picture

enum Face : uint8_t { Nothing, Front, Back };

// A parallel projection along one direction that remembers the nearest face of every pixel.
class Picture
{
public:
    Picture(const glm::dvec3& direction, const Bounds& bounds)
        : forward_(glm::normalize(direction)),
          right_(glm::normalize(glm::cross(
              forward_, std::abs(forward_.y) < 0.99 ? glm::dvec3(0, 1, 0) : glm::dvec3(0, 0, 1)))),
          up_(glm::cross(right_, forward_)),
          middle_(0.5 * (bounds.min + bounds.max)),
          scale_(side / std::max(glm::length(bounds.max - bounds.min), 1e-30)),
          depths_(size_t(side) * side, std::numeric_limits<double>::infinity()),
          faces_(size_t(side) * side, Nothing),
          drawn_(size_t(side) * side)
    {
    }

    // Draws a triangle. `closed`: it is part of a closed surface. Its back is not drawn then,
    // because a front is always nearer, or as near where the surface is flat.
    void draw(const glm::dvec3 (&corners)[3], bool doubleSided, bool closed)
    {
        glm::dvec3 p[3]; // pixels, and depth
        for (int i = 0; i < 3; ++i) {
            const glm::dvec3 at = corners[i] - middle_;
            p[i] = {0.5 * side + scale_ * glm::dot(at, right_),
                    0.5 * side - scale_ * glm::dot(at, up_), scale_ * glm::dot(at, forward_)};
        }
        // Rows go down, so a counter-clockwise triangle has a negative area.
        const double area = cross(p[0], p[1], p[2]);
        if (!(std::abs(area) > 0))
            return;
        const Face face = area < 0 ? Front : Back;
        if (closed && face == Back)
            return;
        const bool drawn = face == Front || doubleSided;
        const auto first = [](double v) { return int(std::clamp(std::ceil(v - 0.5), 0.0, 1e4)); };
        const auto last = [](double v) {
            return int(std::clamp(std::floor(v - 0.5), -1.0, side - 1.0));
        };
        const int left = first(std::min({p[0].x, p[1].x, p[2].x})),
                  rightmost = last(std::max({p[0].x, p[1].x, p[2].x}));
        const int top = first(std::min({p[0].y, p[1].y, p[2].y})),
                  bottom = last(std::max({p[0].y, p[1].y, p[2].y}));
        for (int y = top; y <= bottom; ++y)
            for (int x = left; x <= rightmost; ++x) {
                const glm::dvec3 at(x + 0.5, y + 0.5, 0);
                const double a = cross(p[1], p[2], at) / area, b = cross(p[2], p[0], at) / area;
                if (a < 0 || b < 0 || a + b > 1)
                    continue;
                const double depth = a * p[0].z + b * p[1].z + (1 - a - b) * p[2].z;
                const size_t pixel = size_t(y) * side + size_t(x);
                drawn_[pixel] = drawn_[pixel] || drawn;
                if (depth < depths_[pixel]) {
                    depths_[pixel] = depth;
                    faces_[pixel] = face;
                }
            }
    }

    OutsideView seen() const
    {
        const double all = double(faces_.size());
        return {double(std::ranges::count(drawn_, true)) / all,
                double(std::ranges::count(faces_, Front)) / all,
                double(std::ranges::count(faces_, Back)) / all};
    }

private:
    static double cross(const glm::dvec3& a, const glm::dvec3& b, const glm::dvec3& c)
    {
        return (b.x - a.x) * (c.y - a.y) - (b.y - a.y) * (c.x - a.x);
    }

    glm::dvec3 forward_, right_, up_, middle_;
    double scale_; // pixels per metre
    std::vector<double> depths_;
    std::vector<Face> faces_;
    std::vector<bool> drawn_;
};

// Returns the box around a mesh.
Mesh boxAround(const Mesh& mesh)
{
    const Bounds bounds = meshBounds(mesh);
    Mesh box = makeBox(); // around the origin, with edges of length 1
    for (Vertex& vertex : box.vertices)
        vertex.position = glm::vec3(0.5 * (bounds.min + bounds.max) +
                                    glm::dvec3(vertex.position) * (bounds.max - bounds.min));
    return box;
}

// Returns for each mesh the box that is drawn in its place, or nothing if the mesh itself is drawn:
// the meshes with the fewest triangles in all their instances are drawn, as long as these are not
// more than seenFromOutside() draws, and so are meshes that are no larger than a box.
std::vector<std::optional<Mesh>> boxesInPlaceOfMeshes(const Scene& scene, uint64_t most)
{
    uint64_t once = 0;
    for (const Mesh& mesh : scene.meshes)
        once += mesh.indices.size() / 3;
    most = std::max(most, once);
    std::vector<uint64_t> triangles(scene.meshes.size()); // in all instances
    for (const Instance& instance : scene.instances)
        triangles[instance.mesh] += scene.meshes[instance.mesh].indices.size() / 3;
    std::vector<size_t> order(scene.meshes.size());
    std::iota(order.begin(), order.end(), size_t{0});
    std::ranges::stable_sort(order,
                             [&](size_t a, size_t b) { return triangles[a] < triangles[b]; });
    std::vector<std::optional<Mesh>> out(scene.meshes.size());
    uint64_t sum = 0;
    for (const size_t mesh : order) {
        sum += triangles[mesh];
        if (sum <= most)
            continue;
        Mesh box = boxAround(scene.meshes[mesh]);
        if (box.indices.size() < scene.meshes[mesh].indices.size())
            out[mesh] = std::move(box);
    }
    return out;
}

} // namespace

std::vector<OutsideView> seenFromOutside(const Scene& scene,
                                         const std::vector<glm::dvec3>& directions, uint64_t most)
{
    const Bounds bounds = sceneBounds(scene);
    std::vector<Picture> pictures;
    for (const glm::dvec3& direction : directions)
        pictures.emplace_back(direction, bounds);
    const std::vector<std::optional<Mesh>> boxes = boxesInPlaceOfMeshes(scene, most);
    std::vector<glm::dvec3> positions;
    for (const Instance& instance : scene.instances) {
        const std::optional<Mesh>& box = boxes[instance.mesh];
        const Mesh& mesh = box ? *box : scene.meshes[instance.mesh];
        positions.clear();
        for (const Vertex& vertex : mesh.vertices)
            positions.emplace_back(instance.worldFromObject * glm::dvec4(vertex.position, 1));
        const bool doubleSided = scene.materials[instance.material].doubleSided;
        for (size_t i = 0; i + 2 < mesh.indices.size(); i += 3) {
            const glm::dvec3 corners[3] = {positions[mesh.indices[i]],
                                           positions[mesh.indices[i + 1]],
                                           positions[mesh.indices[i + 2]]};
            for (Picture& picture : pictures)
                picture.draw(corners, doubleSided, box.has_value());
        }
    }
    std::vector<OutsideView> out;
    for (const Picture& picture : pictures)
        out.push_back(picture.seen());
    return out;
}

} // namespace candelabra::app
