// SPDX-License-Identifier: Apache-2.0
// Compares the tree of the reference with Embree, if that is installed (libembree-dev 3).
#include <gtest/gtest.h>

#if CANDELABRA_EMBREE
#include <algorithm>
#include <cmath>
#include <iostream>
#include <random>
#include <vector>

#include <embree3/rtcore.h>

#include "harness/full_tests.h"
#include "reference/occluders.h"
#endif

namespace candelabra::test
{

#if CANDELABRA_EMBREE

namespace
{

// A scene of the same triangles in Embree, whose coordinates are floats. Robust traversal.
class EmbreeScene
{
public:
    explicit EmbreeScene(const std::vector<reference::Triangle>& triangles)
        : device_(rtcNewDevice(nullptr)), scene_(rtcNewScene(device_))
    {
        rtcSetSceneFlags(scene_, RTC_SCENE_FLAG_ROBUST);
        const RTCGeometry mesh = rtcNewGeometry(device_, RTC_GEOMETRY_TYPE_TRIANGLE);
        auto* vertex = static_cast<float*>(
            rtcSetNewGeometryBuffer(mesh, RTC_BUFFER_TYPE_VERTEX, 0, RTC_FORMAT_FLOAT3,
                                    3 * sizeof(float), 3 * triangles.size()));
        auto* index = static_cast<uint32_t*>(
            rtcSetNewGeometryBuffer(mesh, RTC_BUFFER_TYPE_INDEX, 0, RTC_FORMAT_UINT3,
                                    3 * sizeof(uint32_t), triangles.size()));
        for (size_t i = 0; i < 3 * triangles.size(); ++i) {
            for (int k = 0; k < 3; ++k)
                *vertex++ = float(triangles[i / 3].corners[i % 3][k]);
            *index++ = uint32_t(i);
        }
        rtcCommitGeometry(mesh);
        rtcAttachGeometry(scene_, mesh);
        rtcReleaseGeometry(mesh);
        rtcCommitScene(scene_);
    }
    ~EmbreeScene()
    {
        rtcReleaseScene(scene_);
        rtcReleaseDevice(device_);
    }
    EmbreeScene(const EmbreeScene&) = delete;
    EmbreeScene& operator=(const EmbreeScene&) = delete;

    bool stops(const glm::vec3& from, const glm::vec3& way) const
    {
        RTCIntersectContext context;
        rtcInitIntersectContext(&context);
        RTCRay ray{};
        ray.org_x = from.x;
        ray.org_y = from.y;
        ray.org_z = from.z;
        ray.dir_x = way.x;
        ray.dir_y = way.y;
        ray.dir_z = way.z;
        ray.tfar = 1;
        ray.mask = ~0u;
        rtcOccluded1(scene_, &context, &ray);
        return ray.tfar < 0;
    }

private:
    RTCDevice device_;
    RTCScene scene_;
};

// The distance of a segment from a segment, both given by an end and the way to the other end.
double segmentDistance(const glm::dvec3& p, const glm::dvec3& d, const glm::dvec3& q,
                       const glm::dvec3& e)
{
    // The squared distance is convex, so alternating projections find its minimum; near edges,
    // which is all that matters here, a few hundred steps do.
    double s = 0.5, t = 0.5;
    for (int i = 0; i < 300; ++i) {
        s = std::clamp(glm::dot(q + t * e - p, d) / glm::dot(d, d), 0.0, 1.0);
        t = std::clamp(glm::dot(p + s * d - q, e) / glm::dot(e, e), 0.0, 1.0);
    }
    return glm::distance(p + s * d, q + t * e);
}

} // namespace

TEST(ReferenceEmbree, TheSameSegmentsAreStopped)
{
    std::mt19937_64 random(11);
    std::uniform_real_distribution<float> unit(-1, 1);
    const auto point = [&] {
        const float x = unit(random), y = unit(random);
        return glm::vec3(x, y, unit(random));
    };
    std::vector<reference::Triangle> triangles(2000);
    for (reference::Triangle& triangle : triangles) {
        const glm::vec3 a = 3.0f * point();
        triangle.corners = {a, a + 0.5f * point(), a + 0.5f * point()};
    }
    const reference::Occluders tree({}, triangles);
    const EmbreeScene embree(triangles);
    const size_t count = fullTests() ? 1'000'000 : 100'000;
    size_t stopped = 0, different = 0;
    double farthest = 0; // from an edge
    for (size_t i = 0; i < count; ++i) {
        const glm::vec3 from = 3.0f * point(), way = 3.0f * point();
        const bool stops = tree.stop({.origin = from, .direction = way});
        stopped += stops;
        if (stops == embree.stops(from, way))
            continue;
        ++different;
        double nearest = 1;
        for (const reference::Triangle& triangle : triangles)
            for (size_t k = 0; k < 3; ++k)
                nearest = std::min(
                    nearest, segmentDistance(from, way, triangle.corners[k],
                                             triangle.corners[(k + 1) % 3] - triangle.corners[k]));
        // A segment that ends at a triangle's face differs as well.
        for (const reference::Triangle& triangle : triangles) {
            const glm::dvec3 normal =
                glm::normalize(glm::cross(triangle.corners[1] - triangle.corners[0],
                                          triangle.corners[2] - triangle.corners[0]));
            for (const glm::dvec3& end : {glm::dvec3(from), glm::dvec3(from + way)})
                nearest = std::min(nearest, std::abs(glm::dot(normal, end - triangle.corners[0])));
        }
        farthest = std::max(farthest, nearest);
    }
    std::cout << stopped << " of " << count << " segments are stopped, " << different
              << " differ, at most " << farthest << " m from an edge\n";
    EXPECT_GT(stopped, count / 4);
    EXPECT_LE(different, count / 10'000);
    EXPECT_LE(farthest, 1e-6);
}

#else

TEST(ReferenceEmbree, TheSameSegmentsAreStopped)
{
    GTEST_SKIP() << "built without Embree (libembree-dev 3)";
}

#endif

} // namespace candelabra::test
