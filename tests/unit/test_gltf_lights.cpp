// SPDX-License-Identifier: Apache-2.0
// Tests KHR_lights_punctual and KHR_lights_area: units, directions, radii, influence.
#include <cmath>

#include "harness/constants.h"
#include "unit/gltf_fixture.h"

namespace candelabra::test
{

namespace
{

using namespace candelabra::app;

class GltfLights : public GltfTest
{
protected:
    // Returns a scene that contains only these lights; light i is at (i, 2, 3).
    static GltfBuilder scene(const char* extension, const char* lights)
    {
        GltfBuilder b;
        b.json["extensionsUsed"] = {extension};
        b.json["extensions"][extension]["lights"] = Json::parse(lights);
        for (size_t i = 0; i < b.json["extensions"][extension]["lights"].size(); ++i)
            b.rootNode({{"translation", {i, 2, 3}}, {"extensions", {{extension, {{"light", i}}}}}});
        return b;
    }
};

TEST_F(GltfLights, PunctualUnits)
{
    const Scene s = load(scene("KHR_lights_punctual", R"([
        {"type": "point", "intensity": 5000000000, "color": [1, 0.5, 0], "range": 4},
        {"type": "spot", "intensity": 100, "spot": {"innerConeAngle": 0.1, "outerConeAngle": 0.5}},
        {"type": "spot", "spot": {}},
        {"type": "directional", "intensity": 10000}])"));
    ASSERT_EQ(s.lights.size(), 4u);
    EXPECT_EQ(s.lights[0].type, uint32_t{CND_LIGHT_POINT});
    EXPECT_EQ(s.lights[0].emission[0], 5e9f); // cd
    EXPECT_EQ(s.lights[0].emission[1], 2.5e9f);
    EXPECT_EQ(s.lights[0].influenceRadius, 4);
    EXPECT_EQ(s.lights[1].type, uint32_t{CND_LIGHT_SPOT});
    EXPECT_EQ(s.lights[1].emission[2], 100); // cd on the axis
    EXPECT_TRUE(std::isinf(s.lights[1].influenceRadius));
    EXPECT_EQ(s.lights[1].innerConeAngle, 0.1f);
    EXPECT_EQ(s.lights[1].outerConeAngle, 0.5f);
    EXPECT_EQ(s.lights[1].position[0], 1);
    EXPECT_EQ(s.lights[1].position[1], 2);
    EXPECT_EQ(s.lights[1].position[2], 3);
    EXPECT_EQ(s.lights[2].emission[0], 1); // the extension's defaults
    EXPECT_EQ(s.lights[2].innerConeAngle, 0);
    EXPECT_FLOAT_EQ(s.lights[2].outerConeAngle, static_cast<float>(pi / 4));
    EXPECT_EQ(s.lights[3].type, uint32_t{CND_LIGHT_DIRECTIONAL});
    EXPECT_EQ(s.lights[3].emission[0], 10000); // lx
    EXPECT_EQ(s.lights[3].direction[2], -1);
    EXPECT_TRUE(s.warnings.empty());
}

TEST_F(GltfLights, DirectionsFollowNodesAndIgnoreScale)
{
    GltfBuilder b = scene("KHR_lights_punctual",
                          R"([{"type": "spot", "intensity": 7, "spot": {"outerConeAngle": 0.5}}])");
    const double s = std::sqrt(0.5);
    b.json["nodes"][0]["scale"] = {3, 4, 5};
    b.json["nodes"].push_back({{"children", {0}}, {"rotation", {-s, 0, 0, s}}}); // -z -> -y
    b.json["scenes"][0]["nodes"] = {1};
    const Scene loaded = load(b);
    const CndLight& light = loaded.lights.at(0);
    EXPECT_NEAR(light.direction[1], -1, 1e-6);
    EXPECT_EQ(light.emission[0], 7);
    EXPECT_NEAR(light.position[0], 0, 1e-6);
    EXPECT_NEAR(light.position[1], 3, 1e-6); // (0, 2, 3) -> (0, 3, -2)
    EXPECT_NEAR(light.position[2], -2, 1e-6);
}

TEST_F(GltfLights, RadiusMakesASphereOfTheSameIntensity)
{
    const char* lights = R"([
        {"type": "point", "intensity": 50, "range": 9, "extras": {"radius": 0.25}},
        {"type": "point", "intensity": 50},
        {"type": "point", "extras": "radius"},
        {"type": "spot", "spot": {}}])";
    const Scene plain = load(scene("KHR_lights_punctual", lights));
    EXPECT_EQ(plain.lights[0].type, uint32_t{CND_LIGHT_SPHERE});
    EXPECT_EQ(plain.lights[0].radius, 0.25f);
    EXPECT_EQ(plain.lights[0].influenceRadius, 9);
    // I = pi R^2 L
    EXPECT_NEAR(plain.lights[0].emission[0] * pi * 0.25 * 0.25, 50, 1e-4);
    EXPECT_EQ(plain.lights[1].type, uint32_t{CND_LIGHT_POINT});
    EXPECT_EQ(plain.lights[2].type, uint32_t{CND_LIGHT_POINT});
    EXPECT_EQ(plain.lights[3].type, uint32_t{CND_LIGHT_SPOT});
    EXPECT_TRUE(plain.warnings.empty());

