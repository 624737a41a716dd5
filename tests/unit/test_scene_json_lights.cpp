// SPDX-License-Identifier: Apache-2.0
// Tests every type of light in the scene description: values arrive as written, in the units of the
// public interface; errors are one sentence that names the key.
#include <algorithm>
#include <cmath>
#include <fstream>
#include <set>

#include <gtest/gtest.h>

#include "harness/constants.h"
#include "harness/paths.h"
#include "load/load.h"
#include "scene/light_types.h"
#include "scene/scene_error.h"
#include "unit/gltf_builder.h"
#include "unit/scene_invariants.h"

namespace candelabra::test
{

namespace
{

using namespace candelabra::app;

const std::string everyLight = dataPath("every_light.json");

// The lights of that file.
Json everyLightJson()
{
    std::ifstream file(everyLight);
    return Json::parse(file)["lights"];
}

glm::vec3 vectorOf(const float (&v)[3])
{
    return {v[0], v[1], v[2]};
}

void expectNear(const glm::vec3& a, const glm::vec3& b)
{
    EXPECT_LE(glm::length(a - b), 1e-6f * glm::length(b))
        << a.x << " " << a.y << " " << a.z << ", not " << b.x << " " << b.y << " " << b.z;
}

glm::vec3 cornerOf(const CndLight& polygon, uint32_t i)
{
    const float(&corner)[2] = polygon.polygon->corners[i];
    return vectorOf(polygon.position) + corner[0] * vectorOf(polygon.axisU) +
           corner[1] * vectorOf(polygon.axisV);
}

double power(const CndLight& light, int channel)
{
    float out[3] = {};
    EXPECT_EQ(cndLuminousPowerOfLight(&light, out, nullptr), CND_SUCCESS);
    return double(out[channel]);
}

class SceneJsonLights : public testing::Test
{
protected:
    // Returns a valid scene without lights.
    static Json emptyScene()
    {
        return Json::parse(R"({
            "camera": {"position": [0, 2, 4], "look_at": [0, 0, 0], "up": [0, 1, 0],
                       "vertical_fov_degrees": 45},
            "object": {"type": "plane", "point": [0, 0, 0], "normal": [0, 1, 0]},
            "material": {"albedo": [0.8, 0.6, 0.4], "alpha": 0.09}, "lights": []})");
    }

    // Returns what follows "scene.json: lights[0]" in the error message for a scene with this
    // light.
    std::string error(const Json& light)
    {
        Json json = emptyScene();
        json["lights"].push_back(light);
        const std::string file = folder_.write("scene.json", json.dump());
        try {
            const Scene scene = loadScene(file, {});
            EXPECT_EQ(brokenInvariant(scene), "");
        } catch (const SceneError& e) {
            const std::string message = e.what(), start = file + ": lights[0]";
            EXPECT_EQ(message.find(start), 0u) << message;
            EXPECT_EQ(message.find('\n'), std::string::npos) << message;
            return message.substr(start.size());
        }
        return "no error";
    }

