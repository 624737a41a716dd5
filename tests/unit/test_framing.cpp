// SPDX-License-Identifier: Apache-2.0
// Tests automatic cameras, and cameras that are fitted to objects.
#include <algorithm>
#include <cmath>
#include <limits>
#include <optional>

#include "io/error.h"
#include "load/auto_cameras.h"
#include "load/outside.h"
#include "render/camera.h"
#include "scene/fit_camera.h"
#include "unit/gltf_fixture.h"

namespace candelabra::test
{
namespace
{

using namespace candelabra::app;

using Framing = GltfTest;

// Adds a box of the given size as a mesh, with fronts outside or inside, and returns its index. The
// faces are +x, -x, +y, -y, +z and -z; the face `open` is left out.
int addBox(GltfBuilder& builder, const glm::vec3& size, bool inward, int open = -1)
{
    std::vector<float> positions;
    for (int corner = 0; corner < 8; ++corner)
        for (int axis = 0; axis < 3; ++axis)
            positions.push_back((corner >> axis & 1 ? 0.5f : -0.5f) * size[axis]);
    // Counter-clockwise seen from outside.
    std::vector<uint16_t> indices{1, 3, 7, 1, 7, 5, 0, 4, 6, 0, 6, 2, 2, 6, 7, 2, 7, 3,
                                  0, 1, 5, 0, 5, 4, 4, 5, 7, 4, 7, 6, 0, 2, 3, 0, 3, 1};
    if (inward)
        for (size_t i = 0; i < indices.size(); i += 3)
            std::swap(indices[i], indices[i + 1]);
    if (open >= 0)
        indices.erase(indices.begin() + 6 * open, indices.begin() + 6 * (open + 1));
    const int position = builder.floats(positions, "VEC3"), index = builder.indices(indices);
    return builder.mesh({{"attributes", {{"POSITION", position}}}, {"indices", index}});
}

Scene boxScene(const glm::vec3& size, const glm::dvec3& at = {})
{
    Scene scene;
    Mesh mesh;
    for (int corner = 0; corner < 8; ++corner)
        mesh.vertices.push_back(
            {.position = size * (glm::vec3(corner & 1, corner >> 1 & 1, corner >> 2 & 1) - 0.5f)});
    // A vertex that no triangle uses.
    mesh.vertices.push_back({.position = glm::vec3(1e6f)});
    mesh.indices = {1, 3, 7, 1, 7, 5, 0, 4, 6, 0, 6, 2, 2, 6, 7, 2, 7, 3,
                    0, 1, 5, 0, 5, 4, 4, 5, 7, 4, 7, 6, 0, 2, 3, 0, 3, 1};
    scene.meshes.push_back(mesh);
    scene.materials.emplace_back();
    Instance instance;
    instance.worldFromObject[3] = glm::dvec4(at, 1);
    scene.instances.push_back(instance);
    return scene;
}

struct Extent {
    double left = std::numeric_limits<double>::infinity(), right = -left;
    double bottom = left, top = -left, nearest = left;
};

// Returns what a camera sees of the instances, where -1..1 is the picture.
Extent seenBy(const Camera& camera, const Scene& scene, const InstanceRange& range, double aspect)
{
    Extent out;
    const glm::dvec3 right = glm::normalize(glm::cross(camera.forward, camera.up));
    visitVertices(scene, range, [&](const glm::dvec3& p) {
        const glm::dvec3 d = p - camera.position;
        const double depth = glm::dot(d, camera.forward);
        const double half = camera.orthographic ? 0.5 * camera.orthographicHeight
                                                : depth * std::tan(0.5 * camera.verticalFov);
        const double x = glm::dot(d, right) / (half * aspect), y = glm::dot(d, camera.up) / half;
        out.left = std::min(out.left, x);
        out.right = std::max(out.right, x);
        out.bottom = std::min(out.bottom, y);
        out.top = std::max(out.top, y);
        out.nearest = std::min(out.nearest, depth);
    });
    return out;
}

void expectFilled(const Camera& camera, const Scene& scene, const InstanceRange& range,
                  double aspect)
{
    const Extent e = seenBy(camera, scene, range, aspect);
    EXPECT_GT(e.nearest, camera.nearPlane) << camera.name;
    EXPECT_GE(std::min(e.left, e.bottom), -fitShare - 1e-9) << camera.name;
    EXPECT_LE(std::max(e.right, e.top), fitShare + 1e-9) << camera.name;
    const double width = 0.5 * (e.right - e.left), height = 0.5 * (e.top - e.bottom);
    EXPECT_NEAR(std::max(width, height), fitShare, 1e-6) << camera.name << " " << aspect;
}

TEST_F(Framing, EveryAutomaticCameraFillsItsPicture)
{
    for (const glm::vec3& size :
         {glm::vec3(1, 2, 3), glm::vec3(100, 0.01f, 40), glm::vec3(1e-3f, 1e-3f, 5e-3f)})
        for (const double aspect : {16.0 / 9, 1.0, 0.4}) {
            Scene scene = boxScene(size, {500, -20, 7});
            addAutomaticCameras(scene, aspect);
            ASSERT_EQ(scene.cameras.size(), 6u);
            EXPECT_FALSE(scene.interior);
            const char* names[] = {"three-quarter", "front", "right", "back", "left", "above"};
            for (size_t i = 0; i < 6; ++i) {
                EXPECT_EQ(scene.cameras[i].name, names[i]);
                expectFilled(scene.cameras[i], scene, {0, 1}, aspect);
            }
            // From the right of the front, and from above.
            const glm::dvec3& forward = scene.cameras[0].forward;
            EXPECT_LT(forward.x, -0.2);
            EXPECT_LT(forward.y, -0.2);
            EXPECT_LT(forward.z, -0.4);
            EXPECT_EQ(scene.cameras[5].forward, glm::dvec3(0, -1, 0));
        }
}

TEST_F(Framing, FittingKeepsTheDirectionOfAnyCamera)
{
    const Scene scene = boxScene({2, 1, 4}, {0, 3, 0});
    for (const bool orthographic : {false, true}) {
        Camera camera;
        camera.forward = glm::normalize(glm::dvec3(0.3, -0.5, 1));
        camera.up = glm::normalize(glm::cross(
            glm::normalize(glm::cross(camera.forward, glm::dvec3(0.4, 1, 0))), camera.forward));
        camera.orthographic = orthographic;
        camera.farPlane = orthographic ? 10 : 0;
        const Camera fitted = fitCamera(scene, {0, 1}, camera, 1.5);
        EXPECT_EQ(fitted.forward, camera.forward);
        EXPECT_EQ(fitted.up, camera.up);
        expectFilled(fitted, scene, {0, 1}, 1.5);
        EXPECT_NO_THROW(makeCamera(fitted, 1.5));
        // The picture is filled, whatever the camera's own aspect.
        camera.aspect = 0.5;
        expectFilled(fitCamera(scene, {0, 1}, camera, 1.5), scene, {0, 1}, 1.5);
    }
    const Camera still = fitCamera(scene, {0, 0}, Camera{}, 1);
    EXPECT_EQ(still, Camera{});
}

// A plane with one side that faces away from the usual camera, or down, is seen from its front.
TEST_F(Framing, PlanesAreSeenFromTheirFront)
{
    for (const Json& rotation : {Json{0, 0, 0, 1}, Json{0, 1, 0, 0}, Json{0, 0.7071, 0, 0.7071},
                                 Json{0.7071, 0, 0, 0.7071}, Json{-0.7071, 0, 0, 0.7071}}) {
        GltfBuilder builder = triangleScene();
        builder.json["nodes"][0]["rotation"] = rotation;
        const Scene scene = load(builder);
        const glm::dvec3 normal = glm::normalize(worldAreaNormal(scene, scene.instances[0], 0));
        EXPECT_LT(glm::dot(normal, scene.cameras[0].forward), -0.1) << rotation;
    }
}

TEST_F(Framing, RoomsAreSeenFromInside)
{
    GltfBuilder room;
    room.rootNode({{"mesh", addBox(room, {8, 3, 5}, true)}, {"translation", {100, 1.5, 0}}});
    // A piece of furniture in the middle.
    room.rootNode({{"mesh", addBox(room, {1, 1, 1}, false)}, {"translation", {100, 0.5, 0}}});
    const Scene scene = load(room);
    EXPECT_TRUE(scene.interior);
    ASSERT_EQ(scene.cameras.size(), 8u);
    EXPECT_EQ(scene.cameras[0].name, "inside");
    EXPECT_EQ(scene.cameras[1].name, "inside-2");
    EXPECT_EQ(scene.cameras[2].name, "three-quarter");
    for (size_t i = 0; i < 2; ++i) {
        const Camera& camera = scene.cameras[i];
        const glm::dvec3 p = camera.position - glm::dvec3(100, 0, 0);
        EXPECT_LT(std::abs(p.x), 3.9);
        EXPECT_LT(std::abs(p.z), 2.4);
        EXPECT_NEAR(p.y, 1.6, 1e-6); // the height of eyes above the floor
        EXPECT_FALSE(std::abs(p.x) < 0.5 && std::abs(p.z) < 0.5);
        // It looks across the room, not at the wall beside it.
        EXPECT_LT(glm::dot(glm::dvec3(p.x, 0, p.z), camera.forward), -1);
    }
    EXPECT_LE(glm::dot(scene.cameras[0].forward, scene.cameras[1].forward), 0.1);
}

TEST_F(Framing, OpenRoomsAreSeenThroughTheirOpening)
{
    const glm::dvec3 outward[] = {{1, 0, 0}, {-1, 0, 0}, {}, {}, {0, 0, 1}, {0, 0, -1}};
    for (const int open : {0, 1, 4, 5}) {
        GltfBuilder room;
        room.rootNode({{"mesh", addBox(room, {6, 5, 6}, true, open)}});
        room.rootNode({{"mesh", addBox(room, {1, 2, 1}, false)}, {"translation", {1, -1.5, 0.5}}});
        const Scene scene = load(room);
        EXPECT_TRUE(scene.interior);
        const Camera& camera = scene.cameras.at(scene.defaultCamera);
        EXPECT_EQ(camera.name, "open-side");
        EXPECT_GT(glm::dot(camera.position, outward[open]), 3) << open;
        EXPECT_LT(glm::dot(camera.forward, outward[open]), -0.99) << open;
        EXPECT_EQ(scene.cameras.at(1).name, "inside");
    }
}

// A closed box is an object, and so is a house whose walls have two sides.
TEST_F(Framing, HousesAreSeenFromOutside)
{
    GltfBuilder house;
    house.rootNode({{"mesh", addBox(house, {8, 3, 5}, false)}});
    EXPECT_FALSE(load(house).interior);
    house.rootNode({{"mesh", addBox(house, {7.8f, 2.8f, 4.8f}, true)}});
    const Scene scene = load(house);
    EXPECT_FALSE(scene.interior);
    EXPECT_EQ(scene.cameras[0].name, "three-quarter");
}

TEST_F(Framing, FilesWithACameraHaveTheOthersToo)
{
    GltfBuilder builder = triangleScene();
    builder.json["cameras"] = Json::parse(
        R"([{"type": "perspective", "name": "mine", "perspective": {"yfov": 1, "znear": 0.1}}])");
    builder.rootNode({{"camera", 0}});
    const Scene scene = load(builder);
    EXPECT_EQ(scene.cameras[0].name, "mine");
    EXPECT_EQ(selectCamera(scene, "three-quarter").name, "three-quarter");
}

// The camera of the file is the default only if it shows the triangle, whose height is 1 m, at
// least half as high as the picture, which is 2 tan(0.5) = 1.09 times the distance.
TEST_F(Framing, CamerasOfTheFileThatShowLittleAreNotTheDefault)
{
    struct Case {
        const char* translation;
        const char* rotation;
        const char* used;
        bool isEmpty = false;
    };
    const char *ahead = "[0, 0, 0, 1]", *back = "[0, 1, 0, 0]";
    for (const Case& c : {Case{"[0.5, 0.5, 1.7]", ahead, "mine"}, // the triangle is 0.54 high
                          Case{"[0.5, 0.5, 2.0]", ahead, "three-quarter"}, // and here 0.46
                          Case{"[0.5, 0.5, 1.7]", back, "three-quarter", true},
                          Case{"[9.5, 0.5, 1.7]", ahead, "three-quarter", true},
                          Case{"[0.5, 1.0, 2.0]", ahead, "three-quarter"},
                          Case{"[0.5, 1.1, 1.7]", ahead, "mine"},     // it is cut off
                          Case{"[0.3, 0.3, 0.01]", ahead, "mine"}}) { // it fills the picture
        SCOPED_TRACE(std::string(c.translation) + c.rotation);
        GltfBuilder builder = triangleScene();
        builder.json["cameras"] = Json::parse(
            R"([{"type": "perspective", "name": "mine",
                 "perspective": {"yfov": 1, "znear": 0.1}}])");
        builder.rootNode({{"camera", 0},
                          {"translation", Json::parse(c.translation)},
                          {"rotation", Json::parse(c.rotation)}});
        const Scene scene = load(builder);
        EXPECT_EQ(scene.cameras[scene.defaultCamera].name, c.used);
        EXPECT_EQ(selectCamera(scene, "").name, c.used);
        EXPECT_EQ(selectCamera(scene, "0").name, "mine");
        if (c.used == std::string("mine")) {
            EXPECT_TRUE(scene.notes.empty());
            continue;
        }
        ASSERT_EQ(scene.notes.size(), 1u);
        EXPECT_EQ(scene.notes[0],
                  std::string("the file's camera shows ") +
                      (c.isEmpty ? "nothing of the scene"
                                 : "the scene less than half as wide and as high as the picture") +
                      ", so the automatic camera three-quarter is used; --camera 0 chooses the "
                      "file's");
    }
}

