// SPDX-License-Identifier: Apache-2.0
// Converts a glTF 2.0 file to a Scene. This file walks the nodes and adds their instances and
// cameras; the other files of the folder read meshes, materials and lights.
#include <algorithm>
#include <cmath>
#include <filesystem>
#include <map>
#include <optional>
#include <tuple>

#include "gltf/document.h"
#include "gltf/gltf.h"
#include "gltf/lights.h"
#include "gltf/material.h"
#include "gltf/mesh.h"
#include "gltf/nodes.h"
#include "gltf/pose.h"
#include "scene/scene_error.h"
#include "scene/scene_file.h"

namespace candelabra::app
{

namespace
{

// The limit is 0.5 GB of instances. A small file can ask for far more, because every node may have
// all primitives of a mesh.
constexpr size_t maxInstances = size_t{1} << 22;

bool hasTriangles(const tinygltf::Primitive& primitive)
{
    return primitive.mode >= TINYGLTF_MODE_TRIANGLES;
}

class SceneBuilder
{
public:
    SceneBuilder(const GltfDocument& document, const SceneOptions& options, Scene& scene)
        : document_(document),
          options_(options),
          scene_(scene),
          defaultMaterial_(readGltfMaterials(document, scene)),
          poses_(document),
          lostMesh_(document.lostMesh)
    {
    }

    void add(const GltfPlacedNode& placed);
    void finish();

private:
    static constexpr int64_t noMesh = -1;

    void addMesh(const GltfPlacedNode& placed);
    void addInstance(const std::string& element, size_t gltfMesh, const GltfPose& pose,
                     glm::dmat4 worldFromMesh);
    // Calls `add`. If it fails, warns that `what` is left out and returns the failure. A scene that
    // is too large still fails.
    template <typename Add>
    std::optional<SceneError> addOrLeaveOut(const char* what, const Add& add);
    void noteLostMesh(const std::optional<SceneError>& fault)
    {
        if (!lostMesh_)
            lostMesh_ = fault;
    }
    // Counts the points or lines of a primitive that consists of them, and not of triangles.
    void countLeftOut(const tinygltf::Primitive& primitive);
    void warnOfLeftOut() const;
    void addCamera(const GltfPlacedNode& placed);
    void requireRoom(const std::string& element) const;
    // The index in scene.meshes of a primitive in a pose. It is read when it is first asked for.
    // noMesh if the primitive cannot be drawn.
    int64_t mesh(size_t gltfMesh, size_t primitive, const GltfPose& pose, bool mirrored);
    uint32_t material(const tinygltf::Primitive& primitive) const
    {
        return primitive.material < 0 ? defaultMaterial_ : uint32_t(primitive.material);
    }

