// SPDX-License-Identifier: Apache-2.0
// Tests the light of scenes that have none, how bright environments are, and added lights.
#include <cmath>
#include <ctime>
#include <limits>

#include "harness/constants.h"
#include "load/brightness.h"
#include "load/studio.h"
#include "shared/lighting_data.h"
#include "unit/gltf_fixture.h"

namespace candelabra::test
{
namespace
{

using namespace candelabra::app;

class DefaultLight : public GltfTest
{
protected:
    // Writes a uniform environment of this luminance and returns its path.
    std::string sky(float luminance)
    {
        Image image{.width = 64, .height = 32, .channels = 3, .pixels = {}};
        image.pixels.assign(64 * 32 * 3, luminance);
        const std::string path = folder_.path("sky.pfm");
        savePfm(path, image);
        return path;
    }
    static bool notes(const Scene& scene, const std::string& text)
    {
        return std::any_of(scene.notes.begin(), scene.notes.end(), [&](const std::string& note) {
            return note.find(text) != std::string::npos;
        });
    }
};

// A triangle with one light of KHR_lights_punctual.
GltfBuilder lit(const Json& light, const Json& node = Json::object())
{
    GltfBuilder builder = triangleScene();
    builder.json["extensionsUsed"] = {"KHR_lights_punctual"};
    builder.json["extensions"]["KHR_lights_punctual"]["lights"] = Json::array({light});
    Json placed = node;
    placed["extensions"]["KHR_lights_punctual"]["light"] = 0;
    builder.rootNode(placed);
    return builder;
}

TEST_F(DefaultLight, ScenesWithoutLightGetAStudioIfAskedFor)
{
    const Scene studio = load(triangleScene(), {.defaultLight = true});
    ASSERT_TRUE(studio.environment);
    EXPECT_EQ(studio.environment->file, "studio");
    // The white surface that faces the key light has the highest luminance of all, 1 cd/m^2. Steps
    // of 15 degrees miss its direction by so little that the cosine changes by 2% at most.
    double most = 0;
    for (double azimuth = 0; azimuth < 2 * pi; azimuth += pi / 12)
        for (double elevation = 0; elevation < pi / 2; elevation += pi / 12) {
            const glm::dvec3 normal(std::sin(azimuth) * std::cos(elevation), std::sin(elevation),
                                    std::cos(azimuth) * std::cos(elevation));
            most = std::max(most, planeIlluminance(*studio.environment, normal));
        }
    EXPECT_GT(most, 0.98 * pi);
    EXPECT_LT(most, 1.01 * pi);
    EXPECT_TRUE(notes(studio, "--default-light off"));
    EXPECT_TRUE(studio.warnings.empty());
    // A grey card that faces the key light: 0.18 of pi lx, divided by pi.
    EXPECT_NEAR(*studio.knownEv100, std::log2(0.18 * 100 / 12.5), 1e-3);
    // Unlit colours are meant for a screen, so white in the studio is as bright as theirs.
    GltfBuilder unlit = triangleScene();
    unlit.json["extensionsUsed"] = {"KHR_materials_unlit"};
    unlit.json["materials"] = Json::parse(R"([{"extensions": {"KHR_materials_unlit": {}}}])");
    unlit.json["meshes"][0]["primitives"][0]["material"] = 0;
    const Scene beside = load(unlit, {.defaultLight = true});
    EXPECT_NEAR(groundIlluminance(*beside.environment),
                groundIlluminance(*studio.environment) * double(unlitLuminance), 1e-3);
    EXPECT_NEAR(*beside.knownEv100, std::log2(0.18 * double(unlitLuminance) * 8), 1e-3);
    GltfBuilder bright = triangleScene();
    bright.json["materials"] = Json::parse(R"([{"emissiveFactor": [1, 1, 1],
        "extensions": {"KHR_materials_emissive_strength": {"emissiveStrength": 500}}}])");
    bright.json["meshes"][0]["primitives"][0]["material"] = 0;
    EXPECT_FALSE(load(bright, {.defaultLight = true}).knownEv100); // it would be white
    const Scene off = load(triangleScene());
    EXPECT_FALSE(off.environment);
    EXPECT_TRUE(warns(off, "has no lights"));
}