TEST_F(Framing, TheFirstCameraOfTheFileThatShowsTheSceneIsTheDefault)
{
    GltfBuilder builder = triangleScene();
    builder.json["cameras"] = Json::parse(R"([
        {"type": "orthographic", "name": "far",
         "orthographic": {"xmag": 9, "ymag": 9, "znear": 0.1, "zfar": 99}},
        {"type": "orthographic", "name": "near",
         "orthographic": {"xmag": 0.9, "ymag": 0.9, "znear": 0.1, "zfar": 99}}])");
    for (const int camera : {0, 1})
        builder.rootNode({{"camera", camera}, {"translation", {0.5, 0.5, 5}}});
    const Scene scene = load(builder);
    EXPECT_EQ(selectCamera(scene, "").name, "near");
    EXPECT_TRUE(scene.notes.empty());
}

// A small file may have very many triangles, because instances share meshes. The first mesh of this
// scene has 2^14 triangles, of which all but one are points, and 2^4 instances: as many triangles
// as are drawn here. The second mesh, beside it, has one triangle or none.
TEST_F(Framing, MeshesWithVeryManyTrianglesAreSeenAsBoxesFromOutside)
{
    Scene scene;
    scene.materials.emplace_back();
    Mesh triangle; // half of a square of 1 m, which faces +z
    for (const glm::vec2& corner : {glm::vec2(0, 0), glm::vec2(1, 0), glm::vec2(0, 1)})
        triangle.vertices.push_back({.position = glm::vec3(corner, 0)});
    triangle.indices = {0, 1, 2};
    Mesh large = triangle;
    large.indices.resize(3 << 14);
    triangle.indices.clear();
    scene.meshes = {large, triangle};
    scene.instances.resize(1 << 4);
    Instance beside{.mesh = 1};
    beside.worldFromObject[3].x = 2;
    scene.instances.push_back(beside);
    // The scene is 3 m wide and 1 m high, and the picture as wide and high as its diagonal.
    const double square = 1.0 / 10, tolerance = 0.01;
    const auto seen = [&](double z, uint64_t most) {
        return seenFromOutside(scene, {{0, 0, z}}, most).at(0);
    };
    constexpr uint64_t most = 1 << 18;
    EXPECT_NEAR(seen(-1, most).fronts, 0.5 * square, tolerance);
    scene.meshes[1].indices = {0, 1, 2};
    const OutsideView front = seen(-1, most);
    EXPECT_NEAR(front.fronts, 1.5 * square, tolerance); // a box, and half of a square
    EXPECT_NEAR(front.drawn, 1.5 * square, tolerance);
    EXPECT_EQ(front.backs, 0);
    const OutsideView back = seen(1, most);
    EXPECT_NEAR(back.fronts, square, tolerance); // a box has no back
    EXPECT_NEAR(back.backs, 0.5 * square, tolerance);
    // Large meshes with few instances are not replaced by boxes, because backs distinguish rooms
    // from objects.
    scene.instances.erase(scene.instances.begin() + 1, scene.instances.end() - 1);
    EXPECT_NEAR(seen(1, 1).backs, square, tolerance);
}

