// SPDX-License-Identifier: Apache-2.0
// Casts rays into a scene, on the CPU in double precision, and so finds what a camera sees without
// a renderer. Alpha masks and normal maps are ignored.
#pragma once

#include <cstdint>
#include <optional>
#include <vector>

#include <glm/glm.hpp>

#include "scene/scene.h"

namespace candelabra::app
{

struct Ray {
    glm::dvec3 origin{0};
    glm::dvec3 direction{0, 0, -1}; // unit
};

struct RayHit {
    double distance = 0;
    glm::dvec3 position{0};
    glm::dvec3 normal{0, 1, 0}; // unit, interpolated, on the side from which the ray comes
    bool front = true;          // the ray meets the front of the surface
    uint32_t material = 0;
    // The hit object: an index of Scene::instances or of Scene::analyticObjects.
    uint32_t object = 0;
    bool analytic = false;
};

// Everything between two balls: from `start` to `start + axis`.
struct Shaft {
    glm::dvec3 start{0}, axis{0, 0, -1};
    double startRadius = 0, endRadius = 0;
};

// What a search for the triangles in a shaft tests, about.
struct ShaftContents {
    uint64_t boxes = 0;     // of trees
    uint64_t triangles = 0; // whose boxes the shaft touches
};

struct TestedShaft; // a Shaft, prepared for many tests

// A binary tree of boxes, which may hold anything.
class BoxTree
{
public:
    BoxTree() = default;
    explicit BoxTree(const std::vector<Bounds>& boxes);

    // Calls visit(item, nearest) for every box that the ray meets before the distance `nearest`,
    // which `visit` may lower.
    template <typename Visit>
    void traverse(const Ray& ray, double& nearest, Visit&& visit) const;
    // Calls visit(item) for every box that the shaft touches, and for some others. Returns how many
    // boxes it has tested.
    template <typename Visit>
    uint64_t traverse(const TestedShaft& shaft, Visit&& visit) const;

private:
    struct Node {
        Bounds box;
        uint32_t first = 0; // leaf: the first of its items in order_; else: the right child (the
                            // left child follows its parent)
        uint32_t count = 0; // leaf: the number of items; else 0
    };

    void build(const std::vector<Bounds>& boxes, uint32_t first, uint32_t count);

    std::vector<Node> nodes_;
    std::vector<uint32_t> order_;
};

// Casts rays into a scene, to which it keeps a reference and which must not change.
class RayCaster
{
public:
    explicit RayCaster(const Scene& scene);

    // Returns the nearest surface that the ray meets, which may be a back face.
    std::optional<RayHit> cast(const Ray& ray);

    // Counts what casts shadows in a shaft. Blended surfaces and those of ignored occluder layers
    // (1 << layer) do not. A ball counts as many triangles.
    ShaftContents contentsOf(const Shaft& shaft, uint32_t ignoredLayers);

private:
    void hitInstance(uint32_t instance, const Ray& ray, RayHit& best);
    void hitAnalytic(uint32_t index, const Ray& ray, RayHit& best) const;
    const BoxTree& meshTree(uint32_t mesh);

    const Scene& scene_;
    BoxTree instances_;
    std::vector<uint32_t> instanceIds_;             // of the tree's items
    std::vector<glm::dmat4> objectFromWorld_;       // of the tree's items
    std::vector<std::optional<BoxTree>> meshTrees_; // built when first needed
};

// Returns the ray through the centre of pixel (x, y), counted from the top left, of a width x
// height image.
Ray cameraRay(const Camera& camera, uint32_t x, uint32_t y, uint32_t width, uint32_t height);

} // namespace candelabra::app