    TemporaryFolder folder_;
};

TEST_F(SceneJsonLights, EveryTypeArrivesAsWritten)
{
    const Scene scene = loadScene(everyLight, {});
    EXPECT_EQ(brokenInvariant(scene), "");
    const Json written = everyLightJson();
    const auto& l = scene.lights;
    ASSERT_EQ(l.size(), written.size());
    ASSERT_GE(l.size(), 11u);
    for (size_t i = 0; i < l.size(); ++i)
        EXPECT_EQ(lightTypeName(l[i].type), written[i].value("type", "sphere")) << i;
    expectNear(vectorOf(l[0].emission), {400, 300, 200});
    EXPECT_NEAR(power(l[1], 0), 500, 1e-4);
    EXPECT_EQ(l[1].influenceRadius, 8);
    EXPECT_EQ(l[1].layers, 0x8004u);
    EXPECT_EQ(l[2].layers, 0u);
    EXPECT_TRUE(l[1].unshadowed);
    EXPECT_EQ(l[1].unshadowedBy, 0b100010u);
    EXPECT_FALSE(l[2].unshadowed);
    EXPECT_EQ(l[2].unshadowedBy, 0u);
    EXPECT_EQ(scene.analyticObjects[1].occluderLayer, 0u);
    EXPECT_EQ(scene.analyticObjects[2].occluderLayer, 4u);
    EXPECT_EQ(scene.cameras[0].layers, 0x8001u);
    for (int c = 0; c < 3; ++c) // I = pi R^2 L
        EXPECT_NEAR(double(l[2].emission[c]) * pi * 0.01, 30 + 10 * c, 1e-4);

    expectNear(vectorOf(l[3].direction), glm::normalize(glm::vec3(-1, -2, 0)));
    EXPECT_EQ(l[3].radius, 0.00465f);
    EXPECT_NEAR(double(l[3].emission[2]) * pi * 0.00465 * 0.00465, 18, 1e-5);

    expectNear(vectorOf(l[4].position), {0, 2.3f, -1});
    expectNear(vectorOf(l[4].axisU), {1, 0.1f, 0});
    EXPECT_EQ(l[4].radius, 0.05f);
    EXPECT_EQ(l[4].influenceRadius, 6);
    EXPECT_EQ(l[4].emission[1], 3000);
    EXPECT_NEAR(power(l[5], 0), 100, 1e-4);

    expectNear(vectorOf(l[6].axisU), {0.5f, 0, 0});
    expectNear(vectorOf(l[6].axisV), {0, 0.3f, 0.3f});
    EXPECT_TRUE(l[6].twoSided);
    EXPECT_FALSE(l[7].twoSided);
    expectNear(vectorOf(l[7].direction), glm::normalize(glm::vec3(-1, -2, 1)));
    EXPECT_NEAR(power(l[7], 2), 400, 1e-3);

    EXPECT_EQ(l[8].emission[0], 40);
    EXPECT_EQ(l[8].influenceRadius, 5);
    EXPECT_NEAR(double(l[9].innerConeAngle), 12 * pi / 180, 1e-7);
    EXPECT_NEAR(double(l[9].outerConeAngle), 25 * pi / 180, 1e-7);
    EXPECT_NEAR(power(l[9], 1), 200, 1e-3);
    EXPECT_TRUE(std::isinf(l[9].influenceRadius));
    EXPECT_EQ(l[10].emission[2], 4);

    // A pentagon that faces down, and a triangle.
    ASSERT_EQ(l[11].type, uint32_t{CND_LIGHT_POLYGON});
    EXPECT_EQ(l[11].polygon->cornerCount, 5u);
    const glm::vec3 down = glm::cross(vectorOf(l[11].axisU), vectorOf(l[11].axisV));
    expectNear(glm::normalize(down), {0, -1, 0});
    expectNear(cornerOf(l[11], 1), {0, 2.8f, -1.5f});
    expectNear(cornerOf(l[11], 4), {-0.3f, 2.8f, -0.4f});
    EXPECT_EQ(l[11].emission[2], 300);
    EXPECT_EQ(l[11].influenceRadius, 7);
    EXPECT_EQ(l[12].polygon->cornerCount, 3u);
    expectNear(cornerOf(l[12], 2), {-2.1f, 0.4f, 0.2f});
    EXPECT_TRUE(l[12].twoSided);
    EXPECT_NEAR(power(l[12], 2), 90, 1e-3);
    EXPECT_TRUE(scene.lightsVisible);
}

TEST_F(SceneJsonLights, TheExampleHasEveryKeyOfEveryType)
{
    const Json written = everyLightJson();
    const auto isWritten = [&](const std::string& type, const std::string& key) {
        return std::ranges::any_of(written, [&](const Json& light) {
            return light.value("type", "sphere") == type && light.contains(key);
        });
    };
    for (uint32_t type = 0; type < CND_LIGHT_TYPE_COUNT; ++type) {
        EXPECT_TRUE(isWritten(lightTypeName(type), "type")) << lightTypeName(type);
        for (const LightKey& key : lightTypeInfo(type).keys)
            EXPECT_TRUE(isWritten(lightTypeName(type), key.name))
                << lightTypeName(type) << " " << key.name;
    }
}

// The Sun at its distance and lights far from the origin: only the other lights decide where the
// origin is.
TEST_F(SceneJsonLights, DistantLightsDoNotMoveTheOrigin)
{
    Json json = emptyScene();
    json["lights"] = Json::parse(R"([
        {"type": "distant_sphere", "direction": [0, -1, 0], "sin_angular_radius": 0.00465,
         "radiance": [1.6e9, 1.6e9, 1.5e9]},
        {"type": "tube", "start": [1e7, 0, 0], "end": [10000000.5, 0, 0], "radius": 0.01,
         "radiance": [1, 1, 1]}])");
    const Scene scene = loadScene(folder_.write("scene.json", json.dump()), {});
    EXPECT_EQ(brokenInvariant(scene), "");
    EXPECT_EQ(scene.lightOrigin, glm::dvec3(10000000.25, 0, 0));
    expectNear(vectorOf(scene.lights[1].axisU), {0.25f, 0, 0});
    EXPECT_EQ(vectorOf(scene.lights[0].position), glm::vec3(0));
    EXPECT_EQ(scene.lights[0].emission[0], 1.6e9f);
}