// A file may have thousands of cameras and millions of vertices.
TEST_F(Framing, OfVeryManyCamerasTheFirstAreTried)
{
    Scene scene = boxScene(glm::vec3(1));
    Mesh& mesh = scene.meshes[0];
    constexpr size_t more = 20'000;
    for (size_t i = 0; i < more; ++i) {
        mesh.indices.insert(mesh.indices.end(), 3, static_cast<uint32_t>(mesh.vertices.size()));
        mesh.vertices.push_back({.position = glm::vec3(0)});
    }
    Camera camera; // looks at the scene, or away from it
    camera.position = {0, 0, 2};
    Camera away = camera;
    away.forward = {0, 0, 1};
    constexpr size_t tried = mostPointsTried / (8 + more); // 8 corners of the box
    static_assert(tried == 1'677);
    const auto choose = [&](size_t cameras, std::optional<size_t> good) {
        scene.notes.clear();
        scene.cameras.assign(cameras, away);
        if (good)
            scene.cameras.at(*good) = camera;
        addAutomaticCameras(scene, 1.5);
        return scene.defaultCamera;
    };
    EXPECT_EQ(choose(tried + 1, tried - 1), tried - 1);
    EXPECT_TRUE(scene.notes.empty());
    const std::string note = "the file's first camera shows nothing of the scene, so the automatic "
                             "camera three-quarter is used; --camera 0 chooses the file's";
    EXPECT_EQ(choose(tried + 1, tried), tried + 1);
    EXPECT_EQ(scene.notes.at(0), note + "; only the first 1677 of its 1678 cameras were tried");
    EXPECT_EQ(choose(tried, std::nullopt), tried); // all of them are tried
    EXPECT_EQ(scene.notes.at(0), note);
}

TEST_F(Framing, NodesAreFoundWithAllBelowThem)
{
    // 0 "car": 1 "wheels" (2 and 3 "wheel"), 4 "body"; 5 "lamp" without a mesh; 6 a second root.
    GltfBuilder builder = triangleScene();
    builder.json["nodes"] = Json::parse(R"([
        {"name": "car", "children": [1, 4, 5]},
        {"name": "wheels", "children": [2, 3], "translation": [0, 0, 5]},
        {"name": "wheel", "mesh": 0}, {"name": "wheel", "mesh": 0, "translation": [2, 0, 0]},
        {"name": "body", "mesh": 0}, {"name": "lamp"}, {"mesh": 0, "translation": [0, 9, 0]}])");
    builder.json["scenes"][0]["nodes"] = {0, 6};
    const Scene scene = load(builder);
    ASSERT_EQ(scene.instances.size(), 4u);
    EXPECT_EQ(selectNode(scene, "car"), (InstanceRange{0, 3}));
    EXPECT_EQ(selectNode(scene, "wheels"), (InstanceRange{0, 2}));
    EXPECT_EQ(selectNode(scene, "wheel"), (InstanceRange{0, 1})); // the first of that name
    EXPECT_EQ(selectNode(scene, "3"), (InstanceRange{1, 1}));
    EXPECT_EQ(selectNode(scene, "body"), (InstanceRange{2, 1}));
    EXPECT_EQ(selectNode(scene, "6"), (InstanceRange{3, 1}));
    for (const char* unknown : {"lamp", "5", "7", "Car", "-1"})
        try {
            selectNode(scene, unknown);
            ADD_FAILURE() << unknown;
        } catch (const UsageError& error) {
            EXPECT_NE(std::string(error.what()).find("\"wheels\""), std::string::npos);
        }
    const Camera fitted = fitCamera(scene, selectNode(scene, "wheels"), scene.cameras[0], 1.5);
    expectFilled(fitted, scene, {0, 2}, 1.5);
}

} // namespace
} // namespace candelabra::test