    SceneOptions options;
    options.punctualRadius = 0.5;
    const Scene sized = load(scene("KHR_lights_punctual", lights), options);
    EXPECT_EQ(sized.lights[0].radius, 0.25f); // its own radius
    EXPECT_EQ(sized.lights[1].type, uint32_t{CND_LIGHT_SPHERE});
    EXPECT_EQ(sized.lights[1].radius, 0.5f);
    EXPECT_NEAR(sized.lights[1].emission[0] * pi * 0.25, 50, 1e-4);
    EXPECT_EQ(sized.lights[3].type, uint32_t{CND_LIGHT_SPOT});
}

// glTF 2.0 wants the inner angle to be smaller, but exporters write equal ones for hard edges.
TEST_F(GltfLights, ConesThatTheLibraryRefusesAreReplaced)
{
    const struct {
        double inner, outer;
        double usedInner, usedOuter;
    } cases[] = {
        {0.5, 0.5, 0.5 - 1e-5, 0.5},
        {0.02, 0.02, 0.02 - 1e-5, 0.02},
        {0.6, 0.5, 0.5 - 1e-5, 0.5},
        {1e-9, 1e-8, 0, 1e-5},
        {0, 0, 0, 1e-5},
        {1.5707963, 1.5707963, pi / 2 - 1e-5, pi / 2},
        {0.1, 2, 0.1, pi / 2},
        {-0.1, 0.5, 0, 0.5},
        {0.3, -1, 0.3, pi / 4},
        {3e4, 1e-4, 9e-5, 1e-4},
    };
    for (const auto& c : cases) {
        Json lights = Json::parse(R"([{"type": "spot"}])");
        lights[0]["spot"] = {{"innerConeAngle", c.inner}, {"outerConeAngle", c.outer}};
        const Scene s = load(scene("KHR_lights_punctual", lights.dump().c_str()));
        const CndLight& light = s.lights.at(0);
        EXPECT_NEAR(light.innerConeAngle, c.usedInner, 3e-7) << c.inner << " " << c.outer;
        EXPECT_NEAR(light.outerConeAngle, c.usedOuter, 3e-7) << c.inner << " " << c.outer;
        EXPECT_GE(light.outerConeAngle - light.innerConeAngle, CND_MIN_CONE_EDGE);
        EXPECT_TRUE(warns(s, "lights[0].spot")) << c.inner << " " << c.outer;
        EXPECT_TRUE(warns(s, "used")) << c.inner << " " << c.outer;
    }
    // A narrow or hard cone that is valid stays as it is.
    const Scene s = load(scene("KHR_lights_punctual", R"([
        {"type": "spot", "spot": {"innerConeAngle": 0, "outerConeAngle": 2e-5}},
        {"type": "spot", "spot": {"innerConeAngle": 0.4999, "outerConeAngle": 0.5}},
        {"type": "spot", "spot": {"innerConeAngle": 0.4999, "outerConeAngle": 1.5707964}}])"));
    EXPECT_TRUE(s.warnings.empty());
    EXPECT_EQ(s.lights.at(0).outerConeAngle, 2e-5f);
    EXPECT_EQ(s.lights.at(1).innerConeAngle, 0.4999f);
}

TEST_F(GltfLights, SpotsWithARadiusBecomeDiscs)
{
    const Scene s = load(scene("KHR_lights_punctual", R"([
        {"type": "spot", "intensity": 50, "range": 9, "spot": {}, "extras": {"radius": 0.25}}])"));
    const CndLight& disc = s.lights.at(0);
    EXPECT_EQ(disc.type, uint32_t{CND_LIGHT_DISC});
    EXPECT_EQ(disc.radius, 0.25f);
    EXPECT_EQ(disc.direction[2], -1);
    EXPECT_FALSE(disc.twoSided);
    EXPECT_NEAR(disc.emission[0] * pi * 0.25 * 0.25, 50, 1e-4); // cd along the axis
    ASSERT_EQ(s.warnings.size(), 1u);
    EXPECT_TRUE(warns(s, "lights[0]: is a spot with a radius, so it becomes a disc"));
}

