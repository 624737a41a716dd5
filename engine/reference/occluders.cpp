// SPDX-License-Identifier: Apache-2.0
#include "reference/occluders.h"

#include <algorithm>
#include <cmath>
#include <numbers>
#include <numeric>

#include "reference/response.h"

namespace candelabra::reference
{

namespace
{

// Rounding errors of positions, relative to the distances that they come from.
constexpr double rounding = 1e-10;

// The intersection with a triangle at any distance (Moeller and Trumbore 1997); edges belong to it.
std::optional<TriangleHit> meet(const Triangle& triangle, const glm::dvec3& origin,
                                const glm::dvec3& direction)
{
    const auto& [a, b, c] = triangle.corners;
    const glm::dvec3 edge1 = b - a, edge2 = c - a;
    const glm::dvec3 p = glm::cross(direction, edge2);
    const double determinant = glm::dot(edge1, p);
    if (determinant == 0)
        return std::nullopt;
    const glm::dvec3 s = origin - a;
    const double u = glm::dot(s, p) / determinant;
    if (!(u >= 0 && u <= 1))
        return std::nullopt;
    const glm::dvec3 q = glm::cross(s, edge1);
    const double v = glm::dot(direction, q) / determinant;
    if (!(v >= 0 && u + v <= 1))
        return std::nullopt;
    return TriangleHit{0, glm::dot(edge2, q) / determinant, u, v};
}

// Tells whether a point lies in a plane through another one, but for rounding.
bool isInPlane(const glm::dvec3& point, const glm::dvec3& other, const glm::dvec3& normal)
{
    const double scale = glm::distance(other, point) + glm::length(point);
    return std::abs(glm::dot(normal, other - point)) <= rounding * scale * glm::length(normal);
}

glm::dvec3 normalOf(const Triangle& triangle)
{
    const auto& [a, b, c] = triangle.corners;
    return glm::cross(b - a, c - a);
}

bool isIgnored(const Triangle& triangle, uint32_t ignoredLayers)
{
    return !triangle.blocks || (ignoredLayers >> triangle.occluderLayer & 1);
}

bool isIgnored(const Object& object, uint32_t ignoredLayers)
{
    return ignoredLayers >> object.occluderLayer & 1;
}

bool stops(const Triangle& triangle, const LightRay& ray)
{
    if (isIgnored(triangle, ray.ignoredLayers))
        return false;
    const auto hit = meet(triangle, ray.origin, ray.direction);
    return hit && hit->distance > 0 && hit->distance < ray.end &&
           !isInPlane(ray.origin, triangle.corners[0], normalOf(triangle));
}

bool isOnBall(const glm::dvec3& point, const Object& ball)
{
    const double distance = glm::distance(point, ball.point);
    return std::abs(distance - ball.radius) <= rounding * (distance + glm::length(point));
}

bool stops(const Object& object, const LightRay& ray)
{
    if (isIgnored(object, ray.ignoredLayers))
        return false;
    const glm::dvec3 offset = object.point - ray.origin;
    if (object.type == Object::Type::Plane) {
        const double t = glm::dot(offset, object.normal) / glm::dot(ray.direction, object.normal);
        return t > 0 && t < ray.end && !isInPlane(ray.origin, object.point, object.normal);
    }
    const double length2 = glm::dot(ray.direction, ray.direction);
    const double nearest = glm::dot(offset, ray.direction) / length2;
    const glm::dvec3 miss = offset - nearest * ray.direction;
    const double depth2 = object.radius * object.radius - glm::dot(miss, miss);
    if (depth2 < 0 || isOnBall(ray.origin, object))
        return false;
    const double half = std::sqrt(depth2 / length2);
    const auto isBefore = [&](double t) { return t > 0 && t < ray.end; };
    return isBefore(nearest - half) || isBefore(nearest + half);
}

// A ray as boxes see it.
struct BoxRay {
    glm::dvec3 origin, inverse;

    BoxRay(const glm::dvec3& from, const glm::dvec3& direction)
        : origin(from), inverse(1.0 / direction)
    {
    }

