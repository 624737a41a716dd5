// SPDX-License-Identifier: Apache-2.0
// Tests ray-cast surfaces against double precision: planes, balls and visible sphere lights.
#include <array>
#include <climits>
#include <cmath>
#include <cstdio>
#include <set>

#include <glm/gtc/type_ptr.hpp>

#include "gbuffer/camera_terms.h"
#include "gpu/raster_rays.h"
#include "harness/constants.h"
#include "io/hash.h"
#include "shared/gbuffer_data.h"

namespace candelabra::test
{
namespace
{

gbuffer::AnalyticObject plane(const glm::dvec3& point, const glm::dvec3& normal)
{
    gbuffer::AnalyticObject o{.type = gbuffer::AnalyticObject::Type::Plane};
    std::copy_n(glm::value_ptr(point), 3, o.point);
    std::copy_n(glm::value_ptr(normal), 3, o.normal);
    return o;
}

gbuffer::AnalyticObject ball(const glm::dvec3& center, double radius)
{
    gbuffer::AnalyticObject o{.type = gbuffer::AnalyticObject::Type::Ball, .radius = radius};
    std::copy_n(glm::value_ptr(center), 3, o.point);
    return o;
}

} // namespace

class GBufferRays : public RasterTest
{
};

// The relative error is at most 4e-7 plus a step of the depth format, also 1e6 m from the origin.
// Near the horizon the error along the ray grows with the inverse of the slope.
TEST_F(GBufferRays, PlaneReconstructsToTheExactPoint)
{
    const glm::dvec3 normal = glm::normalize(glm::dvec3(0.1, 1, -0.05));
    for (const double shift : {0.0, 1e6 + 0.3})
        for (int kind = 0; kind < 4; ++kind) {
            SCOPED_TRACE(kind);
            RasterOptions options = perspectiveOptions();
            setProjection(options, kind);
            const glm::dvec3 offset(shift, -shift, shift);
            lookAt(options.camera, offset + glm::dvec3(1, 1.5, 4), offset + glm::dvec3(0, 0, -2));
            RasterScene scene;
            scene.addMaterial(testMaterial());
            scene.analyticObjects.push_back(plane(offset, normal));
            const RasterImage image = render(scene, options);
            double worst = 0;
            size_t mismatches = 0;
            for (uint32_t y = 0; y < image.height; ++y)
                for (uint32_t x = 0; x < image.width; ++x) {
                    const Ray ray = pixelRay(options, x, y);
                    const double t = hitPlane(ray, offset, normal);
                    const double slope = -glm::dot(ray.direction, normal);
                    const bool covered = image.covered(size_t(y) * image.width + x);
                    if (t != infinity && !insideDepthRange(options, ray.at(t)))
                        continue;
                    mismatches += covered != (t != infinity);
                    if (!covered)
                        continue;
                    const double error = glm::length(worldPosition(image, x, y) - ray.at(t)) /
                                         glm::length(ray.at(t) - ray.origin);
                    worst = std::max(worst, error * slope - depthStep(kind, t));
                    ASSERT_LE(angleBetween(storedNormal(image, size_t(y) * image.width + x),
                                           glm::dmat3(viewFromWorld(options.camera)) * normal),
                              gpu::NORMAL_ERROR_FULL + 1e-7);
                }
            EXPECT_EQ(mismatches, 0u);
            EXPECT_GT(image.coveredCount(), 5000u);
            std::printf(
                "plane, projection %d, shift %g: worst relative error x slope %.3g + step\n", kind,
                shift, worst);
            EXPECT_LE(worst, 4e-7);
        }
}

TEST_F(GBufferRays, OnlyTheUpperSideOfAPlaneIsSeen)
{
    RasterScene scene;
    scene.addMaterial(testMaterial());
    scene.analyticObjects.push_back(plane({0, 0, 0}, {0, 1, 0}));
    RasterOptions options = perspectiveOptions();
    lookAt(options.camera, {0, -1, 4}, {0, 0, 0});
    EXPECT_EQ(render(scene, options).coveredCount(), 0u);
}

// Balls that are small and far, large and near (a planet under the feet), and their rims.
TEST_F(GBufferRays, BallReconstructsToTheExactPoint)
{
    struct Case {
        double radius, distance; // distance from the surface
    };
    for (const Case& c : {Case{1, 3}, {0.02, 5}, {6.4e6, 2}, {1e3, 0.5}})
        for (int kind = 0; kind < 4; ++kind) {
            SCOPED_TRACE(::testing::Message() << "radius " << c.radius << ", projection " << kind);
            RasterOptions options = perspectiveOptions();
            setProjection(options, kind);
            if (c.radius < 0.1) // needs a zoom
                options.camera.clipFromView[0] *= 100, options.camera.clipFromView[5] *= 100;
            const glm::dvec3 center(0, -c.radius, 0);
            lookAt(options.camera, {0, c.distance, 0.3 * std::min(c.radius, 1.0)},
                   {0.1 * std::min(c.radius, 1.0), 0, 0});
            RasterScene scene;
            scene.addMaterial(testMaterial());
            scene.analyticObjects.push_back(ball(center, c.radius));
            const RasterImage image = render(scene, options);
            double worst = 0, worstNormal = 0;
            size_t mismatches = 0;
            for (uint32_t y = 0; y < image.height; ++y)
                for (uint32_t x = 0; x < image.width; ++x) {
                    const size_t i = size_t(y) * image.width + x;
                    const Ray ray = pixelRay(options, x, y);
                    const SphereHit hit = hitSphere(ray, center, c.radius);
                    const bool exact = hit.near != infinity;
                    if (exact && !insideDepthRange(options, ray.at(hit.near)))
                        continue;
                    mismatches += image.covered(i) != exact;
                    if (!image.covered(i) || !exact)
                        continue;
                    const glm::dvec3 p = ray.at(hit.near);
                    const glm::dvec3 normal = (p - center) / c.radius;
                    const double slope = -glm::dot(ray.direction, normal);
                    const double scale = glm::length(p - ray.origin);
                    const double error = glm::length(worldPosition(image, x, y) - p) / scale;
                    worst = std::max(worst, error * slope - depthStep(kind, scale));
                    const double angle = angleBetween(
                        storedNormal(image, i), glm::dmat3(viewFromWorld(options.camera)) * normal);
                    // A step along the ray turns the normal by step / radius.
                    worstNormal =
                        std::max(worstNormal, angle * slope / std::max(1.0, scale / c.radius));
                }
            std::printf("ball r %g, projection %d: position x slope %.3g + step, normal %.3g\n",
                        c.radius, kind, worst, worstNormal);
            EXPECT_LE(mismatches, 2u); // pixel centres on the rim
            EXPECT_GT(image.coveredCount(), 1000u);
            EXPECT_LE(worst, 4e-7);
            EXPECT_LE(worstNormal, 2e-6);
        }
}

// The pixels in which a ball is seen, by a ray through the centre of each.
struct SeenPixels {
    glm::ivec2 first{INT_MAX}, end{0};
};

SeenPixels pixelsThatSee(const RasterOptions& options, const glm::dvec3& center, double radius)
{
    SeenPixels seen;
    const bool perspective = gbuffer::CameraTerms(options.camera, options.clearDepth).perspective;
    for (uint32_t y = 0; y < options.height; ++y)
        for (uint32_t x = 0; x < options.width; ++x) {
            const SphereHit hit = hitSphere(pixelRay(options, x, y), center, radius);
            if (hit.near == never || (perspective && hit.near <= 0))
                continue;
            seen.first = glm::min(seen.first, glm::ivec2(x, y));
            seen.end = glm::max(seen.end, glm::ivec2(x, y) + 1);
        }
    return seen;
}

// The pixels in which a ball is drawn are all that it covers, and no more than three at each side.
TEST_F(GBufferRays, BallsAreDrawnWhereTheyAreSeen)
{
    Random random(47);
    size_t tight = 0, behind = 0;
    for (int kind = 0; kind < 4; ++kind) {
        RasterOptions options = perspectiveOptions();
        setProjection(options, kind);
        lookAt(options.camera, {0.3, 1, 5.4}, {0, -0.2, 0});
        const gbuffer::CameraTerms camera(options.camera, options.clearDepth);
        const glm::ivec2 size(options.width, options.height);
        for (int i = 0; i < 200; ++i) {
            const glm::dvec3 center = random.box(7);
            const double radius = std::exp(random.uniform(std::log(0.1), std::log(3)));
            const glm::dvec3 view = camera.viewFrom(center);
            const VkRect2D area = camera.pixelsOfBall(view, radius, size.x, size.y);
            if (camera.perspective && view.z > radius + 1e-3) {
                ++behind;
                EXPECT_EQ(area.extent.width * area.extent.height, 0u);
            }
            const SeenPixels seen = pixelsThatSee(options, center, radius);
            if (seen.end.x == 0)
                continue; // not seen
            const glm::ivec2 first(area.offset.x, area.offset.y);
            const glm::ivec2 end = first + glm::ivec2(area.extent.width, area.extent.height);
            EXPECT_TRUE(glm::all(glm::lessThanEqual(first, seen.first)));
            EXPECT_TRUE(glm::all(glm::greaterThanEqual(end, seen.end)));
            // Balls beside the eye are drawn everywhere, and of balls that the image cuts off only
            // a part is seen.
            if (glm::any(glm::equal(first, glm::ivec2(0))) || glm::any(glm::equal(end, size)))
                continue;
            ++tight;
            EXPECT_TRUE(glm::all(glm::greaterThanEqual(first, seen.first - 3)));
            EXPECT_TRUE(glm::all(glm::lessThanEqual(end, seen.end + 3)));
        }
    }
    EXPECT_GT(tight, 100u);
    EXPECT_GT(behind, 5u);
}

// If the plane through the eye nearly touches a ball, rounding must not cut the ball off.
TEST_F(GBufferRays, BallsBesideTheEyeAreDrawnWhereTheyAreSeen)
{
    Random random(48);
    RasterOptions options = perspectiveOptions();
    lookAt(options.camera, {0, 0, 0}, {0, 0, -1});
    const gbuffer::CameraTerms camera(options.camera, options.clearDepth);
    size_t seenBalls = 0;
    for (int i = 0; i < 300; ++i) {
        const double radius = random.uniform(0.5, 4);
        const double gap = std::exp(random.uniform(std::log(1e-16), std::log(1e-6)));
        const glm::dvec3 center(random.uniform(-6, 6), random.uniform(-6, 6), -radius * (1 + gap));
        const VkRect2D area =
            camera.pixelsOfBall(camera.viewFrom(center), radius, options.width, options.height);
        const SeenPixels seen = pixelsThatSee(options, center, radius);
        if (seen.end.x == 0)
            continue;
        ++seenBalls;
        const glm::ivec2 first(area.offset.x, area.offset.y);
        const glm::ivec2 end = first + glm::ivec2(area.extent.width, area.extent.height);
        EXPECT_TRUE(glm::all(glm::lessThanEqual(first, seen.first))) << gap;
        EXPECT_TRUE(glm::all(glm::greaterThanEqual(end, seen.end))) << gap;
    }
    EXPECT_GT(seenBalls, 100u);
}

// Frames of balls on a plane, under every projection: a sum of all bits of the G-buffer is the same
// on every device.
TEST_F(GBufferRays, PlanesAndBallsHaveTheSameBitsOnEveryDevice)
{
    constexpr std::array<uint64_t, 4> expected{106874427405371083ull, 3831618650672795399ull,
                                               651389545891849883ull, 17549362541624671859ull};
    RasterScene scene;
    for (const float roughness : {0.2f, 0.9f}) {
        gbuffer::Material m = testMaterial();
        m.perceptualRoughness = roughness;
        scene.addMaterial(m);
    }
    scene.analyticObjects.push_back(plane({0, -1, 0}, {0, 1, 0}));
    Random random(46);
    for (int i = 0; i < 200; ++i) {
        const double radius = std::exp(random.uniform(std::log(0.01), std::log(1)));
        scene.analyticObjects.push_back(ball(random.box(3), radius));
        scene.analyticObjects.back().material = 1;
    }
    scene.analyticObjects.push_back(ball({0, 0, 7}, 1.5)); // the camera is close to it
    for (int kind = 0; kind < 4; ++kind) {
        RasterOptions options = perspectiveOptions();
        options.width = 320, options.height = 240;
        setProjection(options, kind);
        lookAt(options.camera, {0.3, 1, 5.4}, {0, -0.2, 0});
        const RasterImage image = render(scene, options);
        EXPECT_GT(image.coveredCount(), 40000u);
        app::Hash bits;
        const auto add = [&](const std::vector<glm::uvec2>& words) {
            for (const glm::uvec2& w : words)
                bits.add(w.x), bits.add(w.y);
        };
        add(image.normalRoughness);
        add(image.albedo);
        add(image.specular);
        bits.add(std::span<const float>(image.depth));
        EXPECT_EQ(bits.value(), expected[kind]) << "projection " << kind;
    }
}

// The stored materials of planes and balls have the bits of a second implementation of the format.
TEST_F(GBufferRays, MaterialsHaveTheSameBitsOnEveryDevice)
{
    RasterScene scene;
    CpuGBuffer expected;
    Random random(21);
    for (uint32_t i = 0; i < 12; ++i) {
        gbuffer::Material m{.metalness = float(i % 2),
                            .perceptualRoughness = float(random.uniform(0, 1))};
        for (int c = 0; c < 3; ++c)
            m.baseColor[c] = float(random.uniform(0, 1));
        scene.addMaterial(m);
        scene.analyticObjects.push_back(
            i < 2 ? plane({0, -2.0 - i, 0}, glm::normalize(glm::dvec3(0, 1, 0.1 * i)))
                  : ball({i % 5 - 2.0, i / 5 - 1.0, 0}, 0.45));
        scene.analyticObjects.back().material = i;
        const glm::dvec3 base = glm::make_vec3(m.baseColor);
        const glm::dvec3 dielectric = glm::make_vec3(m.dielectricF0);
        addPixel(expected, {.perceptualRoughness = double(m.perceptualRoughness),
                            .albedo = m.metalness == 1 ? glm::dvec3(0) : base,
                            .F0F90 = {m.metalness == 1 ? base : dielectric, 1}});
    }
    RasterOptions options = perspectiveOptions();
    lookAt(options.camera, {0, 0, 5}, {0, 0, 0});
    const RasterImage image = render(scene, options);
    using Bits = std::array<uint32_t, 6>;
    const auto bitsOf = [](const CpuGBuffer& g, size_t i) {
        constexpr uint32_t normal = (1u << gpu::NORMAL_BITS_FULL) - 1;
        const glm::uvec2 roughness = g.normalRoughness[i] & ~normal;
        return Bits{roughness.x,   roughness.y,     g.albedo[i].x,
                    g.albedo[i].y, g.specular[i].x, g.specular[i].y};
    };
    std::set<Bits> known, seen;
    for (size_t i = 0; i < scene.materials.size(); ++i)
        known.insert(bitsOf(expected, i));
    for (size_t i = 0; i < image.depth.size(); ++i)
        if (image.covered(i)) {
            seen.insert(bitsOf(image, i));
            ASSERT_TRUE(known.contains(bitsOf(image, i))) << i;
        }
    EXPECT_GT(seen.size(), 8u); // most objects are seen
}

class GBufferEmitters : public RasterTest
{
protected:
    // Finds the nearest light of each pixel in double precision; compares coverage, luminance and
    // depth.
    void expectRayCast(const RasterImage& image, const RasterOptions& options)
    {
        size_t onRim = 0, shown = 0;
        for (uint32_t y = 0; y < image.height; ++y)
            for (uint32_t x = 0; x < image.width; ++x) {
                const size_t i = size_t(y) * image.width + x;
                const Ray ray = pixelRay(options, x, y);
                double nearest = infinity, second = infinity;
                const CndLight* winner = nullptr;
                bool rim = false;
                for (const CndLight& light : options.emitters) {
                    const glm::dvec3 center = options.emitterOrigin + positionOf(light);
                    const SphereHit hit = hitSphere(ray, center, double(light.radius));
                    rim |= std::abs(hit.axisDistance - double(light.radius)) <
                           2e-6 * glm::length(center - ray.origin);
                    const double t = hit.near > 0 ? hit.near : hit.far;
                    if (hit.near == infinity || t <= 0)
                        continue;
                    second = std::min(second, std::max(t, nearest));
                    if (t < nearest) {
                        nearest = t;
                        winner = &light;
                    }
                }
                // Where two lights cross, rounding decides which of them is nearer.
                rim |=
                    winner && second - nearest < 2e-5 * glm::length(ray.at(nearest) - ray.origin);
                onRim += rim;
                if (rim)
                    continue;
                ASSERT_EQ(image.covered(i), winner != nullptr) << x << " " << y;
                if (!winner)
                    continue;
                ++shown;
                ASSERT_NO_FATAL_FAILURE(
                    expectEmitter(image, options, x, y, *winner, ray.at(nearest), 1e-4));
            }
        EXPECT_LE(onRim, image.depth.size() / 200);
        EXPECT_GT(shown, 100u);
    }

