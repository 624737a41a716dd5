// SPDX-License-Identifier: Apache-2.0
// Tests visible area lights of every shape against double precision: silhouette, depth, luminance.
#include <algorithm>
#include <cmath>
#include <cstdio>
#include <functional>

#include "gpu/raster_rays.h"
#include "harness/constants.h"
#include "harness/full_tests.h"
#include "measure/kernels/vectors.h"
#include "reference/visible_lights.h"
#include "scene/polygons.h"
#include "shared/raster.h"

namespace candelabra::test
{
namespace
{

using app::set;

glm::dvec3 vec(const float (&v)[3])
{
    return glm::dvec3(glm::make_vec3(v));
}

// Returns where the ray first meets the light in front of the eye, or infinity. The light is
// enlarged by `grow` metres on all sides.
double hitTube(const Ray& ray, const glm::dvec3& center, const CndLight& l, double grow)
{
    const glm::dvec3 half = vec(l.axisU);
    const double radius = double(l.radius) + grow;
    // The distance from the segment is convex along the ray, so bisection finds the hit.
    const auto outside = [&](double t) {
        const glm::dvec3 p = ray.at(t) - center;
        const double along = glm::clamp(glm::dot(p, half) / glm::dot(half, half), -1.0, 1.0);
        return glm::length(p - along * half) - radius;
    };
    double low = -1e3, high = 1e3;
    for (int i = 0; i < 90; ++i) { // ternary search for the closest approach
        const double a = low + (high - low) / 3, b = high - (high - low) / 3;
        (outside(a) < outside(b) ? high : low) = outside(a) < outside(b) ? b : a;
    }
    const double closest = 0.5 * (low + high);
    if (outside(closest) > 0)
        return infinity;
    const auto border = [&](double in, double out) {
        for (int i = 0; i < 60; ++i)
            (outside(0.5 * (in + out)) <= 0 ? in : out) = 0.5 * (in + out);
        return in;
    };
    const double near = border(closest, closest - 1e3), far = border(closest, closest + 1e3);
    return near > 0 ? near : far > 0 ? far : infinity;
}

// Tells whether a point, relative to the centre, is less than `room` metres outside every edge.
bool isInPolygon(const CndLight& l, const glm::dvec3& p, const glm::dvec3& normal, double room)
{
    const auto corner = [&](uint32_t i) {
        const float(&at)[2] = l.polygon->corners[i % l.polygon->cornerCount];
        return double(at[0]) * vec(l.axisU) + double(at[1]) * vec(l.axisV);
    };
    for (uint32_t i = 0; i < l.polygon->cornerCount; ++i) {
        const glm::dvec3 outward = glm::normalize(glm::cross(corner(i + 1) - corner(i), normal));
        if (glm::dot(outward, p - corner(i)) > room)
            return false;
    }
    return true;
}

double hitFlat(const Ray& ray, const glm::dvec3& center, const CndLight& l, double grow)
{
    const glm::dvec3 u = vec(l.axisU), v = vec(l.axisV);
    const bool rectangle = l.type == CND_LIGHT_RECTANGLE;
    const glm::dvec3 normal =
        glm::normalize(l.type == CND_LIGHT_DISC ? vec(l.direction) : glm::cross(u, v));
    const double slope = glm::dot(ray.direction, normal);
    if (slope > 0 && !l.twoSided)
        return infinity;
    const double t = glm::dot(center - ray.origin, normal) / slope;
    const glm::dvec3 p = ray.at(t) - center;
    const double room = grow / std::abs(slope);
    if (l.type == CND_LIGHT_POLYGON)
        return isInPolygon(l, p, normal, room) && t > 0 ? t : infinity;
    const double lengthU = glm::length(u), lengthV = glm::length(v);
    const bool inside = rectangle ? std::abs(glm::dot(p, u)) <= (lengthU + room) * lengthU &&
                                        std::abs(glm::dot(p, v)) <= (lengthV + room) * lengthV
                                  : glm::length(p) <= double(l.radius) + room;
    return inside && t > 0 ? t : infinity;
}

// Types without a second implementation in this file: the reference's, of a light that is enlarged.
double hitOther(const Ray& ray, const glm::dvec3& origin, CndLight l, double grow)
{
    l.radius = float(l.radius + grow);
    for (float(*axis)[3] : {&l.axisU, &l.axisV})
        if (const double length = glm::length(vec(*axis)); length > 0)
            set(*axis, (1 + grow / length) * vec(*axis));
    return reference::intersectLight(l, origin, {ray.origin, ray.direction}).value_or(infinity);
}

double hitLight(const Ray& ray, const glm::dvec3& origin, const CndLight& l, double grow)
{
    const glm::dvec3 center = origin + vec(l.position);
    // There is nothing to search for if the ray misses a bounding sphere.
    const double reach =
        glm::length(vec(l.axisU)) + glm::length(vec(l.axisV)) + double(l.radius) + 1;
    if (hitSphere(ray, center, reach).near == infinity)
        return infinity;
    if (l.type == CND_LIGHT_TUBE)
        return hitTube(ray, center, l, grow);
    if (l.type == CND_LIGHT_RECTANGLE || l.type == CND_LIGHT_DISC || l.type == CND_LIGHT_POLYGON)
        return hitFlat(ray, center, l, grow);
    if (l.type != CND_LIGHT_SPHERE)
        return hitOther(ray, origin, l, grow);
    const SphereHit hit = hitSphere(ray, center, double(l.radius) + grow);
    return hit.near > 0 ? hit.near : hit.far > 0 ? hit.far : infinity;
}

// The types whose emitters have a place, without spheres, which other files of this folder test.
std::vector<CndLightType> shapeTypes()
{
    std::vector<CndLightType> types;
    for (uint32_t type = 0; type < CND_LIGHT_TYPE_COUNT; ++type)
        if (!cndIsDistant(type) && !cndIsPunctual(type) && type != CND_LIGHT_SPHERE)
            types.push_back(CndLightType(type));
    return types;
}

CndLight randomLight(CndLightType type, Random& random, double size, float mark)
{
    CndLight l = sphereLight(random.box(size), std::pow(10, random.uniform(-2, 0.2)), {mark, 1, 2});
    l.type = type;
    const glm::dvec3 u = random.direction();
    const glm::dvec3 v = glm::normalize(glm::cross(u, random.direction()));
    set(l.axisU, u * std::pow(10, random.uniform(-1.5, 0.3)));
    set(l.axisV, v * std::pow(10, random.uniform(-1.5, 0.3)));
    set(l.direction, u);
    l.twoSided = random.uniform(0, 1) < 0.5;
    l.polygon = app::somePolygon(uint32_t(mark));
    return l;
}

// hitOther() enlarges the ends of tubes and the borders of flat lights by another distance than the
// other functions do, but by no less than `grow` and by no more than they do for twice as much.
TEST(EmitterRayCast, TheReferenceAgreesWithTheImplementationsOfThisFile)
{
    const glm::dvec3 origin(3e5, 200, -7e5);
    Random random(5);
    for (const CndLightType type :
         {CND_LIGHT_SPHERE, CND_LIGHT_TUBE, CND_LIGHT_RECTANGLE, CND_LIGHT_DISC}) {
        SCOPED_TRACE(type);
        int hits = 0, misses = 0, gained = 0, lost = 0;
        for (int i = 0; i < 20000; ++i) {
            const CndLight l = randomLight(type, random, 6, 1);
            const double smallest =
                std::min({double(l.radius), glm::length(vec(l.axisU)), glm::length(vec(l.axisV))});
            const double grow = 0.2 * smallest;
            const glm::dvec3 eye = origin + random.box(12);
            const glm::dvec3 target = origin + vec(l.position) + random.box(2);
            const Ray ray{eye, glm::normalize(target - eye)};
            const double own = hitLight(ray, origin, l, 0), other = hitOther(ray, origin, l, 0);
            // From the smallest light to the largest: a ray that meets one meets the next.
            const bool met[] = {hitLight(ray, origin, l, -2 * grow) < infinity,
                                hitOther(ray, origin, l, -grow) < infinity, own < infinity,
                                hitOther(ray, origin, l, grow) < infinity,
                                hitLight(ray, origin, l, 2 * grow) < infinity};
            ASSERT_TRUE(std::is_sorted(std::begin(met), std::end(met))) << i;
            hits += met[0];
            misses += !met[4];
            gained += met[3] && !met[2];
            lost += met[2] && !met[1];
            if (met[0]) {
                ASSERT_NEAR(other, own, 1e-6 * own) << i;
            } else if (!met[4]) {
                ASSERT_EQ(other, infinity) << i;
            }
        }
        EXPECT_GT(hits, 200);
        EXPECT_GT(misses, 200);
        EXPECT_GT(gained, 20);
        EXPECT_GT(lost, 20);
    }
}

class GBufferEmitterShapes : public RasterTest
{
protected:
    // Compares every pixel that is clearly inside or outside of every silhouette. `grazing` counts
    // the other pixels.
    void expectRayCast(const RasterImage& image, const RasterOptions& o, size_t& grazing)
    {
        size_t shown = 0;
        for (uint32_t y = 0; y < image.height; ++y)
            for (uint32_t x = 0; x < image.width; ++x) {
                const size_t i = size_t(y) * image.width + x;
                const Ray ray = pixelRay(o, x, y);
                double nearest = infinity, second = infinity;
                const CndLight* winner = nullptr;
                bool unsure = false;
                for (const CndLight& l : o.emitters) {
                    if (l.type == CND_LIGHT_DISTANT_SPHERE)
                        continue;
                    const double room =
                        3e-6 * glm::length(o.emitterOrigin + vec(l.position) - ray.origin);
                    const double t = hitLight(ray, o.emitterOrigin, l, 0);
                    unsure |= (hitLight(ray, o.emitterOrigin, l, room) == infinity) !=
                              (hitLight(ray, o.emitterOrigin, l, -room) == infinity);
                    if (t < nearest) {
                        second = nearest;
                        nearest = t;
                        winner = &l;
                    } else {
                        second = std::min(second, t);
                    }
                }
                unsure |= second < infinity && second - nearest < 1e-3 * nearest;
                if (unsure) {
                    ++grazing;
                    continue;
                }
                ASSERT_EQ(image.covered(i), winner != nullptr) << x << " " << y;
                if (!winner)
                    continue;
                ++shown;
                // For a grazing ray a small error across the surface is a large one along it.
                const double tolerance = winner->type == CND_LIGHT_TUBE ? 1e-3 : 2e-4;
                ASSERT_NO_FATAL_FAILURE(
                    expectEmitter(image, o, x, y, *winner, ray.at(nearest), tolerance));
            }
        EXPECT_GT(shown, 100u);
    }
};

TEST_F(GBufferEmitterShapes, SilhouettesAreThoseOfTheRayCast)
{
    std::vector<CndLightType> types = shapeTypes();
    std::vector<CndLightType> all = types;
    all.insert(all.begin(), CND_LIGHT_SPHERE);
    types.push_back(CND_LIGHT_TYPE_COUNT); // all in turn
    for (const CndGBufferLayout layout : {CND_GBUFFER_FULL, CND_GBUFFER_COMPACT})
        for (int kind = 0; kind < 4; ++kind)
            for (const CndLightType type : types) {
                if (layout == CND_GBUFFER_COMPACT && type != CND_LIGHT_TYPE_COUNT)
                    continue; // the shapes are the same as with FULL; only what is written differs
                SCOPED_TRACE(::testing::Message()
                             << layout << " projection " << kind << " type " << type);
                RasterOptions options = perspectiveOptions();
                options.layout = layout;
                options.emitterOrigin = {3e5, 200, -7e5};
                Random random(uint32_t(kind) + 7);
                for (uint32_t i = 0; i < 40; ++i)
                    options.emitters.push_back(
                        randomLight(type == CND_LIGHT_TYPE_COUNT ? all[i % all.size()] : type,
                                    random, 6, float(i)));
                setProjection(options, kind);
                lookAt(options.camera, options.emitterOrigin + glm::dvec3(1, 14, 9),
                       options.emitterOrigin);
                const RasterImage image = render(RasterScene{}, options);
                size_t grazing = 0;
                expectRayCast(image, options, grazing);
                std::printf("type %d, projection %d: %zu of %zu pixels too close to an edge\n",
                            int(type), kind, grazing, image.depth.size());
                EXPECT_LE(grazing, image.depth.size() / 50);
            }
}

// Lights from a thousandth of a pixel to a quarter of the image, around the camera. cull_emitters,
// where a device has it, leaves out most of them, which must not change the image.
TEST_F(GBufferEmitterShapes, WhatCoversNoSampleMakesNoDifference)
{
    Random random(77);
    std::vector<CndLightType> types = shapeTypes();
    types.insert(types.end(), {CND_LIGHT_SPHERE, CND_LIGHT_DISTANT_SPHERE});
    RasterOptions options = perspectiveOptions();
    options.emitterOrigin = {3e5, 200, -7e5};
    for (size_t i = 0; i < 9000; ++i) {
        const CndLightType type = types[i % types.size()];
        CndLight l = randomLight(type, random, 30, float(i));
        const double scale = std::pow(10, random.uniform(-4, 0));
        if (type == CND_LIGHT_DISTANT_SPHERE)
            set(l.direction, random.direction());
        l.radius *= float(type == CND_LIGHT_DISTANT_SPHERE ? 0.1 * scale : scale);
        set(l.axisU, scale * vec(l.axisU));
        set(l.axisV, scale * vec(l.axisV));
        options.emitters.push_back(l);
    }
    const gbuffer::Geometry geometry = uploadGeometry({});
    gbuffer::GBuffer pass(device(), {.framesInFlight = 2});
    for (uint32_t view = 0; view < 16; ++view) {
        SCOPED_TRACE(view);
        setProjection(options, int(view % 4));
        lookAt(options.camera, options.emitterOrigin + random.box(25),
               options.emitterOrigin + random.box(10));
        options.cullTriangles = true;
        const RasterImage culled = renderWith(pass, geometry, options, view % 2);
        uint64_t left = 0;
        if (pass.cullsEmitters())
            forEachDraw<gpu::EmitterDraw>(
                pass.emitterDraws(view % 2),
                [&](const gpu::EmitterDraw& draw) { left += draw.instanceCount; });
        options.cullTriangles = false;
        const RasterImage all = renderWith(pass, geometry, options, view % 2);
        EXPECT_GT(all.coveredCount(), 100u);
        expectSameImage(culled, all);
        ASSERT_EQ(pass.cullsEmitters(), device().lanesAreCpuVector);
        if (pass.cullsEmitters()) {
            EXPECT_LT(left, options.emitters.size() / 3);
        }
    }
}

// Lights around the camera, at arm's length, and filling the image.
TEST_F(GBufferEmitterShapes, CloseToTheCamera)
{
    for (const CndLightType type : shapeTypes())
        for (const double distance : {0.4, 0.7, 2.0})
            for (const double side : {0.0, 0.6, 1.5, 2.5}) {
                if (!fullTests() && distance == 2.0)
                    continue;
                SCOPED_TRACE(::testing::Message()
                             << "type " << type << " distance " << distance << " side " << side);
                RasterOptions options = perspectiveOptions();
                setPerspective(options.camera, 1.4, double(options.width) / options.height, 0.1);
                const glm::dvec3 direction(std::sin(side), 0.1, -std::cos(side));
                CndLight l = sphereLight(distance * direction, 0.5, {5, 6, 7});
                l.type = type;
                set(l.axisU, {0.8, 0.2, 0.3});
                set(l.axisV, {-0.1, 0.4, 0});
                set(l.direction, -glm::normalize(direction + glm::dvec3(0.3, 0.2, 0)));
                l.twoSided = true;
                l.polygon = app::regularPolygon(7);
                options.emitters = {l, sphereLight({0, 0.4, -9}, 3, {8, 9, 10})};
                lookAt(options.camera, {0, 0, 0}, {0, 0, -1});
                size_t grazing = 0;
                expectRayCast(render(RasterScene{}, options), options, grazing);
                EXPECT_LE(grazing, 500u);
            }
}

// The Sun, a wider sun that covers it, and a floor and a lamp in front of both.
TEST_F(GBufferEmitterShapes, DistantSpheresShowWhereNothingElseIs)
{
    for (int kind = 0; kind < 4; ++kind) {
        SCOPED_TRACE(kind);
        RasterScene scene;
        scene.addMaterial(testMaterial());
        gbuffer::AnalyticObject floor{.type = gbuffer::AnalyticObject::Type::Plane};
        floor.normal[1] = 1;
        scene.analyticObjects.push_back(floor);
        RasterOptions options = perspectiveOptions();
        setProjection(options, kind);
        options.background = {0.25f, 0.5f, 0.75f};
        options.emitterOrigin = {1e6, 0, -1e6};
        lookAt(options.camera, {0, 1.5, 6}, {0, 1.5 + (kind == 3 ? 0.6 : 0.1), 0});
        const auto distant = [](const glm::dvec3& toLight, float sine, const glm::vec3& luminance) {
            CndLight l{.type = CND_LIGHT_DISTANT_SPHERE, .radius = sine};
            set(l.direction, -glm::normalize(toLight));
            set(l.emission, glm::dvec3(luminance));
            return l;
        };
        options.emitters = {distant({0.1, 0.2, -1}, 0.1f, {3, 4, 5}),
                            distant({0.13, 0.22, -1}, 0.00465f, {1.6e9f, 1.5e9f, 1.4e9f}),
                            distant({0.1, 0.1, 1}, 0.9f, {9, 9, 9}), // behind the camera
                            sphereLight(glm::dvec3(-1e6 - 0.2, 1.9, 1e6), 0.5, {7, 8, 9})};
        const RasterImage image = render(scene, options);
        size_t suns[2] = {};
        for (uint32_t y = 0; y < image.height; ++y)
            for (uint32_t x = 0; x < image.width; ++x) {
                const size_t i = size_t(y) * image.width + x;
                const Ray ray = pixelRay(options, x, y);
                if (image.covered(i)) { // shows the floor or the lamp
                    ASSERT_LE(image.radiance[i].r, 100);
                    continue;
                }
                const CndLight* winner = nullptr;
                bool rim = false;
                for (size_t k = 0; k < 3; ++k) {
                    const glm::dvec3 toLight = -glm::normalize(vec(options.emitters[k].direction));
                    const double angle = angleBetween(ray.direction, toLight);
                    const double radius = std::asin(double(options.emitters[k].radius));
                    rim |= std::abs(angle - radius) < 2e-6;
                    if (angle <= radius) {
                        winner = &options.emitters[k];
                        suns[k % 2] += k < 2;
                    }
                }
                if (rim)
                    continue;
                for (int c = 0; c < 3; ++c)
                    ASSERT_EQ(image.radiance[i][c],
                              winner ? winner->emission[c] : options.background[c])
                        << x << " " << y;
            }
        // The wide sun shows about 520 pixels, 26 across, minus those that the lamp hides. Parallel
        // rays see only one direction of the sky.
        std::printf("projection %d: pixels of the wide sun %zu, of the Sun %zu\n", kind, suns[0],
                    suns[1]);
        if (kind != 3) {
            EXPECT_GT(suns[0], 500u);
            EXPECT_GE(suns[1], 1u);
        }
    }
}

TEST_F(GBufferEmitterShapes, BadOnesAreRefused)
{
    gbuffer::GBuffer pass(device(), {.framesInFlight = 1});
    const double origin[3] = {0, 0, 0};
    Random random(1);
    const auto refuse = [&](CndLightType type, const std::function<void(CndLight&)>& edit) {
        std::vector<CndLight> lights{randomLight(type, random, 1, 1)};
        EXPECT_NO_THROW(pass.setEmitters(lights, origin));
        edit(lights[0]);
        EXPECT_THROW(pass.setEmitters(lights, origin), gpu::Failure) << type;
    };
    refuse(CND_LIGHT_TUBE, [](CndLight& l) { set(l.axisU, glm::dvec3(0)); });
    refuse(CND_LIGHT_TUBE, [](CndLight& l) { l.radius = 0; });
    refuse(CND_LIGHT_RECTANGLE, [](CndLight& l) { l.axisV[1] = NAN; });
    refuse(CND_LIGHT_DISC, [](CndLight& l) { set(l.direction, glm::dvec3(0)); });
    refuse(CND_LIGHT_DISC, [](CndLight& l) { l.emission[2] = INFINITY; });
    refuse(CND_LIGHT_POLYGON, [](CndLight& l) { l.polygon = nullptr; });
    CndPolygon broken = *app::regularPolygon(4);
    broken.corners[2][1] = NAN;
    refuse(CND_LIGHT_POLYGON, [&](CndLight& l) { l.polygon = &broken; });
    CndPolygon line{2, {{-1, 0}, {1, 0}}};
    refuse(CND_LIGHT_POLYGON, [&](CndLight& l) { l.polygon = &line; });
    refuse(CND_LIGHT_DISTANT_SPHERE, [](CndLight& l) { l.direction[0] = NAN; });
}

} // namespace
} // namespace candelabra::test