TEST_F(SceneJsonLights, ReflectanceIsAnF0)
{
    Json json = emptyScene();
    json["material"]["reflectance"] = 0.5;
    const auto load = [&] { return loadScene(folder_.write("scene.json", json.dump()), {}); };
    EXPECT_FLOAT_EQ(load().materials[0].dielectricF0.x, 0.04f);
    json["material"]["reflectance"] = 1;
    EXPECT_FLOAT_EQ(load().materials[0].dielectricF0.z, 0.16f);
    json["material"]["F0"] = {0.1, 0.1, 0.1};
    try {
        load();
        ADD_FAILURE() << "no error";
    } catch (const SceneError& e) {
        EXPECT_NE(
            std::string(e.what()).find("material.reflectance: cannot be combined with \"F0\""),
            std::string::npos)
            << e.what();
    }
}

// Replaces or removes every key of every light of the data file: the error names that key.
TEST_F(SceneJsonLights, EveryBadValueNamesItsKey)
{
    size_t tried = 0;
    for (const Json& light : everyLightJson())
        for (const auto& [key, value] : light.items()) {
            for (const char* bad : {"null", "{}", "[]", "\"x\"", "-1", "[1, 2]", "1e300",
                                    "[1e300, 0, 0]", "[0, 0, \"1\"]"}) {
                if ((key == "layers" || key == "unshadowed_by") && std::string(bad) == "[1, 2]")
                    continue; // a valid value for this key
                Json broken = light;
                broken[key] = Json::parse(bad);
                const std::string message = error(broken);
                EXPECT_EQ(message.find("." + key), 0u) << key << " = " << bad << ": " << message;
                ++tried;
            }
            Json without = light;
            without.erase(key);
            const std::set<std::string> optional{"type",   "influence_radius", "two_sided",
                                                 "layers", "unshadowed",       "unshadowed_by"};
            if (optional.contains(key))
                continue;
            EXPECT_NE(error(without).find("is missing"), std::string::npos) << key;
            Json more = light;
            more[key + "s"] = 1;
            EXPECT_EQ(error(more).find(": unknown key \"" + key + "s\"; the known ones are type, "),
                      0u);
            EXPECT_NE(error(more).find(", " + (key == "type" ? "layers" : key)), std::string::npos);
        }
    EXPECT_GT(tried, 300u);
}

