// SPDX-License-Identifier: Apache-2.0
#include "gltf/pose.h"

#include <algorithm>
#include <cmath>
#include <optional>

namespace candelabra::app
{

namespace
{

glm::dvec3 morphed(glm::dvec3 value, const auto& morphs, size_t i)
{
    for (const auto& morph : morphs)
        value += morph.weight * glm::dvec3(morph.offsets.read(i));
    return value;
}

glm::dvec3 normalizedOrZero(const glm::dvec3& v)
{
    const double length = glm::length(v);
    return length > 0 && std::isfinite(length) ? v / length : glm::dvec3(0);
}

} // namespace

GltfPoses::GltfPoses(const GltfDocument& document) : document_(document)
{
    if (!document.model.skins.empty())
        worldFromNodes_ = gltfWorldTransforms(document);
}

GltfPose GltfPoses::of(const GltfPlacedNode& placed) const
{
    const tinygltf::Node& node = document_.model.nodes[placed.node];
    GltfPose pose;
    if (node.skin >= 0 || !node.weights.empty())
        pose.owner = static_cast<int64_t>(placed.node);
    pose.weights = node.weights.empty()
                       ? document_.model.meshes[static_cast<size_t>(node.mesh)].weights
                       : node.weights;
    if (node.skin < 0)
        return pose;
    const auto index = static_cast<size_t>(node.skin);
    const tinygltf::Skin& skin = document_.model.skins[index];
    const std::string element = gltfElement("skins", index);
    if (skin.joints.empty())
        document_.fail(element, "has no joints");
    std::optional<GltfAccessor> jointFromBind; // without it, meshes are bound as they are
    if (skin.inverseBindMatrices >= 0) {
        jointFromBind.emplace(document_, skin.inverseBindMatrices);
        if (!jointFromBind->isMatrix4() || jointFromBind->count() < skin.joints.size())
            document_.fail(element + ".inverseBindMatrices",
                           jointFromBind->element() + " must have a MAT4 of floats for each of " +
                               std::to_string(skin.joints.size()) + " joints");
    }
    // The transform of a node with a skin moves nothing (glTF 2.0, section 3.7.3.3).
    const glm::dmat4 nodeFromWorld = glm::inverse(placed.worldFromNode);
    for (size_t j = 0; j < skin.joints.size(); ++j) {
        const glm::dmat4& worldFromJoint = worldFromNodes_[static_cast<size_t>(skin.joints[j])];
        pose.nodeFromBind.push_back(nodeFromWorld * worldFromJoint *
                                    (jointFromBind ? jointFromBind->readMatrix(j) : glm::dmat4(1)));
    }
    return pose;
}

GltfPosedVertices::GltfPosedVertices(const GltfDocument& document,
                                     const tinygltf::Primitive& primitive,
                                     const std::string& element, const GltfPose& pose,
                                     size_t vertexCount)
    : document_(document), element_(element), pose_(pose)
{
    positions_ = morphs(primitive, "POSITION", vertexCount);
    normals_ = morphs(primitive, "NORMAL", vertexCount);
    tangents_ = morphs(primitive, "TANGENT", vertexCount);
    if (!pose.nodeFromBind.empty())
        readInfluences(primitive, vertexCount);
}

std::vector<GltfPosedVertices::Morph>
GltfPosedVertices::morphs(const tinygltf::Primitive& primitive, const char* attribute,
                          size_t vertexCount) const
{
    std::vector<Morph> out;
    const size_t count = std::min(primitive.targets.size(), pose_.weights.size());
    for (size_t t = 0; t < count; ++t) {
        const auto found = primitive.targets[t].find(attribute);
        if (pose_.weights[t] == 0 || found == primitive.targets[t].end())
            continue;
        const std::string element = element_ + "." + gltfElement("targets", t) + "." + attribute;
        out.push_back({pose_.weights[t],
                       gltfVertexAttribute(document_, element, found->second, 3, 3, vertexCount)});
    }
    return out;
}

void GltfPosedVertices::readInfluences(const tinygltf::Primitive& primitive, size_t vertexCount)
{
    const auto find = [&](const std::string& name) -> std::optional<GltfAccessor> {
        const auto found = primitive.attributes.find(name);
        if (found == primitive.attributes.end())
            return std::nullopt;
        return gltfVertexAttribute(document_, element_ + ".attributes." + name, found->second, 4, 4,
                                   vertexCount);
    };
    for (size_t set = 0;; ++set) {
        const auto joints = find("JOINTS_" + std::to_string(set));
        const auto weights = find("WEIGHTS_" + std::to_string(set));
        if (!joints || !weights)
            break;
        influences_.push_back({*joints, *weights});
    }
    if (influences_.empty())
        document_.warn(element_, "has no JOINTS_0 or no WEIGHTS_0, so its skin does not move it");
}

// The mean of the joints' transforms, weighted by what they contribute to vertex i.
glm::dmat4 GltfPosedVertices::nodeFromVertex(size_t i) const
{
    glm::dmat4 sum{0};
    double total = 0;
    for (const Influences& influences : influences_) {
        const glm::dvec4 joints(influences.joints.read(i));
        const glm::dvec4 weights(influences.weights.read(i));
        for (int c = 0; c < 4; ++c) {
            if (!(weights[c] > 0))
                continue;
            if (!(joints[c] >= 0 && joints[c] < static_cast<double>(pose_.nodeFromBind.size())))
                document_.fail(element_, "is moved by joint " +
                                             std::to_string(static_cast<int64_t>(joints[c])) +
                                             " of a skin of " +
                                             std::to_string(pose_.nodeFromBind.size()) + " joints");
            sum += weights[c] * pose_.nodeFromBind[static_cast<size_t>(joints[c])];
            total += weights[c];
        }
    }
    // A vertex without weights follows the first joint, which is usually the root.
    return total > 0 ? sum / total : pose_.nodeFromBind[0];
}

glm::dvec3 GltfPosedVertices::position(size_t i, const glm::dvec3& rest) const
{
    const glm::dvec3 p = morphed(rest, positions_, i);
    return influences_.empty() ? p : glm::dvec3(nodeFromVertex(i) * glm::dvec4(p, 1));
}

glm::dvec3 GltfPosedVertices::normal(size_t i, const glm::dvec3& rest) const
{
    const glm::dvec3 n = morphed(rest, normals_, i);
    if (influences_.empty())
        return n;
    // The matrix of cofactors is the inverse transpose times the determinant, and exists without
    // an inverse too.
    const glm::dmat3 m(nodeFromVertex(i));
    const glm::dmat3 cofactors(glm::cross(m[1], m[2]), glm::cross(m[2], m[0]),
                               glm::cross(m[0], m[1]));
    return normalizedOrZero(cofactors * n) * (glm::determinant(m) < 0 ? -1.0 : 1.0);
}

glm::dvec3 GltfPosedVertices::tangent(size_t i, const glm::dvec3& rest) const
{
    const glm::dvec3 t = morphed(rest, tangents_, i);
    return influences_.empty() ? t : normalizedOrZero(glm::dmat3(nodeFromVertex(i)) * t);
}

} // namespace candelabra::app