    const GltfDocument& document_;
    const SceneOptions& options_;
    Scene& scene_;
    uint32_t defaultMaterial_;
    GltfMeshBudget budget_;
    GltfPoses poses_;
    std::map<std::tuple<size_t, size_t, int64_t, bool>, int64_t> meshes_;
    size_t points_ = 0, lines_ = 0; // left out, of all instances
    bool foundTriangles_ = false;
    bool hasSurfaces_ = false; // also if a light of the scene took the place of the surface
    std::optional<SceneError> lostMesh_; // the first fault for which a mesh was left out
    GltfLights lights_;
    GltfEmissiveRectangles emissive_;
};

void SceneBuilder::add(const GltfPlacedNode& placed)
{
    const tinygltf::Node& node = document_.model.nodes[placed.node];
    if (node.mesh >= 0)
        noteLostMesh(addOrLeaveOut("the mesh of the node", [&] { addMesh(placed); }));
    if (node.camera >= 0)
        addCamera(placed);
    addOrLeaveOut("the light", [&] { addGltfLights(document_, placed, options_, lights_); });
}

template <typename Add>
std::optional<SceneError> SceneBuilder::addOrLeaveOut(const char* what, const Add& add)
{
    try {
        add();
        return std::nullopt;
    } catch (const SceneTooLarge&) {
        throw;
    } catch (const SceneError& error) {
        document_.warnInstead(error, std::string(what) + " is left out");
        return error;
    }
}

int64_t SceneBuilder::mesh(size_t gltfMesh, size_t primitive, const GltfPose& pose, bool mirrored)
{
    const auto key = std::make_tuple(gltfMesh, primitive, pose.owner, mirrored);
    if (const auto found = meshes_.find(key); found != meshes_.end())
        return found->second;
    int64_t index = noMesh;
    std::optional<Mesh> result;
    if (mirrored) {
        const int64_t original = mesh(gltfMesh, primitive, pose, false);
        if (original != noMesh) {
            const Mesh& source = scene_.meshes[size_t(original)];
            takeGltfBudget(document_, gltfElement("meshes", gltfMesh), source.vertices.size(),
                           source.indices.size(), budget_);
            result = mirroredMesh(source);
        }
    } else {
        const auto& source = document_.model.meshes[gltfMesh].primitives[primitive];
        noteLostMesh(addOrLeaveOut("the primitive", [&] {
            result = readGltfPrimitive(document_, gltfMesh, primitive,
                                       scene_.materials[material(source)], pose, budget_);
        }));
    }
    if (result) {
        index = int64_t(scene_.meshes.size());
        scene_.meshes.push_back(std::move(*result));
    }
    meshes_.emplace(key, index);
    return index;
}

void SceneBuilder::addMesh(const GltfPlacedNode& placed)
{
    const std::string element = gltfElement("nodes", placed.node);
    const auto gltfMesh = size_t(document_.model.nodes[placed.node].mesh);
    const GltfPose pose = poses_.of(placed);
    const size_t room = maxInstances - scene_.instances.size();
    std::vector<glm::dmat4> copies = readGltfInstancing(document_, placed.node, room);
    for (glm::dmat4& copy : copies) {
        copy = pose.worldFromMesh * copy;
        refuseHugeTransform(document_, element, copy);
    }
    for (const glm::dmat4& worldFromMesh : copies)
        addInstance(element, gltfMesh, pose, worldFromMesh);
}

// Adds one copy of a mesh, which belongs to the node `element`.
void SceneBuilder::addInstance(const std::string& element, size_t gltfMesh, const GltfPose& pose,
                               glm::dmat4 worldFromMesh)
{
    const auto& primitives = document_.model.meshes[gltfMesh].primitives;
    for (const tinygltf::Primitive& primitive : primitives)
        countLeftOut(primitive);
    if (std::ranges::none_of(primitives, hasTriangles))
        return;
    foundTriangles_ = true;
    const double determinant = glm::determinant(glm::dmat3(worldFromMesh));
    if (determinant == 0 || !std::isfinite(1 / determinant)) {
        document_.warn(element,
                       "has a transform that flattens its mesh; its triangles are left out");
        return;
    }
    // The transform of an instance must not mirror, so that front faces stay counter-clockwise. A
    // mirroring transform M is split into (M S) S with S = diag(-1, 1, 1): the right S goes into a
    // mirrored mesh, and M S is the transform of the instance.
    const bool mirrored = determinant < 0;
    if (mirrored)
        worldFromMesh[0] = -worldFromMesh[0];
    for (size_t p = 0; p < primitives.size(); ++p) {
        if (!hasTriangles(primitives[p]))
            continue;
        const int64_t index = mesh(gltfMesh, p, pose, mirrored);
        if (index == noMesh)
            continue;
        hasSurfaces_ = true;
        const uint32_t materialIndex = material(primitives[p]);
        if (options_.emissiveLights &&
            emissive_.replace(scene_.meshes[size_t(index)], scene_.materials[materialIndex],
                              worldFromMesh, lights_))
            continue;
        requireRoom(element);
        scene_.instances.push_back({uint32_t(index), materialIndex, worldFromMesh});
    }
}

void SceneBuilder::requireRoom(const std::string& element) const
{
    if (scene_.instances.size() >= maxInstances)
        document_.failTooLarge(element, "brings the scene above " + std::to_string(maxInstances) +
                                            " mesh instances");
}

void SceneBuilder::countLeftOut(const tinygltf::Primitive& primitive)
{
    if (hasTriangles(primitive))
        return;
    const auto positions = primitive.attributes.find("POSITION");
    const int accessor = primitive.indices >= 0                    ? primitive.indices
                         : positions != primitive.attributes.end() ? positions->second
                                                                   : -1;
    const size_t n = accessor < 0 ? 0 : document_.model.accessors[size_t(accessor)].count;
    if (primitive.mode == TINYGLTF_MODE_POINTS)
        points_ += n;
    else if (n >= 2)
        lines_ += primitive.mode == TINYGLTF_MODE_LINE        ? n / 2
                  : primitive.mode == TINYGLTF_MODE_LINE_LOOP ? n
                                                              : n - 1;
}

void SceneBuilder::warnOfLeftOut() const
{
    if (points_ == 0 && lines_ == 0)
        return;
    if (!foundTriangles_ && lights_.lights.empty() && document_.missingExtensions.empty())
        document_.fail("", "has only points and lines, which are not drawn");
    const auto counted = [](size_t count, const char* noun) {
        return std::to_string(count) + " " + noun + (count == 1 ? "" : "s");
    };
    std::string what = points_ ? counted(points_, "point") : "";
    if (lines_)
        what += (what.empty() ? "" : " and ") + counted(lines_, "line");
    document_.warn("", "has " + what + (points_ + lines_ == 1 ? ", which is" : ", which are") +
                           " not drawn");
}

// Adds the camera of a node. glTF cameras look along the node's -z axis, and +y is up; the node's
// scale makes no difference.
void SceneBuilder::addCamera(const GltfPlacedNode& placed)
{
    const tinygltf::Node& node = document_.model.nodes[placed.node];
    const auto index = size_t(node.camera);
    const tinygltf::Camera& source = document_.model.cameras[index];
    const std::string element = gltfElement("cameras", index);
    Camera camera;
    camera.name = source.name.empty() ? node.name : source.name;
    const glm::dmat4& m = placed.worldFromNode;
    const glm::dvec3 y(m[1]), z(m[2]);
    if (!(glm::length(glm::cross(y, z)) > 1e-12 * glm::length(y) * glm::length(z))) {
        document_.warn(element, "is scaled to zero size by its node and is left out");
        return;
    }
    camera.position = glm::dvec3(m[3]);
    camera.forward = -glm::normalize(z);
    camera.up = glm::normalize(y - camera.forward * glm::dot(camera.forward, y));
    camera.orthographic = source.type == "orthographic";
    if (camera.orthographic) {
        const tinygltf::OrthographicCamera& lens = source.orthographic;
        if (lens.xmag == 0 || lens.ymag == 0) {
            document_.warn(element, "xmag and ymag must not be 0; the camera is left out");
            return;
        }
        if (lens.xmag < 0 || lens.ymag < 0)
            document_.warn(element, "xmag and ymag must be > 0, are " + std::to_string(lens.xmag) +
                                        " and " + std::to_string(lens.ymag) +
                                        "; they are used without their signs");
        camera.orthographicHeight = 2 * std::abs(lens.ymag);
        camera.aspect = std::abs(lens.xmag / lens.ymag);
        camera.nearPlane = lens.znear;
        camera.farPlane = lens.zfar;
    } else {
        const tinygltf::PerspectiveCamera& lens = source.perspective;
        camera.verticalFov = lens.yfov;
        if (lens.aspectRatio > 0)
            camera.aspect = lens.aspectRatio;
        camera.nearPlane = lens.znear;
        camera.farPlane = lens.zfar; // 0: infinite
    }
    if (camera.farPlane != 0 && !(camera.farPlane > camera.nearPlane)) {
        document_.warn(
            element, "zfar must be greater than znear, " + std::to_string(camera.nearPlane) +
                         ", is " + std::to_string(camera.farPlane) + "; the far plane is left out");
        camera.farPlane = camera.orthographic ? camera.nearPlane + maxCoordinate : 0;
    }
    scene_.cameras.push_back(camera);
}

void SceneBuilder::finish()
{
    if (lostMesh_ && !hasSurfaces_)
        throw *lostMesh_;
    warnOfLeftOut();
    emissive_.warn(document_);
    scene_.lights = std::move(lights_.lights);
    placeLights(scene_, lights_.positions);
    findLampBodies(scene_, lights_.positions);
    if (scene_.lights.empty() && !options_.lights && !options_.defaultLight)
        document_.warn("", "has no lights; --lights N adds some");
}

// Sets scene.nodes, given how many instances there were before each placed node was added. Nodes
// come before those below them, so the instances of a node and of all below it are one run.
void setNodes(const GltfDocument& document, const std::vector<GltfPlacedNode>& placed,
              const std::vector<size_t>& firstInstances, Scene& scene)
{
    std::vector<size_t> open; // indices into `placed` of a node and those above it
    std::vector<InstanceRange> ranges(placed.size());
    const auto closeDownTo = [&](size_t depth, size_t end) {
        for (; open.size() > depth; open.pop_back())
            ranges[open.back()] = {firstInstances[open.back()], end - firstInstances[open.back()]};
    };
    for (size_t i = 0; i < placed.size(); ++i) {
        closeDownTo(placed[i].depth, firstInstances[i]);
        open.push_back(i);
    }
    closeDownTo(0, scene.instances.size());
    for (size_t i = 0; i < placed.size(); ++i)
        if (ranges[i].count > 0)
            scene.nodes.push_back(
                {document.model.nodes[placed[i].node].name, uint32_t(placed[i].node), ranges[i]});
}

// Returns true if the content of a file is glTF: binary glTF begins with "glTF", and the JSON of
// every other glTF file has an "asset" object.
bool hasGltfContent(const std::string& path)
{
    const std::vector<uint8_t> bytes = readSceneFile(path);
    const std::string_view text(reinterpret_cast<const char*>(bytes.data()), bytes.size());
    if (text.substr(0, 4) == "glTF")
        return true;
    const size_t start = text.find_first_not_of(" \t\r\n");
    if (start == std::string_view::npos || text[start] != '{')
        failScene(path, "", "is neither glTF (.gltf, .glb) nor a scene description (.json)");
    return parseSceneJson(path, text).contains("asset");
}

} // namespace

bool isGltf(const std::string& path)
{
    if (hasExtension(path, ".gltf") || hasExtension(path, ".glb"))
        return true;
    std::error_code ignored;
    if (hasExtension(path, ".json") || path.find('\0') != std::string::npos ||
        !std::filesystem::exists(path, ignored))
        return false;
    return hasGltfContent(path);
}

Scene loadGltf(const std::string& path, const SceneOptions& options)
{
    if (options.punctualRadius &&
        !(*options.punctualRadius > 0 && *options.punctualRadius <= maxCoordinate))
        throw SceneError("the radius for punctual lights must be > 0 and at most 1e12, is " +
                         std::to_string(*options.punctualRadius));
    const GltfDocument document = openGltf(path);
    Scene scene;
    scene.name = std::filesystem::path(path).stem().string();
    // White metal that is rough, such as the default material, looks white in other programs.
    scene.energyCompensation = true;
    SceneBuilder builder(document, options, scene);
    const std::vector<GltfPlacedNode> nodes = placeGltfNodes(document);
    std::vector<size_t> firstInstances;
    for (const GltfPlacedNode& placed : nodes) {
        firstInstances.push_back(scene.instances.size());
        builder.add(placed);
    }
    builder.finish();
    setNodes(document, nodes, firstInstances, scene);
    if (scene.instances.empty() && !document.missingExtensions.empty())
        document.fail("", "has nothing that can be drawn without the extensions that it requires "
                          "and that are not supported: " +
                              document.missingExtensions);
    scene.warnings = document.warnings.sentences(path);
    return scene;
}

} // namespace candelabra::app