    static std::vector<CndLight> randomLights(uint32_t count, double size, uint32_t seed)
    {
        Random random(seed);
        std::vector<CndLight> lights;
        for (uint32_t i = 0; i < count; ++i)
            lights.push_back(sphereLight(random.box(size), std::pow(10, random.uniform(-2, 0.2)),
                                         {float(i), 1, 2}));
        return lights;
    }
};

TEST_F(GBufferEmitters, SilhouettesAreThoseOfTheRayCast)
{
    for (const CndGBufferLayout layout : {CND_GBUFFER_FULL, CND_GBUFFER_COMPACT})
        for (int kind = 0; kind < 4; ++kind) {
            SCOPED_TRACE(::testing::Message() << layout << " projection " << kind);
            RasterOptions options = perspectiveOptions();
            options.layout = layout;
            options.emitterOrigin = {3e5, 200, -7e5};
            options.emitters = randomLights(300, 8, uint32_t(kind));
            setProjection(options, kind);
            lookAt(options.camera, options.emitterOrigin + glm::dvec3(1, 14, 9),
                   options.emitterOrigin);
            expectRayCast(render(RasterScene{}, options), options);
        }
}

// Wide lenses with lights that touch the near plane, almost touch the eye, or contain it.
TEST_F(GBufferEmitters, CloseAndAroundTheCamera)
{
    gbuffer::GBuffer pass(device(), {.framesInFlight = 1});
    const gbuffer::Geometry geometry = uploadGeometry({});
    for (const double gap : {0.5, 0.05, 1e-3, 1e-5, -0.1, -0.9})
        for (const double fov : {0.5, 1.5, 2.6})
            for (const double side : {0.0, 0.7, 1.5, 2.5}) {
                SCOPED_TRACE(::testing::Message()
                             << "gap " << gap << " fov " << fov << " side " << side);
                RasterOptions options = perspectiveOptions();
                setPerspective(options.camera, fov, double(options.width) / options.height, 0.1);
                const glm::dvec3 direction(std::sin(side), 0.1, -std::cos(side));
                options.emitters = {
                    sphereLight(glm::normalize(direction) * (1 + gap), 1, {5, 6, 7}),
                    sphereLight({0, 0.4, -9}, 3, {8, 9, 10})};
                lookAt(options.camera, {0, 0, 0}, {0, 0, -1});
                expectRayCast(renderWith(pass, geometry, options), options);
            }
}

TEST_F(GBufferEmitters, HideAndAreHidden)
{
    RasterScene scene;
    scene.addMaterial(testMaterial());
    scene.analyticObjects.push_back(plane({0, 0, 0}, {0, 1, 0}));
    RasterOptions options = perspectiveOptions();
    lookAt(options.camera, {0, 2, 6}, {0, 0, 0});
    options.emitters = {sphereLight({0, 0, 0}, 1, {50, 60, 70})};
    const RasterImage image = render(scene, options);
    for (uint32_t y = 0; y < image.height; ++y)
        for (uint32_t x = 0; x < image.width; ++x) {
            const Ray ray = pixelRay(options, x, y);
            const double onPlane = hitPlane(ray, {0, 0, 0}, {0, 1, 0});
            const double onLight = hitSphere(ray, {0, 0, 0}, 1).near;
            if (std::abs(onPlane - onLight) < 1e-4)
                continue;
            const bool light = onLight < onPlane;
            ASSERT_EQ(image.radiance[size_t(y) * image.width + x].r,
                      light                ? 50
                      : onPlane < infinity ? testMaterial().emission[0]
                                           : 0);
        }
}

// Lights of other types are not drawn, and sets may grow and shrink between frames of two slots.
TEST_F(GBufferEmitters, SetsFollowTheFrames)
{
    gbuffer::GBuffer pass(device(), {.framesInFlight = 2});
    const gbuffer::Geometry geometry = uploadGeometry({});
    RasterOptions options = perspectiveOptions();
    lookAt(options.camera, {0, 1, 20}, {0, 0, 0});
    uint32_t frame = 0;
    for (const uint32_t count : {3u, 400u, 1u, 0u, 900u, 900u, 20u}) {
        SCOPED_TRACE(count);
        options.emitters = randomLights(count, 6, frame);
        if (count > 2)
            options.emitters[1].type = CND_LIGHT_SPOT;
        const RasterImage image = renderWith(pass, geometry, options, frame % 2);
        ++frame;
        if (count > 2)
            options.emitters.erase(options.emitters.begin() + 1);
        expectSameImage(image, render(RasterScene{}, options));
    }
    options.emitters = {sphereLight({0, 0, 0}, 0, {1, 1, 1})};
    const double origin[3] = {0, 0, 0};
    EXPECT_THROW(pass.setEmitters(options.emitters, origin), gpu::Failure);
}

} // namespace candelabra::test