// A scene has unlit surfaces and glowing ones: which of them decide how bright white is depends on
// which have the larger area, in which faint glow counts for less.
TEST_F(DefaultLight, TheLargerOfUnlitAndGlowingSurfacesSaysWhatIsWhite)
{
    GltfBuilder b = triangleScene();
    b.json["extensionsUsed"] = {"KHR_materials_unlit"};
    b.json["materials"] = Json::parse(
        R"([{"emissiveFactor": [1, 1, 1]}, {"extensions": {"KHR_materials_unlit": {}}}])");
    b.json["meshes"][0]["primitives"][0]["material"] = 0;
    const Scene glowing = load(b, {.defaultLight = true});
    EXPECT_EQ(studioWhite(glowing), 1);
    ASSERT_TRUE(glowing.knownEv100);
    EXPECT_NEAR(*glowing.knownEv100, studioEv100(1), 1e-6);
    const int shown = b.mesh(b.json["meshes"][0]["primitives"][0]);
    b.json["meshes"][static_cast<size_t>(shown)]["primitives"][0]["material"] = 1;
    const int node = b.rootNode({{"mesh", shown}});
    for (const double scale : {0.9, 1.1}) { // at scale 1 both triangles have the same area
        b.json["nodes"][static_cast<size_t>(node)]["scale"] = {scale, scale, scale};
        EXPECT_EQ(studioWhite(load(b)), scale < 1 ? 1 : unlitLuminance) << scale;
    }
}

// A scene of an unlit triangle and of a glowing one, each half of a square of 1 m.
Scene unlitAndGlowing()
{
    Scene scene;
    Mesh mesh;
    for (const glm::vec2& corner : {glm::vec2(0, 0), glm::vec2(1, 0), glm::vec2(0, 1)})
        mesh.vertices.push_back({.position = glm::vec3(corner, 0)});
    mesh.indices = {0, 1, 2};
    scene.meshes = {mesh, mesh};
    scene.materials = {Material{.emission = glm::vec3(unlitLuminance), .unlit = true},
                       Material{.emission = glm::vec3(1)}};
    scene.instances = {Instance{.mesh = 0, .material = 0}, Instance{.mesh = 1, .material = 1}};
    return scene;
}

TEST_F(DefaultLight, SurfacesHaveTheAreaThatTheirTransformGivesThem)
{
    const auto white = [](Scene scene, const glm::dvec3& scale) {
        for (int axis = 0; axis < 3; ++axis)
            scene.instances[0].worldFromObject[axis] *= scale[axis];
        return studioWhite(scene);
    };
    Scene scene = unlitAndGlowing();
    EXPECT_EQ(white(scene, {4, 0.24, 9}), 1);
    EXPECT_EQ(white(scene, {4, 0.26, 0.01}), unlitLuminance);
    // Both meshes get a second triangle, which stands upright on the first.
    for (Mesh& mesh : scene.meshes) {
        mesh.vertices.push_back({.position = {0, 0, 1}});
        mesh.indices.insert(mesh.indices.end(), {0, 1, 3});
    }
    EXPECT_EQ(white(scene, {1, 1, 0.9}), 1);
    EXPECT_EQ(white(scene, {1, 1, 1.1}), unlitLuminance);
}

TEST_F(DefaultLight, FaintAndMostlyDarkGlowCountsForLess)
{
    // The glowing triangle is twice as large as the unlit one.
    const auto white = [](const glm::vec3& emission, const std::vector<uint8_t>& codes) {
        Scene scene = unlitAndGlowing();
        scene.instances[1].worldFromObject[0] *= 2.0;
        Material& material = scene.materials[1];
        material.emission = emission;
        if (!codes.empty()) {
            Texture texture{.width = static_cast<uint32_t>(codes.size()), .height = 1};
            for (const uint8_t code : codes)
                texture.rgba.insert(texture.rgba.end(), {code, code, code, 255});
            scene.textures.push_back(texture);
            material.emissiveTexture.texture = 0;
        }
        return studioWhite(scene);
    };
    EXPECT_EQ(white(glm::vec3(0.51f), {}), 1);
    EXPECT_EQ(white(glm::vec3(0.49f), {}), unlitLuminance);
    EXPECT_EQ(white({0, 0.71f, 0}, {}), 1); // green has 0.7152 of the luminance
    EXPECT_EQ(white({0.9f, 0, 0.9f}, {}), unlitLuminance);
    EXPECT_EQ(white(glm::vec3(1), {255, 255, 0}), 1);
    EXPECT_EQ(white(glm::vec3(1), {255, 0, 0}), unlitLuminance);
    EXPECT_EQ(white(glm::vec3(1), {190}), 1);              // 0.515 in linear values
    EXPECT_EQ(white(glm::vec3(1), {185}), unlitLuminance); // 0.485
    EXPECT_EQ(white(glm::vec3(1.6f), {255, 0, 0}), 1);
    // The lamp is no easier to see if it is brighter than white.
    Scene lamp = unlitAndGlowing();
    lamp.instances[1].worldFromObject[0] *= 0.9;
    lamp.materials[1].emission = glm::vec3(50);
    EXPECT_EQ(studioWhite(lamp), unlitLuminance);
}

