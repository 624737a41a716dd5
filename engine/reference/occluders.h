// SPDX-License-Identifier: Apache-2.0
// The surfaces of a scene as things that rays meet: triangles in a tree of boxes, exact planes and
// balls. In double precision.
#pragma once

#include <array>
#include <cstdint>
#include <limits>
#include <optional>
#include <span>
#include <vector>

#include <glm/glm.hpp>

#include "reference/visible_lights.h"

namespace candelabra::reference
{

struct Object {
    enum class Type { Plane, Ball } type = Type::Plane;
    glm::dvec3 point{0};        // plane: a point on it; ball: centre
    glm::dvec3 normal{0, 1, 0}; // plane: unit normal; only the side it points to is visible
    double radius = 1;          // ball: visible from outside only
    uint32_t material = 0;      // index into Scene::materials
    uint32_t occluderLayer = 0; // 0..31, see Scene::ignoredLayers
};

struct Triangle {
    std::array<glm::dvec3, 3> corners; // counter-clockwise seen from its front
    std::array<glm::dvec3, 3> normals; // of the smooth surface, unit
    uint32_t material = 0;             // index into Scene::materials
    uint32_t occluderLayer = 0;        // 0..31, see Scene::ignoredLayers
    bool twoSided = false;             // visible from behind, too
    bool blocks = true;                // stops light; then it does so from both sides
};

struct TriangleHit {
    uint32_t triangle = 0;
    double distance = std::numeric_limits<double>::infinity();
    double u = 0, v = 0; // barycentric coordinates of the second and third corner
};

// Light that runs from `origin` along `direction`, until `end` times its length.
struct LightRay {
    glm::dvec3 origin{0}, direction{0};
    double end = 1;
    uint32_t ignoredLayers = 0; // bit i: surfaces of occluder layer i do not stop it
};

// A convex region that contains everything between a point and an emitter: the part of the
// octagonal pyramid around the cone from the point to a ball, up to the far side of that ball. A
// point inside the ball, or as good as inside, has no such pyramid: its shaft is the whole space.
class Shaft
{
public:
    Shaft(const glm::dvec3& apex, const glm::dvec3& toCenter, double radius);
    // The ball is infinitely far away in the direction `axis` (unit); its half angle has this sine.
    static Shaft distant(const glm::dvec3& apex, const glm::dvec3& axis, double sine);

    bool missesBox(const glm::dvec3& low, const glm::dvec3& high) const;
    // Tells whether the triangle stops nothing: it is outside, or its plane contains the apex, or
    // has the apex and the ball on one side.
    bool misses(const Triangle& triangle) const;
    bool misses(const Object& object) const; // the same for planes and balls

private:
    Shaft() = default;
    void addSides(double slope);
    // Tells whether a plane through `point` contains the apex, or has it and the ball on one side.
    bool isAsideOf(const glm::dvec3& point, const glm::dvec3& normal) const;

    struct HalfSpace {
        glm::dvec3 normal{0};
        double offset = 0; // dot(normal, x - apex) <= offset is inside
    };
    glm::dvec3 apex_{0}, axis_{0};
    double distance_ = 1, radius_ = 0; // of the ball; distant: 1 and the sine
    bool distant_ = false;
    std::array<HalfSpace, 10> sides_;
    uint32_t count_ = 0;
};

// Keeps references to the objects and triangles, which must not change.
class Occluders
{
public:
    Occluders(std::span<const Object> objects, std::span<const Triangle> triangles);

    // Returns the triangle that the ray meets first with a visible side. Ignores objects.
    std::optional<TriangleHit> nearest(const Ray& ray) const;

    // Tells whether something stops the light. Surfaces whose distance from the origin is a
    // rounding error do not, so a point on a surface is not shadowed by that surface.
    bool stop(const LightRay& ray) const;
    // The same for what collect() has found.
    bool stop(const LightRay& ray, std::span<const uint32_t> found) const;

    // Sets `out` to what may stop light in the shaft. Returns false if that is more than `most`;
    // then `out` does not hold all of it.
    bool collect(const Shaft& shaft, uint32_t ignoredLayers, size_t most,
                 std::vector<uint32_t>& out) const;

private:
    struct Node {
        glm::dvec3 low, high;
        uint32_t first = 0; // leaf: the first of its triangles in order_; else: the second child
                            // (the first one follows its parent)
        uint32_t count = 0; // leaf: the number of triangles; else 0
    };

    void build(uint32_t first, uint32_t count);
    // Calls visit(triangle) for all triangles of nodes for which enter(node) is true, until it
    // returns true. Returns the last result.
    template <class Enter, class Visit>
    bool walk(Enter&& enter, Visit&& visit) const;

    std::span<const Object> objects_;
    std::span<const Triangle> triangles_;
    std::vector<Node> nodes_;
    std::vector<uint32_t> order_;
};

} // namespace candelabra::reference