// Lights are shared by nodes, so a node's own radius comes first.
TEST_F(GltfLights, NodesGiveARadius)
{
    GltfBuilder b = scene("KHR_lights_punctual", R"([
        {"type": "point", "intensity": 50, "extras": {"radius": 0.25}}, {"type": "point"},
        {"type": "point"}, {"type": "point"}, {"type": "directional"}])");
    b.json["nodes"][0]["extras"] = {{"radius", 2}};
    b.json["nodes"][1]["extras"] = {{"radius", 3}};
    b.json["nodes"][4]["extras"] = {{"radius", 4}};
    // Older exporters of Blender put the light below the node of the object.
    b.json["nodes"][2]["name"] = "Lamp_Orientation";
    b.json["nodes"][3]["name"] = "Lamp";
    for (const int child : {2, 3})
        b.json["nodes"].push_back(
            {{"name", "Lamp"}, {"children", {child}}, {"extras", {{"radius", 0.5}}}});
    b.json["scenes"][0]["nodes"] = {0, 1, 4, 5, 6};
    const Scene s = load(b);
    ASSERT_EQ(s.lights.size(), 5u);
    EXPECT_EQ(s.lights[0].radius, 2);
    EXPECT_NEAR(s.lights[0].emission[0] * pi * 4, 50, 1e-4);
    EXPECT_EQ(s.lights[1].radius, 3);
    EXPECT_EQ(s.lights[2].type, uint32_t{CND_LIGHT_DIRECTIONAL});
    EXPECT_TRUE(warns(s, "nodes[4]: has a radius, which directional lights do not use"));
    EXPECT_EQ(s.lights[3].radius, 0.5f);
    EXPECT_EQ(s.lights[4].type, uint32_t{CND_LIGHT_POINT});
    b.json["nodes"][1]["extras"] = {{"radius", -3}};
    EXPECT_TRUE(warns(load(b), "nodes[1].extras.radius: must be >= 1e-15, is -3"));
}

TEST_F(GltfLights, AreaSpheresScaleWithTheirNodes)
{
    GltfBuilder b = scene("KHR_lights_area", R"([
        {"shape": "sphere", "intensity": 3000000000, "radius": 0.5, "color": [1, 0.5, 0],
         "range": 20},
        {"type": "sphere"}])");
    b.json["nodes"][0]["scale"] = {4, 4, 4};
    const Scene s = load(b);
    ASSERT_EQ(s.lights.size(), 2u);
    EXPECT_EQ(s.lights[0].type, uint32_t{CND_LIGHT_SPHERE});
    EXPECT_FLOAT_EQ(s.lights[0].radius, 2);
    EXPECT_EQ(s.lights[0].emission[0], 3e9f); // cd/m^2
    EXPECT_EQ(s.lights[0].emission[1], 1.5e9f);
    EXPECT_EQ(s.lights[0].influenceRadius, 20);
    EXPECT_EQ(s.lights[1].radius, 1); // the proposal's defaults
    EXPECT_EQ(s.lights[1].emission[0], 1);
    EXPECT_TRUE(std::isinf(s.lights[1].influenceRadius));
    EXPECT_TRUE(s.warnings.empty());
}

TEST_F(GltfLights, AreaRectsAndDisksFaceMinusZ)
{
    GltfBuilder b = scene("KHR_lights_area", R"([
        {"shape": "rect", "width": 2, "height": 0.5, "intensity": 300},
        {"shape": "disk", "radius": 0.5, "intensity": 7, "range": 4}])");
    for (auto& node : b.json["nodes"])
        node["scale"] = {2, 3, 5};
    const Scene s = load(b);
    ASSERT_EQ(s.lights.size(), 2u);
    const CndLight& rect = s.lights[0];
    EXPECT_EQ(rect.type, uint32_t{CND_LIGHT_RECTANGLE});
    EXPECT_EQ(rect.axisU[0], 2); // half of 2 m, scaled by 2
    EXPECT_EQ(rect.axisV[1], -0.75f);
    EXPECT_EQ(rect.emission[0], 300);
    EXPECT_FALSE(rect.twoSided);
    const CndLight& disk = s.lights[1];
    EXPECT_EQ(disk.type, uint32_t{CND_LIGHT_DISC});
    EXPECT_FLOAT_EQ(disk.radius, float(0.5 * std::sqrt(6.0)));
    EXPECT_EQ(disk.direction[2], -1);
    EXPECT_EQ(disk.influenceRadius, 4);
    ASSERT_EQ(s.warnings.size(), 1u);
    EXPECT_NE(s.warnings[0].find("it stays a disk"), std::string::npos) << s.warnings[0];
    EXPECT_TRUE(warns(load(scene("KHR_lights_area", R"([{"shape": "rect", "range": 0.5}])")),
                      "lights[0].range: must be greater than half the light's diagonal, 0.707107, "
                      "is 0.5; the light has no range"));
}