TEST_F(SceneJsonLights, ErrorsSayWhy)
{
    const auto expect = [&](const char* light, const std::string& message) {
        EXPECT_EQ(error(Json::parse(light)), message);
    };
    std::string names = lightTypeName(0);
    for (uint32_t type = 1; type < CND_LIGHT_TYPE_COUNT; ++type)
        names += std::string(", ") + lightTypeName(type);
    expect(R"({"type": "cone"})", ".type: must be one of " + names + ", is \"cone\"");
    expect(R"({"type": "point", "position": [0, 1, 0]})", ": \"intensity\" is missing");
    expect(R"({"type": "point", "position": [0, 1, 0], "radiance": [1, 1, 1]})",
           ": unknown key \"radiance\"; the known ones are type, layers, unshadowed, "
           "unshadowed_by, position, influence_radius, intensity, luminous_power");
    expect(R"({"type": "point", "position": [0, 1, 0], "intensity": [1, 1, 1],
               "luminous_power": [1, 1, 1]})",
           ".luminous_power: cannot be combined with \"intensity\"");
    expect(R"({"position": [0, 1, 0], "radius": 1, "radiance": [1, 1, 1], "luminance": [1, 1, 1]})",
           ".luminance: cannot be combined with \"radiance\"");
    expect(R"({"position": [0, 1, 0], "radius": 1e-21, "luminous_power": [1, 1, 1]})",
           ".luminous_power: needs an emission beyond single precision for so small a light");
    expect(R"({"type": "tube", "start": [0, 1, 0], "end": [0, 1, 0], "radius": 1,
               "radiance": [1, 1, 1]})",
           ".end: must not be the same point as start");
    expect(R"({"type": "tube", "start": [0, 1, 0], "end": [0, 3, 0], "radius": 1,
               "radiance": [1, 1, 1], "influence_radius": 2})",
           ".influence_radius: must be greater than the distance from the light's centre to its "
           "farthest point");
    expect(R"({"type": "rectangle", "position": [0, 1, 0], "axis_u": [1, 0, 0],
               "axis_v": [0.1, 1, 0], "radiance": [1, 1, 1]})",
           ".axis_v: must be perpendicular to axis_u");
    expect(R"({"type": "rectangle", "position": [0, 1, 0], "axis_u": [0, 0, 0],
               "axis_v": [0, 1, 0], "radiance": [1, 1, 1]})",
           ".axis_u: must not be zero");
    expect(R"({"type": "disc", "position": [0, 1, 0], "normal": [0, 0, 0], "radius": 1,
               "radiance": [1, 1, 1]})",
           ".normal: must not be zero");
    expect(R"({"type": "disc", "position": [0, 1, 0], "normal": [0, 1, 0], "radius": 1,
               "radiance": [1, 1, 1], "influence_radius": 1})",
           ".influence_radius: must be greater than radius");
    const auto expectCorners = [&](const std::string& corners, const std::string& message) {
        expect(
            (R"({"type": "polygon", "radiance": [1, 1, 1], "corners": [)" + corners + "]}").c_str(),
            ".corners: " + message);
    };
    expectCorners("[0, 0, 0], [1, 0, 0]", "must have 3 to 8 corners");
    expectCorners("[0, 0, 0], [1, 0, 0], [2, 0, 0], [3, 0, 0], [4, 0, 0], [4, 1, 0], [3, 1, 0], "
                  "[2, 1, 0], [1, 1, 0]",
                  "must have 3 to 8 corners");
    expectCorners("[0, 0, 0], [1, 0, 0], [1, 1, 0.1], [0, 1, 0]", "the corners are not in a plane");
    expectCorners("[0, 0, 0], [1, 0, 0], [0.2, 0.2, 0], [0, 1, 0]", "the polygon must be convex");
    expectCorners("[0, 0, 0], [1, 0, 0], [2, 0, 0]", "the corners enclose no area");
    expectCorners("[0, 0, 0], [0, 0, 0], [1, 0, 0], [1, 1, 0]",
                  "two neighbouring corners of the polygon coincide");
    expect(R"({"type": "spot", "position": [0, 1, 0], "direction": [0, -1, 0],
               "inner_cone_degrees": 30, "outer_cone_degrees": 91, "intensity": [1, 1, 1]})",
           ".outer_cone_degrees: must be > 0 and <= 90, is 91");
    expect(R"({"type": "distant_sphere", "direction": [0, -1, 0], "sin_angular_radius": 1.5,
               "illuminance": [1, 1, 1]})",
           ".sin_angular_radius: must be > 0 and <= 1, is 1.5");
    expect(R"({"type": "directional", "direction": [0, -1, 0], "position": [0, 0, 0],
               "illuminance": [1, 1, 1]})",
           ": unknown key \"position\"; the known ones are type, layers, unshadowed, "
           "unshadowed_by, direction, illuminance");
    expect(R"({"position": [0, 1, 0], "radius": 1, "radiance": [1, 1, 1], "layers": []})",
           ".layers: must not be empty: leave it out for all layers");
    expect(R"({"position": [0, 1, 0], "radius": 1, "radiance": [1, 1, 1], "layers": [0, 16]})",
           ".layers[1]: must be an integer between 0 and 15, is 16");
    expect(R"({"position": [0, 1, 0], "radius": 1, "radiance": [1, 1, 1], "unshadowed_by": []})",
           ".unshadowed_by: must not be empty: leave it out for no layer");
    expect(R"({"position": [0, 1, 0], "radius": 1, "radiance": [1, 1, 1], "unshadowed_by": [6]})",
           ".unshadowed_by[0]: must be an integer between 0 and 5, is 6");
    // The widest possible spot.
    expect(R"({"type": "spot", "position": [0, 1, 0], "direction": [0, -1, 0],
               "inner_cone_degrees": 0, "outer_cone_degrees": 90, "intensity": [1, 1, 1]})",
           "no error");
}

} // namespace

} // namespace candelabra::test
