// SPDX-License-Identifier: Apache-2.0
#include "gltf/nodes.h"

#include <cmath>

#include <glm/gtc/quaternion.hpp>
#include <glm/gtc/type_ptr.hpp>

#include "gltf/accessor.h"
#include "scene/scene_file.h"

namespace candelabra::app
{

namespace
{

constexpr int noParent = -1;

std::string nodeName(size_t i)
{
    return gltfElement("nodes", i);
}

std::string quotedName(const GltfDocument& document, size_t i)
{
    const std::string& name = document.model.nodes[i].name;
    return nodeName(i) + (name.empty() ? "" : " \"" + printable(name, 60) + "\"");
}

[[noreturn]] void refuseSecondParent(const GltfDocument& document, size_t node, size_t first,
                                     size_t second)
{
    document.fail(nodeName(node), "has two parents, " + quotedName(document, first) + " and " +
                                      quotedName(document, second) +
                                      ", but glTF allows one: give each of them a copy of " +
                                      quotedName(document, node) + " and export again");
}

std::vector<int> findParents(const GltfDocument& document)
{
    const auto& nodes = document.model.nodes;
    std::vector<int> parents(nodes.size(), noParent);
    for (size_t i = 0; i < nodes.size(); ++i)
        for (const int child : nodes[i].children) {
            int& parent = parents[size_t(child)];
            if (parent != noParent)
                refuseSecondParent(document, size_t(child), size_t(parent), i);
            parent = int(i);
        }
    return parents;
}

// Fails if the nodes form a cycle. Every node has at most one parent here, so a cycle is a chain of
// parents that leads back to its start. Every node is visited once.
void refuseCycles(const GltfDocument& document, const std::vector<int>& parents)
{
    constexpr size_t unseen = 0;
    std::vector<size_t> walk(parents.size(), unseen);
    for (size_t start = 0; start < parents.size(); ++start)
        for (size_t i = start; walk[i] == unseen; i = size_t(parents[i])) {
            walk[i] = start + 1;
            if (parents[i] == noParent)
                break;
            if (walk[size_t(parents[i])] == start + 1)
                document.fail(nodeName(i), "is its own ancestor");
        }
}

std::vector<GltfPlacedNode> nodesWithoutParent(const std::vector<int>& parents)
{
    std::vector<GltfPlacedNode> roots;
    for (size_t i = 0; i < parents.size(); ++i)
        if (parents[i] == noParent)
            roots.push_back({i, glm::dmat4(1), {}});
    return roots;
}

// Returns for each node whether one of these nodes is above it.
std::vector<bool> findNodesBelow(const GltfDocument& document, std::vector<int> nodes)
{
    std::vector<bool> below(document.model.nodes.size());
    while (!nodes.empty()) {
        const int node = nodes.back();
        nodes.pop_back();
        for (const int child : document.model.nodes[size_t(node)].children)
            if (!below[size_t(child)]) {
                below[size_t(child)] = true;
                nodes.push_back(child);
            }
    }
    return below;
}

// Returns the roots of the scene that is drawn. worldFromNode is the transform of what is above
// them: none, but for broken files that list nodes that have parents.
std::vector<GltfPlacedNode> findRoots(const GltfDocument& document, const std::vector<int>& parents)
{
    if (document.model.scenes.empty()) {
        if (!parents.empty())
            document.warn("", "has no scene; all its nodes are used");
        return nodesWithoutParent(parents);
    }
    const auto index = size_t(std::max(document.model.defaultScene, 0));
    const std::string scene = gltfElement("scenes", index);
    if (const size_t scenes = document.model.scenes.size(); scenes > 1)
        document.warn("", "has " + std::to_string(scenes) + " scenes, of which only " + scene +
                              " is drawn");
    const std::vector<int>& listed = document.model.scenes[index].nodes;
    const std::vector<bool> below = findNodesBelow(document, listed);
    std::vector<GltfPlacedNode> roots;
    std::vector<glm::dmat4> worldFromNodes;
    for (const int root : listed) {
        const auto i = size_t(root);
        glm::dmat4 worldFromParent(1);
        if (below[i]) {
            document.warn(nodeName(i), "is listed as a root of " + scene +
                                           " and is below another node of it; it is drawn once, "
                                           "there");
            continue;
        }
        if (parents[i] != noParent) {
            document.warn(nodeName(i), "is listed as a root of " + scene + " and is a child of " +
                                           nodeName(size_t(parents[i])) +
                                           ", which the scene lacks; it is drawn where that node "
                                           "puts it");
            if (worldFromNodes.empty())
                worldFromNodes = gltfWorldTransforms(document);
            worldFromParent = worldFromNodes[size_t(parents[i])];
        }
        roots.push_back({i, worldFromParent, {}});
    }
    return roots;
}

glm::dmat4 localTransform(const GltfDocument& document, size_t index)
{
    const tinygltf::Node& node = document.model.nodes[index];
    if (!node.matrix.empty()) {
        const glm::dmat4 m = glm::make_mat4(node.matrix.data());
        requireAffine(document, nodeName(index) + ".matrix", m);
        return m;
    }
    GltfTransform transform;
    if (!node.rotation.empty())
        transform.rotation = glm::make_vec4(node.rotation.data());
    if (!node.scale.empty())
        transform.scale = glm::make_vec3(node.scale.data());
    if (!node.translation.empty())
        transform.translation = glm::make_vec3(node.translation.data());
    return gltfMatrix(document, nodeName(index) + ".rotation", transform);
}

// Places these nodes and all below them, parents before children.
std::vector<GltfPlacedNode> placeFrom(const GltfDocument& document,
                                      const std::vector<GltfPlacedNode>& roots)
{
    std::vector<GltfPlacedNode> placed;
    // A stack and not recursion, because chains of nodes can be long. Here worldFromNode is still
    // the transform of the parent.
    std::vector<GltfPlacedNode> open(roots.rbegin(), roots.rend());
    while (!open.empty()) {
        GltfPlacedNode current = open.back();
        open.pop_back();
        current.worldFromNode *= localTransform(document, current.node);
        refuseHugeTransform(document, nodeName(current.node), current.worldFromNode);
        placed.push_back(current);
        const std::vector<int>& children = document.model.nodes[current.node].children;
        for (auto child = children.rbegin(); child != children.rend(); ++child)
            open.push_back(
                {size_t(*child), current.worldFromNode, current.node, current.depth + 1});
    }
    return placed;
}

} // namespace

glm::dmat4 gltfMatrix(const GltfDocument& document, const std::string& rotation,
                      const GltfTransform& transform)
{
    const glm::dvec4& r = transform.rotation;
    const glm::dquat q(r.w, r.x, r.y, r.z);
    const bool isZero = !(glm::length(q) > 1e-6);
    if (isZero)
        document.warn(rotation, "is 0, 0, 0, 0; no rotation is used");
    glm::dmat4 m = isZero ? glm::dmat4(1) : glm::mat4_cast(glm::normalize(q));
    for (int i = 0; i < 3; ++i)
        m[i] *= transform.scale[i];
    m[3] = glm::dvec4(transform.translation, 1);
    return m;
}

void requireAffine(const GltfDocument& document, const std::string& element, const glm::dmat4& m)
{
    for (int column = 0; column < 4; ++column)
        if (!(std::abs(m[column][3] - (column == 3 ? 1 : 0)) <= 1e-6))
            document.fail(element, "must have 0, 0, 0, 1 as its last row");
}

void refuseHugeTransform(const GltfDocument& document, const std::string& element,
                         const glm::dmat4& world)
{
    for (int column = 0; column < 4; ++column)
        for (int row = 0; row < 3; ++row)
            if (!(std::abs(world[column][row]) <= maxCoordinate))
                document.fail(element, "has a transform that exceeds 1e12 m in world space");
}

std::vector<GltfPlacedNode> placeGltfNodes(const GltfDocument& document)
{
    const std::vector<int> parents = findParents(document);
    refuseCycles(document, parents);
    return placeFrom(document, findRoots(document, parents));
}

std::vector<glm::dmat4> gltfWorldTransforms(const GltfDocument& document)
{
    const std::vector<int> parents = findParents(document);
    refuseCycles(document, parents);
    std::vector<glm::dmat4> worldFromNodes(parents.size());
    for (const GltfPlacedNode& placed : placeFrom(document, nodesWithoutParent(parents)))
        worldFromNodes[placed.node] = placed.worldFromNode;
    return worldFromNodes;
}

std::vector<glm::dmat4> readGltfInstancing(const GltfDocument& document, size_t node,
                                           size_t mostInstances)
{
    const auto* extension =
        GltfDocument::extension(document.json["nodes"][node], "EXT_mesh_gpu_instancing");
    if (!extension)
        return {glm::dmat4(1)};
    const nlohmann::json& attributes = (*extension)["attributes"];
    const std::string element =
        gltfElement("nodes", node) + ".extensions.EXT_mesh_gpu_instancing.attributes";
    std::optional<size_t> count;
    const auto find = [&](const char* name, int components) -> std::optional<GltfAccessor> {
        const auto found = attributes.find(name);
        if (found == attributes.end())
            return std::nullopt;
        GltfAccessor accessor(document, found->get<int>());
        if (accessor.components() != components)
            document.fail(element + "." + name,
                          accessor.element() + " has the wrong number of components");
        if (count && accessor.count() != *count)
            document.fail(element + "." + name,
                          accessor.element() + " has " + std::to_string(accessor.count()) +
                              " elements, others have " + std::to_string(*count));
        count = accessor.count();
        return accessor;
    };
    const auto translations = find("TRANSLATION", 3);
    const auto rotations = find("ROTATION", 4);
    const auto scales = find("SCALE", 3);
    if (!count) {
        document.warn(element, "has no TRANSLATION, ROTATION or SCALE; the mesh is drawn once");
        return {glm::dmat4(1)};
    }
    if (*count > mostInstances)
        document.failTooLarge(element,
                              "has " + std::to_string(*count) + " instances, more than the " +
                                  std::to_string(mostInstances) + " that the scene has room for");
    std::vector<glm::dmat4> out;
    out.reserve(*count);
    for (size_t i = 0; i < *count; ++i) {
        GltfTransform transform;
        if (translations)
            transform.translation = glm::dvec3(translations->read(i));
        if (rotations)
            transform.rotation = glm::dvec4(rotations->read(i));
        if (scales)
            transform.scale = glm::dvec3(scales->read(i));
        out.push_back(gltfMatrix(document, element + ".ROTATION", transform));
    }
    return out;
}

} // namespace candelabra::app