// A small file may have very many triangles, because instances share meshes.
TEST_F(DefaultLight, TheTrianglesOfAMeshAreMeasuredOnce)
{
    Scene scene = unlitAndGlowing();
    for (Mesh& mesh : scene.meshes)
        mesh.indices.resize(300'000);
    for (const size_t material : {size_t{0}, size_t{1}})
        scene.instances.insert(scene.instances.end(), 100'000, Instance(scene.instances[material]));
    const std::clock_t start = std::clock();
    EXPECT_EQ(studioWhite(scene), unlitLuminance);
    const double seconds = double(std::clock() - start) / CLOCKS_PER_SEC;
    EXPECT_LT(seconds, 10); // 2e10 triangles would take minutes
}

TEST_F(DefaultLight, AnyLightOfTheSceneKeepsTheStudioAway)
{
    const SceneOptions options{.defaultLight = true};
    EXPECT_FALSE(load(lit({{"type", "point"}}), options).environment);
    // A light that is turned off is none.
    EXPECT_TRUE(load(lit({{"type", "point"}, {"intensity", 0}}), options).environment);
    SceneOptions more = options;
    more.lights = 3;
    EXPECT_FALSE(load(triangleScene(), more).environment);
    SceneOptions outside = options;
    outside.environment = sky(5);
    EXPECT_EQ(load(triangleScene(), outside).environment->file, outside.environment);
}

// The key light is above to the left of the camera, wherever the camera looks.
TEST_F(DefaultLight, TheKeyLightStandsBesideTheCamera)
{
    for (const glm::dvec3& forward :
         {glm::dvec3(0, 0, -1), glm::dvec3(1, -0.3, 0), glm::dvec3(-0.5, 0.2, 0.8)}) {
        const Camera camera{.forward = glm::normalize(forward)};
        const SceneEnvironment studio = studioEnvironment(camera, 1);
        glm::dvec3 brightest(0);
        float most = 0;
        for (uint32_t y = 0; y < studio.radiance.height; ++y)
            for (uint32_t x = 0; x < studio.radiance.width; ++x) {
                const float luminance =
                    studio.radiance.pixels[3 * (size_t(y) * studio.radiance.width + x)];
                if (luminance > most) {
                    most = luminance;
                    brightest = equirectangularDirection(studio.radiance, x, y);
                }
            }
        // Counter-clockwise seen from above, as SceneEnvironment::rotation.
        const double c = std::cos(studio.rotation), s = std::sin(studio.rotation);
        const glm::dvec3 key(c * brightest.x + s * brightest.z, brightest.y,
                             -s * brightest.x + c * brightest.z);
        const glm::dvec3 level = glm::normalize(glm::dvec3(forward.x, 0, forward.z));
        const glm::dvec3 right = glm::cross(level, glm::dvec3(0, 1, 0));
        EXPECT_GT(key.y, 0.5);
        EXPECT_LT(glm::dot(key, right), -0.3);
        EXPECT_LT(glm::dot(key, level), -0.3); // it shines from behind the camera
    }
}

TEST_F(DefaultLight, EnvironmentsAreMeasuredAndScaled)
{
    SceneOptions options{.environment = sky(20)};
    options.environmentScale = 3;
    const Scene scaled = load(triangleScene(), options);
    // Uniform surroundings of luminance L give any plane pi L.
    EXPECT_NEAR(groundIlluminance(*scaled.environment), 60 * pi, 1e-3);
    for (const glm::dvec3& normal : {glm::dvec3(0, 1, 0), glm::dvec3(0.6, -0.8, 0)})
        EXPECT_NEAR(planeIlluminance(*scaled.environment, normal), 60 * pi, 0.3);
    EXPECT_TRUE(notes(scaled, "188 lx on level ground"));
    options.environmentIlluminance = 15'000;
    const Scene wanted = load(triangleScene(), options);
    EXPECT_NEAR(groundIlluminance(*wanted.environment), 15'000, 0.01);
    EXPECT_TRUE(notes(wanted, "15000 lx on level ground"));
    options.environment = sky(0);
    EXPECT_NE(error(triangleScene(), options).find("gives level ground no light"),
              std::string::npos);
}

// Texels that are not a luminance are replaced, and counted in one warning.
TEST_F(DefaultLight, TexelsThatAreNoLuminanceAreCounted)
{
    Image image{.width = 64, .height = 32, .channels = 3, .pixels = {}};
    image.pixels.assign(64 * 32 * 3, 100);
    const std::string path = folder_.path("broken.pfm");
    savePfm(path, image);
    EXPECT_FALSE(warns(load(triangleScene(), {.environment = path}), "texels"));
    const float infinity = std::numeric_limits<float>::infinity();
    image.pixels[0] = 60'000;
    image.pixels[6] = image.pixels[7] = std::numeric_limits<float>::quiet_NaN(); // one texel
    image.pixels[9] = -1;
    image.pixels[12] = -infinity;
    image.pixels[15] = infinity;
    image.pixels[18] = 1e20f;
    savePfm(path, image);
    const Scene scene = load(triangleScene(), {.environment = path});
    EXPECT_TRUE(warns(scene, "of its 2048 texels 1 are NaN (0 is used), 2 negative (0 is used), 1 "
                             "infinite (2e+12 is used, the greatest of the others), 1 above 2e+12 "
                             "cd/m^2 (which is used)"));
    const std::vector<float>& pixels = scene.environment->radiance.pixels;
    for (const int i : {6, 7, 9, 12})
        EXPECT_EQ(pixels[size_t(i)], 0) << i;
    EXPECT_EQ(pixels[8], 100);
    EXPECT_EQ(pixels[15], 2e12f);
    EXPECT_EQ(pixels[18], 2e12f);
    EXPECT_TRUE(std::isfinite(groundIlluminance(*scene.environment)));
}

TEST_F(DefaultLight, AnEnvironmentThatDoesNotFitTheSunIsAWarning)
{
    const auto warned = [&](double sun, float luminance) {
        const Scene scene = load(lit({{"type", "directional"}, {"intensity", sun}}),
                                 {.environment = sky(luminance)});
        return warns(scene, "--environment-illuminance");
    };
    EXPECT_FALSE(warned(100'000, 5'000)); // 15,700 lx
    EXPECT_FALSE(warned(100'000, 400));
    EXPECT_TRUE(warned(100'000, 1));
    EXPECT_TRUE(warned(0.1, 100));
    EXPECT_FALSE(warned(0, 100)); // no sun
}

// Lights that are added to a file together give about what its own light gives.
TEST_F(DefaultLight, AddedLightsAreAsBrightAsThoseOfTheFile)
{
    for (const double sun : {0.5, 50.0, 100'000.0}) {
        const Json light{{"type", "directional"}, {"intensity", sun}};
        const GltfBuilder builder = lit(light);
        const double own = typicalIlluminance(load(builder));
        EXPECT_GT(own, 0.1 * sun);
        EXPECT_LE(own, sun);
        Scene more = load(builder, {.lights = 60});
        std::erase_if(more.lights, [](const CndLight& l) { return cndIsDistant(l.type); });
        ASSERT_EQ(more.lights.size(), 60u);
        const double added = typicalIlluminance(more);
        EXPECT_GT(added, 0.2 * own) << sun;
        EXPECT_LT(added, 5 * own) << sun;
    }
}

TEST_F(DefaultLight, AddedLightsDoNotStandInFrontOfACamera)
{
    GltfBuilder builder = triangleScene();
    builder.json["nodes"][0]["scale"] = {30, 30, 30};
    builder.json["cameras"] =
        Json::parse(R"([{"type": "perspective", "perspective": {"yfov": 1, "znear": 0.01}}])");
    builder.rootNode({{"camera", 0}, {"translation", {10, 10, 0}}}); // among the lights
    const Scene scene = load(builder, {.lights = 3000});
    double widest = 0;
    for (const CndLight& light : scene.lights) {
        const glm::dvec3 at(light.position[0], light.position[1], light.position[2]);
        widest = std::max(widest, double(light.radius) /
                                      glm::length(scene.lightOrigin + at - glm::dvec3(10, 10, 0)));
    }
    EXPECT_LE(widest, 1.0 / 59);
    EXPECT_GT(widest, 1.0 / 300); // the bound is not met because all lights are tiny
}

// Scene descriptions mean what they say: no studio takes the place of their background, nor of
// their dark lights.
TEST_F(DefaultLight, DescriptionsHaveTheirOwnLightOnly)
{
    Json json = Json::parse(R"({
        "camera": {"position": [0, 3, 6], "look_at": [0, 0.5, 0], "up": [0, 1, 0],
                   "vertical_fov_degrees": 50},
        "object": {"type": "sphere", "center": [0, 0, 0], "radius": 1},
        "material": {"albedo": [0.5, 0.5, 0.5], "alpha": 0.5},
        "lights": [], "background": [5, 6, 7]})");
    const auto described = [&] {
        return loadScene(folder_.write("scene.json", json.dump()), {.defaultLight = true});
    };
    const Scene background = described();
    EXPECT_FALSE(background.environment);
    EXPECT_FALSE(background.knownEv100);
    EXPECT_TRUE(background.notes.empty());
    json["background"] = {0, 0, 0};
    json["lights"] = Json::parse(R"([{"type": "point", "position": [0, 3, 0],
                                      "intensity": [0, 0, 0]}])");
    const Scene dark = described();
    EXPECT_FALSE(dark.environment);
    EXPECT_TRUE(notes(dark, "has no light, so it is dark; --environment FILE lights it"));
}

// The engine draws no lobe narrower than alpha 0.002: files with a narrower one get one warning.
TEST_F(DefaultLight, LobesThatAreTooNarrowAreAWarning)
{
    const auto warnings = [&](std::vector<double> roughness, const Json& extra = Json::object()) {
        GltfBuilder b = triangleScene();
        for (size_t i = 0; i < roughness.size(); ++i) {
            Json material{{"pbrMetallicRoughness", {{"roughnessFactor", roughness[i]}}}};
            material.update(extra);
            b.json["materials"].push_back(material);
            const int mesh = b.mesh(b.json["meshes"][0]["primitives"][0]);
            b.json["meshes"][size_t(mesh)]["primitives"][0]["material"] = i;
            b.rootNode({{"mesh", mesh}});
        }
        std::vector<std::string> out = load(b, {.defaultLight = true}).warnings;
        return out;
    };
    const auto narrow = warnings({0.5, 0.01, 0, 0.03});
    ASSERT_EQ(narrow.size(), 1u);
    EXPECT_NE(narrow[0].find("scene.gltf: material 1 (and 2 others): alpha, the square of its "
                             "roughness, is 0.0001; render uses 0.002"),
              std::string::npos)
        << narrow[0];
    EXPECT_TRUE(warnings({std::sqrt(0.002), 1}).empty());
    EXPECT_EQ(CND_MIN_ALPHA, gpu::MIN_ALPHA);
    EXPECT_TRUE(
        warnings({0.0}, {{"extensions", {{"KHR_materials_unlit", Json::object()}}}}).empty());
}

TEST_F(DefaultLight, ScenesWithoutAnythingToSeeAreRefused)
{
    EXPECT_NO_THROW(requireSomethingToDraw(load(triangleScene()), "a"));
    GltfBuilder empty;
    empty.rootNode({{"name", "nothing"}});
    const Scene scene = load(empty, {.defaultLight = true});
    EXPECT_FALSE(scene.environment);
    EXPECT_TRUE(scene.notes.empty()); // nothing says that a studio lights it
    try {
        requireSomethingToDraw(scene, "void.glb");
        ADD_FAILURE();
    } catch (const SceneError& nothing) {
        EXPECT_NE(std::string(nothing.what()).find("void.glb: nothing to draw"), std::string::npos);
    }
}

} // namespace
} // namespace candelabra::test