// The emitting side faces where the node's -z points, also through a mirror. If the scale of z is
// 0, the side of the node without mirroring emits.
TEST_F(GltfLights, MirroredAndFlatAreaLights)
{
    const glm::dvec3 scales[] = {{1, 1, 1},   {-2, 1, 1}, {1, -2, 1},  {1, 1, -1},
                                 {-1, -1, 1}, {1, 1, 0},  {-1, -2, -1}};
    for (const glm::dvec3& scale : scales) {
        SCOPED_TRACE(testing::Message() << scale.x << " " << scale.y << " " << scale.z);
        GltfBuilder b = scene("KHR_lights_area", R"([{"shape": "rect", "width": 2, "height": 0.5},
                                                     {"shape": "disk", "radius": 0.5}])");
        for (auto& node : b.json["nodes"])
            node["scale"] = {scale.x, scale.y, scale.z};
        const Scene s = load(b);
        ASSERT_EQ(s.lights.size(), 2u);
        const double z = scale.z < 0 ? 1 : -1;
        const CndLight& rect = s.lights[0];
        const glm::dvec3 u(rect.axisU[0], rect.axisU[1], rect.axisU[2]);
        const glm::dvec3 v(rect.axisV[0], rect.axisV[1], rect.axisV[2]);
        EXPECT_EQ(glm::normalize(glm::cross(u, v)).z, z);
        EXPECT_FLOAT_EQ(float(glm::length(u)), float(std::abs(scale.x)));
        EXPECT_FLOAT_EQ(float(glm::length(v)), float(0.25 * std::abs(scale.y)));
        EXPECT_EQ(s.lights[1].direction[2], float(z));
    }
}

TEST_F(GltfLights, DirectionalLightsBecomeSunsOfTheSameIlluminance)
{
    const char* lights = R"([{"type": "directional", "intensity": 100000, "color": [1, 1, 0.5]}])";
    EXPECT_EQ(load(scene("KHR_lights_punctual", lights)).lights.at(0).type,
              uint32_t{CND_LIGHT_DIRECTIONAL});
    SceneOptions options;
    options.sunRadius = 0.00465;
    const CndLight sun = load(scene("KHR_lights_punctual", lights), options).lights.at(0);
    EXPECT_EQ(sun.type, uint32_t{CND_LIGHT_DISTANT_SPHERE});
    EXPECT_EQ(sun.radius, 0.00465f);
    EXPECT_EQ(sun.direction[2], -1);
    // E = pi s^2 L; 1.5e9 cd/m^2 is the luminance of the Sun at noon.
    EXPECT_NEAR(sun.emission[0] * pi * 0.00465 * 0.00465, 1e5, 0.02);
    EXPECT_NEAR(sun.emission[2] * pi * 0.00465 * 0.00465, 5e4, 0.02);
}

TEST_F(GltfLights, FarFromTheOriginNothingIsRounded)
{
    GltfBuilder b = scene("KHR_lights_punctual", R"([{"type": "point"}, {"type": "point"}])");
    b.json["nodes"][0]["translation"] = {5e8, 1, 2};
    b.json["nodes"][1]["translation"] = {500000000.125, 1, 2};
    const Scene s = load(b);
    for (size_t i = 0; i < 2; ++i)
        EXPECT_EQ(s.lightOrigin.x + static_cast<double>(s.lights[i].position[0]),
                  5e8 + 0.125 * static_cast<double>(i));
}

TEST_F(GltfLights, RandomLightsCanBeAskedForInstead)
{
    SceneOptions options;
    options.lights = 7;
    const Scene s = load(triangleScene(), options);
    EXPECT_EQ(s.lights.size(), 7u);
    for (const std::string& warning : s.warnings)
        EXPECT_EQ(warning.find("has no lights"), std::string::npos);
}

