// SPDX-License-Identifier: Apache-2.0
// Tests the procedural scenes and their lights.
#include <cmath>
#include <cstring>
#include <functional>
#include <limits>
#include <numbers>

#include <glm/gtc/matrix_transform.hpp>
#include <gtest/gtest.h>

#include "generate/generators.h"
#include "generate/hall.h"
#include "generate/lights.h"
#include "generate/ray_caster.h"
#include "generate/shapes.h"
#include "scene/scene_error.h"
#include "scene/scene_options.h"
#include "unit/scene_invariants.h"

namespace candelabra::app
{
namespace
{

SceneOptions withLights(uint32_t lights, uint32_t seed = 1)
{
    SceneOptions options;
    options.lights = lights;
    options.seed = seed;
    return options;
}

// Returns an FNV-1a hash of what a generator makes.
uint64_t fingerprint(const Scene& scene)
{
    uint64_t hash = 0xcbf29ce484222325ull;
    const auto add = [&hash](const void* data, size_t size) {
        for (size_t i = 0; i < size; ++i) {
            hash = (hash ^ static_cast<const unsigned char*>(data)[i]) * 0x100000001b3ull;
        }
    };
    for (const Instance& instance : scene.instances) {
        add(&instance.mesh, sizeof(instance.mesh));
        add(&instance.material, sizeof(instance.material));
        add(&instance.worldFromObject, sizeof(instance.worldFromObject));
    }
    for (const Mesh& mesh : scene.meshes) {
        add(mesh.vertices.data(), mesh.vertices.size() * sizeof(Vertex));
        add(mesh.indices.data(), mesh.indices.size() * sizeof(uint32_t));
    }
    for (const Texture& texture : scene.textures) {
        add(texture.rgba.data(), texture.rgba.size());
    }
    add(scene.lights.data(), scene.lights.size() * sizeof(CndLight));
    add(scene.lightMotions.data(), scene.lightMotions.size() * sizeof(LightMotion));
    return hash;
}

struct Seen {
    glm::dvec3 position{0}, normal{0}; // relative to the lights' origin
};

// Returns the points that camera 0 sees, on another grid than the generators use.
std::vector<Seen> seenPoints(const Scene& scene, uint32_t columns, uint32_t rows)
{
    std::vector<Seen> points;
    RayCaster caster(scene);
    for (uint32_t y = 0; y < rows; ++y) {
        for (uint32_t x = 0; x < columns; ++x) {
            const auto hit = caster.cast(cameraRay(scene.cameras[0], x, y, columns, rows));
            if (hit) {
                points.push_back({hit->position - scene.lightOrigin, hit->normal});
            }
        }
    }
    return points;
}

// Returns, averaged over the points, the number of lights whose influence contains the point and
// which are not wholly below its horizon; counts lights from index `first` on.
double meanContributing(const Scene& scene, const std::vector<Seen>& points, size_t first = 0)
{
    std::vector<CndLight> lights;
    lightsAtTime(scene, 0, lights);
    uint64_t pairs = 0;
    for (const Seen& point : points) {
        for (size_t i = first; i < lights.size(); ++i) {
            const CndLight& light = lights[i];
            const glm::dvec3 toLight =
                glm::dvec3(light.position[0], light.position[1], light.position[2]) -
                point.position;
            const double influence = light.influenceRadius;
            pairs += glm::dot(toLight, toLight) < influence * influence &&
                     glm::dot(toLight, point.normal) > -light.radius;
        }
    }
    return static_cast<double>(pairs) / static_cast<double>(points.size());
}

void expectSphereLights(const Scene& scene, size_t count)
{
    ASSERT_EQ(scene.lights.size(), count);
    for (const CndLight& light : scene.lights) {
        ASSERT_EQ(light.type, static_cast<uint32_t>(CND_LIGHT_SPHERE));
        ASSERT_GT(light.radius, 0);
        ASSERT_GT(light.influenceRadius, 2 * light.radius);
        float brightest = 0;
        for (int i = 0; i < 3; ++i) {
            ASSERT_TRUE(std::isfinite(light.position[i]));
            ASSERT_TRUE(std::isfinite(light.emission[i]) && light.emission[i] >= 0);
            brightest = std::max(brightest, light.emission[i]);
        }
        ASSERT_GT(brightest, 0);
    }
}

std::string errorOf(const std::function<void()>& act)
{
    try {
        act();
    } catch (const SceneError& error) {
        return error.what();
    }
    return "no error";
}

// Creates a room of 10 x 4 x 6 m, seen from inside, with a ball in it.
Scene makeRoom()
{
    Scene scene;
    scene.name = "room";
    scene.meshes = {makeBox(), makeSphere(16, 8)};
    scene.materials.resize(1);
    const auto wall = [&](const glm::dvec3& at, const glm::dvec3& size) {
        scene.instances.push_back({0, 0, glm::scale(glm::translate(glm::dmat4(1), at), size)});
    };
    wall({100, -0.1, 0}, {10, 0.2, 6});
    wall({100, 4.1, 0}, {10, 0.2, 6});
    wall({100, 2, -3.1}, {10, 4, 0.2});
    wall({105.1, 2, 0}, {0.2, 4, 6});
    scene.instances.push_back({1, 0, glm::translate(glm::dmat4(1), {102, 1, 0})});
    scene.cameras.push_back({.position = {96, 2, 0}, .forward = {1, 0, 0}});
    return scene;
}

// Parametrised by name, so that test names are readable and the same in every run.
class GeneratedScene : public testing::TestWithParam<std::string>
{
protected:
    static Scene make(const SceneOptions& options)
    {
        return GetParam() == "hall" ? generateHall(options) : generateField(options);
    }
};

INSTANTIATE_TEST_SUITE_P(Scenes, GeneratedScene, testing::Values("hall", "field"));

// The tests that the fence and the rooms pass too.
class AnyGeneratedScene : public testing::TestWithParam<std::string>
{
protected:
    static Scene make(const SceneOptions& options)
    {
        const std::string& name = GetParam();
        return name == "hall"    ? generateHall(options)
               : name == "field" ? generateField(options)
               : name == "fence" ? generateFence(options)
                                 : generateRooms(options);
    }
};

INSTANTIATE_TEST_SUITE_P(Scenes, AnyGeneratedScene,
                         testing::Values("hall", "field", "fence", "rooms"));

TEST_P(AnyGeneratedScene, DependsOnTheSeedAlone)
{
    SceneOptions options = withLights(500);
    options.moving = true;
    const uint64_t once = fingerprint(make(options));
    EXPECT_EQ(once, fingerprint(make(options)));
    options.seed = 2;
    EXPECT_NE(once, fingerprint(make(options)));
}

TEST_P(AnyGeneratedScene, HoldsWhatTheLoadersPromise)
{
    const Scene scene = make({});
    EXPECT_EQ(test::brokenInvariant(scene), "");
    expectSphereLights(scene, defaultLightCount);
    EXPECT_GE(scene.instances.size(), GetParam() == "rooms" ? 1892u : 3000u);
    EXPECT_LE(scene.instances.size(), 40000u);
    EXPECT_LE(scene.meshes.size(), 20u);
    size_t triangles = 0;
    for (const Instance& instance : scene.instances) {
        triangles += scene.meshes[instance.mesh].indices.size() / 3;
        // Mirrored instances would be inside out.
        ASSERT_GT(glm::determinant(glm::dmat3(instance.worldFromObject)), 0);
    }
    EXPECT_LE(triangles, 1500000u);
}

TEST_P(AnyGeneratedScene, IsTheSamePlaceForAnyNumberOfLights)
{
    Scene none = make(withLights(0)), some = make(withLights(100));
    EXPECT_TRUE(none.lights.empty());
    EXPECT_TRUE(none.lightMotions.empty());
    some.lights.clear();
    EXPECT_EQ(fingerprint(none), fingerprint(some));
}

TEST_P(GeneratedScene, MixesMirrorsAndRoughMetalsAndDielectrics)
{
    const Scene scene = make(withLights(0));
    float smoothest = 1, roughest = 0;
    size_t metals = 0, dielectrics = 0;
    for (const Material& material : scene.materials) {
        smoothest = std::min(smoothest, material.perceptualRoughness);
        roughest = std::max(roughest, material.perceptualRoughness);
        (material.metalness == 1 ? metals : dielectrics) += 1;
    }
    EXPECT_LT(smoothest, 0.1f);
    EXPECT_GT(roughest, 0.8f);
    EXPECT_GE(metals, 3u);
    EXPECT_GE(dielectrics, 8u);
}

TEST_P(GeneratedScene, ReachesTheDefaultOverlapsForAnyNumberOfLights)
{
    const std::vector<Seen> points = seenPoints(make(withLights(0)), 83, 47);
    ASSERT_GT(points.size(), 2000u);
    for (const uint32_t count : {1000u, 4000u, 30000u}) {
        const Scene scene = make(withLights(count));
        expectSphereLights(scene, count);
        EXPECT_NEAR(meanContributing(scene, points), 8, 0.5) << count;
    }
}

TEST_P(GeneratedScene, ReachesOtherOverlapsAndSeeds)
{
    const std::vector<Seen> points = seenPoints(make(withLights(0, 9)), 83, 47);
    for (const double overlaps : {0.5, 3.0, 100.0}) {
        SceneOptions options = withLights(2000, 9);
        options.overlaps = overlaps;
        options.moving = true;
        EXPECT_NEAR(meanContributing(make(options), points), overlaps, 0.07 * overlaps);
    }
}

TEST_P(GeneratedScene, MakesAMillionLights)
{
    const Scene scene = make(withLights(1000000));
    expectSphereLights(scene, 1000000);
    // Only few points, because every light is tried for each. The tolerance is 5 standard errors of
    // a mean of 8 (standard deviation below 8).
    EXPECT_NEAR(meanContributing(scene, seenPoints(scene, 19, 11)), 8, 3);
}

TEST_P(GeneratedScene, MovingLightsStayOverTheFloor)
{
    SceneOptions options = withLights(3000);
    options.moving = true;
    const Scene scene = make(options);
    ASSERT_EQ(scene.lightMotions.size(), 3000u);
    for (size_t i = 0; i < scene.lights.size(); ++i) {
        const LightMotion& motion = scene.lightMotions[i];
        // The lowest point of the ellipse that the circle's vertical components describe.
        const float dip = std::hypot(motion.axisU.y, motion.axisV.y);
        const double height = scene.lightOrigin.y + scene.lights[i].position[1];
        ASSERT_GT(height - dip, 0) << i;
        ASSERT_GT(std::abs(motion.angularSpeed), 0);
        ASSERT_GE(glm::length(motion.axisU), 0.19f);
    }
    // Apart from the offset on the circle, they start where the resting lights are.
    options.moving = false;
    const Scene resting = make(options);
    EXPECT_TRUE(resting.lightMotions.empty());
    for (size_t i = 0; i < scene.lights.size(); ++i) {
        ASSERT_EQ(
            0, std::memcmp(scene.lights[i].position, resting.lights[i].position, sizeof(float[3])));
    }
}

TEST_P(GeneratedScene, RefusesOptionsThatMakeNoSense)
{
    SceneOptions options = withLights(100);
    for (const double bad : {0.0, -1.0, 101.0, std::nan(""), HUGE_VAL}) {
        options.overlaps = bad;
        EXPECT_NE(errorOf([&] { make(options); }).find(": overlaps: "), std::string::npos)
            << bad << ": " << errorOf([&] { make(options); });
    }
    // Some lights are always occluded by a surface.
    options.overlaps = 100;
    EXPECT_NE(errorOf([&] { make(options); }).find("cannot be reached with 100 lights"),
              std::string::npos);
    options = withLights(0xffffffffu);
    EXPECT_NE(errorOf([&] { make(options); }).find(": lights: "), std::string::npos);
    // Without explicit overlaps, a small number of lights is no error.
    EXPECT_EQ(make(withLights(1)).lights.size(), 1u);
    EXPECT_EQ(make(withLights(5)).lights.size(), 5u);
}

TEST(LightColours, HaveUnitLuminance)
{
    const glm::vec3 weights(0.2126f, 0.7152f, 0.0722f);
    for (const float kelvin : {1700.0f, 2222.0f, 2700.0f, 4000.0f, 6504.0f, 20000.0f}) {
        EXPECT_NEAR(glm::dot(blackbodyColour(kelvin), weights), 1, 1e-5f);
    }
    for (const float hue : {0.0f, 0.2f, 0.5f, 0.9f, -1.3f, 7.25f}) {
        EXPECT_NEAR(glm::dot(hueColour(hue, 0.7f), weights), 1, 1e-5f);
    }
    // 6504 K is close to the white of D65, 2000 K is very red, 20000 K is blue.
    const glm::vec3 white = blackbodyColour(6504);
    EXPECT_NEAR(white.r / white.b, 1, 0.1f);
    EXPECT_GT(blackbodyColour(2000).r, 5 * blackbodyColour(2000).b);
    EXPECT_GT(blackbodyColour(20000).b, 1.5f * blackbodyColour(20000).r);
    EXPECT_EQ(hueColour(1.0f / 3.0f, 1).r, 0);
}

// Returns the value of the brightest channel.
float peakOf(const CndLight& light)
{
    return std::max({light.emission[0], light.emission[1], light.emission[2]});
}

size_t keyLightCount()
{
    Random random(1);
    return hall::keyLights(defaultLightCount, false, random).size();
}

TEST(Hall, KeyLightsAreTheSameForAnyNumberOfLights)
{
    const Scene usual = generateHall({});
    const size_t keys = keyLightCount();
    EXPECT_LT(keys, 250u);
    for (const uint32_t count : {300u, 1000u, 16000u, 64000u}) {
        const Scene scene = generateHall(withLights(count));
        // The lamps of the chandeliers come first. They are meant to reach 13 m.
        EXPECT_NEAR(scene.lights[0].influenceRadius, 13, 0.15 * 13) << count;
        for (size_t i = 0; i < keys; ++i) {
            const CndLight &a = scene.lights[i], &b = usual.lights[i];
            ASSERT_EQ(0, std::memcmp(a.position, b.position, sizeof(a.position))) << i;
            ASSERT_EQ(0, std::memcmp(a.emission, b.emission, sizeof(a.emission))) << i;
            ASSERT_EQ(a.radius, b.radius) << i;
        }
    }
}

glm::dvec3 centreOf(const Scene& scene, const CndLight& light)
{
    return scene.lightOrigin + glm::dvec3(light.position[0], light.position[1], light.position[2]);
}

// The key lights are lamps inside the hall and the evening sky outside.
bool isLamp(const CndLight& light)
{
    return light.radius < 0.5f;
}

// No surface reaches into a lamp, and much of its light gets past what holds it. Of the lamps in
// the corners half shines into the walls.
TEST(Hall, LampsAreOpen)
{
    const Scene scene = generateHall(withLights(300));
    RayCaster caster(scene);
    Random random(3);
    for (size_t i = 0; i < keyLightCount(); ++i) {
        const CndLight& light = scene.lights[i];
        if (!isLamp(light))
            continue;
        constexpr double beyondCage = 0.7; // metres
        constexpr int rays = 400;
        int free = 0;
        for (int ray = 0; ray < rays; ++ray) {
            const double y = random.uniform(-1, 1), across = std::sqrt(1 - y * y);
            const double angle = 2 * std::numbers::pi * double(random.uniform());
            const auto hit = caster.cast(
                {centreOf(scene, light), {across * std::cos(angle), y, across * std::sin(angle)}});
            ASSERT_TRUE(!hit || hit->distance > double{light.radius} - 1e-5) << i;
            free += !hit || hit->distance > beyondCage;
        }
        EXPECT_GT(free, rays / 3) << i;
    }
}

TEST(Hall, TheSkyShinesInThroughOpenings)
{
    const Scene scene = generateHall(withLights(300));
    RayCaster caster(scene);
    Random random(4);
    for (size_t i = 0; i < keyLightCount(); ++i) {
        const CndLight& light = scene.lights[i];
        if (isLamp(light))
            continue;
        const glm::dvec3 centre = centreOf(scene, light);
        const double near = std::clamp(centre.x, 10 - hall::halfLength, hall::halfLength - 10);
        int arrived = 0;
        for (int ray = 0; ray < 300; ++ray) {
            const glm::dvec3 target{near + double(random.uniform(-9, 9)),
                                    double(random.uniform(0.5f, 12)),
                                    double(random.uniform(-5, 5))};
            const double distance = glm::length(target - centre);
            const auto hit = caster.cast({centre, (target - centre) / distance});
            arrived += !hit || hit->distance > distance;
        }
        EXPECT_GT(arrived, 10) << i;
    }
}

TEST(Hall, LightsInSightAreSmallAndKeepTheirLuminance)
{
    for (const uint32_t count : {1000u, 16000u}) {
        const Scene scene = generateHall(withLights(count));
        for (size_t i = keyLightCount(); i < scene.lights.size(); ++i) {
            const CndLight& light = scene.lights[i];
            ASSERT_LE(light.radius, 0.0221f * light.influenceRadius) << i;
            ASSERT_GT(peakOf(light), 279) << i;
            ASSERT_LT(peakOf(light), 561) << i;
        }
    }
}

TEST(Showcase, LampsAreDimEnoughForADisplayToShowTheirColour)
{
    const Scene scene = generateShowcase({});
    for (const CndLight& light : scene.lights) {
        if (cndIsPunctual(light.type))
            continue;
        EXPECT_LT(peakOf(light), 7.01f) << light.type;
        EXPECT_GT(peakOf(light),
                  3 * std::min({light.emission[0], light.emission[1], light.emission[2]}))
            << light.type;
    }
    // Moving lamps have no holders.
    EXPECT_LT(generateShowcase({.moving = true}).analyticObjects.size(),
              scene.analyticObjects.size());
}

TEST(GeneratedScenes, GlowByTheirLightsAlone)
{
    for (const Scene& scene : {generateHall({}), generateField({}), generateFence({}),
                               generateRooms({}), generateShowcase({})}) {
        for (const Material& material : scene.materials) {
            EXPECT_EQ(material.emission, glm::vec3(0)) << scene.name << ": " << material.name;
            EXPECT_FALSE(material.unlit) << scene.name << ": " << material.name;
        }
    }
}

// Every other light is below the floor, which only the part above the horizon passes.
TEST(SphereLights, KeepTheLuminanceThatTheirSiteGives)
{
    Scene scene = makeRoom();
    Random random(5);
    std::vector<LightSite> sites(600);
    for (size_t i = 0; i < sites.size(); ++i) {
        sites[i].position = {95 + 10 * random.uniform(), i % 2 ? 4 * random.uniform() : -0.05f,
                             6 * random.uniform() - 3};
        sites[i].radius = 0.3f;
        sites[i].radiusShare = 0.08f;
        sites[i].colour = hueColour(0.3f, 0.5f);
        sites[i].luminance = luminanceOfPeak(sites[i].colour, 50);
    }
    addSphereLights(scene, sites, {});
    expectSphereLights(scene, sites.size());
    for (const CndLight& light : scene.lights) {
        ASSERT_NEAR(peakOf(light), 50, 1e-4);
        ASSERT_FLOAT_EQ(light.radius, std::min(0.3f, 0.08f * light.influenceRadius));
    }
    EXPECT_NEAR(meanContributing(scene, seenPoints(scene, 83, 47)), 8, 0.4);
}

TEST(RandomLights, FillTheBoundsAndReachTheOverlaps)
{
    for (const bool moving : {false, true}) {
        Scene scene = makeRoom();
        SceneOptions options = withLights(700);
        options.moving = moving;
        addRandomLights(scene, options);
        expectSphereLights(scene, 700);
        EXPECT_EQ(scene.lightMotions.size(), moving ? 700u : 0u);
        const Bounds bounds = sceneBounds(scene);
        for (const CndLight& light : scene.lights) {
            const glm::dvec3 p =
                scene.lightOrigin +
                glm::dvec3(light.position[0], light.position[1], light.position[2]);
            ASSERT_TRUE(glm::all(glm::greaterThan(p, bounds.min - 1e-3)) &&
                        glm::all(glm::lessThan(p, bounds.max + 1e-3)));
        }
        EXPECT_NEAR(meanContributing(scene, seenPoints(scene, 83, 47)), 8, 0.4);
    }
}

TEST(RandomLights, LeaveTheLightsOfTheSceneAlone)
{
    Scene scene = makeRoom();
    CndLight own{};
    own.type = CND_LIGHT_POINT;
    own.position[0] = 3;
    own.emission[1] = 20;
    own.influenceRadius = std::numeric_limits<float>::infinity();
    scene.lights = {own};
    scene.lightOrigin = {98, 1, 0};
    SceneOptions options = withLights(300);
    options.moving = true;
    options.overlaps = 20;
    addRandomLights(scene, options);
    ASSERT_EQ(scene.lights.size(), 301u);
    EXPECT_EQ(scene.lightOrigin, glm::dvec3(98, 1, 0));
    EXPECT_EQ(0, std::memcmp(&scene.lights[0], &own, sizeof(own)));
    ASSERT_EQ(scene.lightMotions.size(), 301u);
    EXPECT_EQ(scene.lightMotions[0].axisU, glm::vec3(0));
    EXPECT_NEAR(meanContributing(scene, seenPoints(scene, 83, 47), 1), 20, 1);
}

TEST(RandomLights, NeedMeshesToLight)
{
    Scene empty;
    empty.name = "empty.gltf";
    EXPECT_EQ(
        errorOf([&] { addRandomLights(empty, withLights(10)); }),
        "empty.gltf: lights: random lights need meshes that span at least a micrometre, these "
        "span 0 m");
    EXPECT_NO_THROW(addRandomLights(empty, {}));
    EXPECT_TRUE(empty.lights.empty());
}

TEST(RandomLights, WorkWhenTheCameraSeesNothing)
{
    Scene scene = makeRoom();
    scene.cameras[0].forward = {-1, 0, 0};
    addRandomLights(scene, withLights(200));
    expectSphereLights(scene, 200);
    scene = makeRoom();
    scene.cameras.clear();
    addRandomLights(scene, withLights(200));
    expectSphereLights(scene, 200);
}

} // namespace
} // namespace candelabra::app