    // Tells whether the ray meets the box before `end`.
    bool meets(const glm::dvec3& low, const glm::dvec3& high, double end) const
    {
        double from = 0, to = end;
        for (int axis = 0; axis < 3; ++axis) {
            const double a = (low[axis] - origin[axis]) * inverse[axis];
            const double b = (high[axis] - origin[axis]) * inverse[axis];
            // 0 * infinity gives NaN, which fmin and fmax ignore.
            from = std::fmax(from, std::fmin(a, b));
            to = std::fmin(to, std::fmax(a, b));
        }
        return from <= to;
    }
};

} // namespace

Shaft::Shaft(const glm::dvec3& apex, const glm::dvec3& toCenter, double radius) : apex_(apex)
{
    distance_ = glm::length(toCenter);
    radius_ = radius;
    if (!(distance_ > 1.0001 * radius))
        return;
    axis_ = toCenter / distance_;
    addSides(radius / std::sqrt((distance_ - radius) * (distance_ + radius)));
    sides_[count_++] = {axis_, distance_ + radius};
}

Shaft Shaft::distant(const glm::dvec3& apex, const glm::dvec3& axis, double sine)
{
    Shaft out;
    out.apex_ = apex;
    out.axis_ = axis;
    out.radius_ = sine;
    out.distant_ = true;
    if (sine < 0.999)
        out.addSides(sine / std::sqrt((1 - sine) * (1 + sine)));
    return out;
}

void Shaft::addSides(double slope)
{
    const Frame frame = frameAround(axis_, {0, 1, 0});
    slope += rounding;
    for (int i = 0; i < 8; ++i) {
        const double angle = i * std::numbers::pi / 4;
        const glm::dvec3 across = std::cos(angle) * frame.x + std::sin(angle) * frame.y;
        sides_[count_++] = {across - slope * axis_, 0};
    }
    sides_[count_++] = {-axis_, 0};
}

bool Shaft::missesBox(const glm::dvec3& low, const glm::dvec3& high) const
{
    return std::any_of(sides_.begin(), sides_.begin() + count_, [&](const HalfSpace& side) {
        const glm::dvec3 a = side.normal * (low - apex_), b = side.normal * (high - apex_);
        const glm::dvec3 least = glm::min(a, b);
        return least.x + least.y + least.z >
               side.offset + rounding * (glm::length(apex_) + distance_);
    });
}

bool Shaft::isAsideOf(const glm::dvec3& point, const glm::dvec3& normal) const
{
    if (isInPlane(apex_, point, normal))
        return true;
    const double height = glm::dot(normal, point - apex_), length = glm::length(normal);
    const double along = glm::dot(normal, axis_) * distance_;
    const double reach = (height < 0 ? -along : along) + radius_ * length;
    return count_ > 0 && reach < (distant_ ? 0 : std::abs(height)) - rounding * length * distance_;
}

bool Shaft::misses(const Triangle& triangle) const
{
    const auto& [a, b, c] = triangle.corners;
    const double slack = rounding * (glm::length(apex_) + distance_);
    for (uint32_t i = 0; i < count_; ++i) {
        const auto isBeyond = [&](const glm::dvec3& corner) {
            return glm::dot(sides_[i].normal, corner - apex_) > sides_[i].offset + slack;
        };
        if (isBeyond(a) && isBeyond(b) && isBeyond(c))
            return true;
    }
    return isAsideOf(a, normalOf(triangle));
}

bool Shaft::misses(const Object& object) const
{
    if (object.type == Object::Type::Plane)
        return isAsideOf(object.point, object.normal);
    const glm::dvec3 size(object.radius);
    return isOnBall(apex_, object) || missesBox(object.point - size, object.point + size);
}

Occluders::Occluders(std::span<const Object> objects, std::span<const Triangle> triangles)
    : objects_(objects), triangles_(triangles)
{
    order_.resize(triangles.size());
    std::iota(order_.begin(), order_.end(), 0u);
    if (!order_.empty())
        build(0, static_cast<uint32_t>(order_.size()));
}

// Halves the triangles at the median of their centres along the longest axis, down to four.
void Occluders::build(uint32_t first, uint32_t count)
{
    const size_t self = nodes_.size();
    nodes_.emplace_back();
    glm::dvec3 low(std::numeric_limits<double>::infinity()), high = -low;
    glm::dvec3 least = low, most = high;
    const auto centre = [&](uint32_t i) {
        const auto& [a, b, c] = triangles_[i].corners;
        return glm::min(a, glm::min(b, c)) + glm::max(a, glm::max(b, c));
    };
    for (uint32_t i = first; i < first + count; ++i) {
        for (const glm::dvec3& corner : triangles_[order_[i]].corners) {
            low = glm::min(low, corner);
            high = glm::max(high, corner);
        }
        least = glm::min(least, centre(order_[i]));
        most = glm::max(most, centre(order_[i]));
    }
    const glm::dvec3 margin = rounding * (glm::abs(low) + glm::abs(high));
    nodes_[self] = {low - margin, high + margin, first, count};
    if (count <= 4)
        return;
    const glm::dvec3 extent = most - least;
    const int axis = extent.x >= extent.y && extent.x >= extent.z ? 0
                     : extent.y >= extent.z                       ? 1
                                                                  : 2;
    const uint32_t half = count / 2;
    std::nth_element(order_.begin() + first, order_.begin() + first + half,
                     order_.begin() + first + count,
                     [&](uint32_t a, uint32_t b) { return centre(a)[axis] < centre(b)[axis]; });
    build(first, half);
    nodes_[self].first = static_cast<uint32_t>(nodes_.size());
    nodes_[self].count = 0;
    build(first + half, count - half);
}

template <class Enter, class Visit>
bool Occluders::walk(Enter&& enter, Visit&& visit) const
{
    if (nodes_.empty())
        return false;
    uint32_t stack[64]; // 2^32 triangles need 32 levels
    uint32_t depth = 0;
    stack[depth++] = 0;
    while (depth > 0) {
        const uint32_t index = stack[--depth];
        const Node& node = nodes_[index];
        if (!enter(node))
            continue;
        for (uint32_t i = 0; i < node.count; ++i)
            if (visit(order_[node.first + i]))
                return true;
        if (node.count == 0) {
            stack[depth++] = node.first;
            stack[depth++] = index + 1;
        }
    }
    return false;
}

std::optional<TriangleHit> Occluders::nearest(const Ray& ray) const
{
    TriangleHit best;
    const BoxRay boxRay(ray.origin, ray.direction);
    walk([&](const Node& node) { return boxRay.meets(node.low, node.high, best.distance); },
         [&](uint32_t index) {
             const Triangle& triangle = triangles_[index];
             const auto hit = meet(triangle, ray.origin, ray.direction);
             if (hit && hit->distance > 0 && hit->distance < best.distance &&
                 (triangle.twoSided || glm::dot(normalOf(triangle), ray.direction) < 0)) {
                 best = *hit;
                 best.triangle = index;
             }
             return false;
         });
    return best.distance < std::numeric_limits<double>::infinity() ? std::optional(best)
                                                                   : std::nullopt;
}

bool Occluders::stop(const LightRay& ray) const
{
    const BoxRay boxRay(ray.origin, ray.direction);
    return std::any_of(objects_.begin(), objects_.end(),
                       [&](const Object& object) { return stops(object, ray); }) ||
           walk([&](const Node& node) { return boxRay.meets(node.low, node.high, ray.end); },
                [&](uint32_t triangle) { return stops(triangles_[triangle], ray); });
}

bool Occluders::stop(const LightRay& ray, std::span<const uint32_t> found) const
{
    const size_t triangles = triangles_.size();
    return std::any_of(found.begin(), found.end(), [&](uint32_t i) {
        return i < triangles ? stops(triangles_[i], ray) : stops(objects_[i - triangles], ray);
    });
}

bool Occluders::collect(const Shaft& shaft, uint32_t ignoredLayers, size_t most,
                        std::vector<uint32_t>& out) const
{
    out.clear();
    for (size_t i = 0; i < objects_.size(); ++i)
        if (!isIgnored(objects_[i], ignoredLayers) && !shaft.misses(objects_[i]))
            out.push_back(static_cast<uint32_t>(triangles_.size() + i));
    return !walk([&](const Node& node) { return !shaft.missesBox(node.low, node.high); },
                 [&](uint32_t index) {
                     const Triangle& triangle = triangles_[index];
                     if (!isIgnored(triangle, ignoredLayers) && !shaft.misses(triangle))
                         out.push_back(index);
                     return out.size() > most;
                 });
}

} // namespace candelabra::reference