// One wrong value does not lose a file. The warning names the light, the value, and what is used.
TEST_F(GltfLights, WrongValuesAreReplacedWithAWarning)
{
    const auto warned = [&](const char* extension, const std::string& light, const char* sentence) {
        const Scene s = load(scene(extension, ("[" + light + R"(, {"type": "point"}])").c_str()));
        EXPECT_TRUE(warns(s, std::string(extension) + ".lights[0]" + sentence))
            << light << ": " << (s.warnings.empty() ? "" : s.warnings[0]);
        return s;
    };
    const char* punctual = "KHR_lights_punctual";
    for (const char* range : {"0", "-1", "3.4028234663852886e38", "1e13", "\"far\""}) {
        const Scene s =
            warned(punctual, std::string(R"({"type": "point", "range": )") + range + "}",
                   ".range: must be ");
        EXPECT_EQ(s.lights.at(0).influenceRadius, INFINITY);
        EXPECT_TRUE(warns(s, "; the light has no range"));
    }
    Scene s = warned(punctual, R"({"type": "point", "range": 1, "extras": {"radius": 2}})",
                     ".range: must be greater than the light's radius, 2, is 1; the light has no "
                     "range");
    EXPECT_EQ(s.lights.at(0).radius, 2);
    for (const char* spot : {"null", "7", "[]"}) {
        s = warned(punctual, std::string(R"({"type": "spot", "spot": )") + spot + "}", "");
        EXPECT_FLOAT_EQ(s.lights.at(0).outerConeAngle, float(pi / 4));
    }
    s = warned(punctual, R"({"type": "spot"})", ": is a spot without \"spot\"");
    EXPECT_EQ(s.lights.at(0).type, uint32_t{CND_LIGHT_SPOT});
    for (const char* radius : {"0", "-1", "1e-40", "1e20", "\"1\"", "null"}) {
        s = warned(punctual,
                   std::string(R"({"type": "point", "extras": {"radius": )") + radius + "}}",
                   ".extras.radius: must be ");
        EXPECT_EQ(s.lights.at(0).type, uint32_t{CND_LIGHT_POINT});
    }
    s = warned(punctual, R"({"type": "point", "intensity": -5})",
               ".intensity: must be >= 0, is -5; "
               "0 is used");
    EXPECT_EQ(s.lights.at(0).emission[0], 0);
    s = warned(punctual, R"({"type": "point", "color": [1, -1, 0.5]})", ".color[1]: must be >= 0");
    EXPECT_EQ(s.lights.at(0).emission[2], 0.5f);
    for (const char* light :
         {R"({"type": "tube"})", R"({"type": 3})", R"({"name": "no type"})", "null", "7",
          R"({"type": "point", "intensity": 3e38, "color": [9, 9, 9]})"}) {
        s = warned(punctual, light, "");
        EXPECT_EQ(s.lights.size(), 1u) << light;
        EXPECT_TRUE(warns(s, "; the light is left out")) << light;
        EXPECT_EQ(s.warnings.size(), 1u) << light;
    }
    const auto area = [&](const char* light) { return load(scene("KHR_lights_area", light)); };
    for (const char* light : {R"([{"shape": "cube"}])", "[{}]", R"([{"shape": 7}])"})
        EXPECT_TRUE(warns(area(light), "; the light is left out")) << light;
    s = area(R"([{"shape": "rect", "width": -1, "height": "tall", "range": 0}])");
    ASSERT_EQ(s.lights.size(), 1u);
    EXPECT_EQ(s.lights[0].axisU[0], 0.5f);
    EXPECT_EQ(s.warnings.size(), 3u);
}

// Ten thousand lights with the same fault, each with another value, are one sentence.
TEST_F(GltfLights, WarningsOfManyLightsAreFew)
{
    Json lights = Json::array();
    for (int i = 0; i < 10'000; ++i)
        lights.push_back(
            {{"type", "point"}, {"range", -1.5 * i}, {"intensity", "a" + std::to_string(i)}});
    const Scene s = load(scene("KHR_lights_punctual", lights.dump().c_str()));
    EXPECT_EQ(s.lights.size(), 10'000u);
    EXPECT_LE(s.warnings.size(), 3u);
    EXPECT_TRUE(warns(s, "lights[0].intensity (and 9999 others): must be a number, is \"a0\"; 1 is "
                         "used"));
}

TEST_F(GltfLights, TheRadiusThatAUserAsksForIsChecked)
{
    SceneOptions options;
    options.punctualRadius = -1;
    EXPECT_NE(
        error(scene("KHR_lights_punctual", R"([{"type": "point"}])"), options).find("must be > 0"),
        std::string::npos);
}

} // namespace

} // namespace candelabra::test
