// SPDX-License-Identifier: Apache-2.0
#include "gltf/pose.h"

#include <algorithm>
#include <cmath>
#include <optional>

#include <glm/gtc/matrix_transform.hpp>

#include "scene/cofactors.h"

namespace candelabra::app
{

namespace
{

template <typename V>
V morphed(V value, const auto& morphs, size_t i)
{
    for (const auto& morph : morphs)
        value += morph.weight * V(morph.offsets.read(i));
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
        pose.owner = int64_t(placed.node);
    pose.weights =
        node.weights.empty() ? document_.model.meshes[size_t(node.mesh)].weights : node.weights;
    pose.worldFromMesh = placed.worldFromNode;
    if (node.skin < 0)
        return pose;
    const auto index = size_t(node.skin);
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
    pose.skin = element;
    const auto firstJoint = size_t(skin.joints[0]);
    pose.worldFromMesh = glm::translate(glm::dmat4(1), glm::dvec3(worldFromNodes_[firstJoint][3]));
    const glm::dmat4 meshFromWorld = glm::inverse(pose.worldFromMesh);
    pose.meshFromRest = meshFromWorld * placed.worldFromNode;
    for (size_t j = 0; j < skin.joints.size(); ++j) {
        const glm::dmat4& worldFromJoint = worldFromNodes_[size_t(skin.joints[j])];
        const glm::dmat4 fromBind = jointFromBind ? jointFromBind->readMatrix(j) : glm::dmat4(1);
        requireAffine(document_, element + "." + gltfElement("inverseBindMatrices", j), fromBind);
        pose.meshFromBind.push_back(meshFromWorld * worldFromJoint * fromBind);
    }
    return pose;
}

GltfPosedVertices::GltfPosedVertices(const GltfDocument& document,
                                     const tinygltf::Primitive& primitive,
                                     const std::string& element, const GltfPose& pose,
                                     size_t vertexCount)
    : document_(document), element_(element), pose_(pose)
{
    const auto vectors = [&](const char* attribute, int components) {
        return morphs(primitive, attribute, gltfVertexAttribute, components, components,
                      vertexCount);
    };
    positions_ = vectors("POSITION", 3);
    normals_ = vectors("NORMAL", 3);
    tangents_ = vectors("TANGENT", 3);
    uvs_[0] = vectors("TEXCOORD_0", 2);
    uvs_[1] = vectors("TEXCOORD_1", 2);
    // Offsets without alpha have the alpha 0, whether or not the attribute itself has one
    // (glTF 2.0, section 3.7.2.2).
    colors_ = morphs(primitive, "COLOR_0", gltfColorAttribute, 3, 4, vertexCount);
    if (isSkinned())
        readInfluences(primitive, vertexCount);
}

std::vector<GltfPosedVertices::Morph>
GltfPosedVertices::morphs(const tinygltf::Primitive& primitive, const char* attribute,
                          OpenAttribute open, int minComponents, int maxComponents,
                          size_t vertexCount) const
{
    std::vector<Morph> out;
    if (!primitive.attributes.contains(attribute))
        return out;
    const size_t count = std::min(primitive.targets.size(), pose_.weights.size());
    for (size_t t = 0; t < count; ++t) {
        const auto found = primitive.targets[t].find(attribute);
        if (pose_.weights[t] == 0 || found == primitive.targets[t].end())
            continue;
        const std::string element = element_ + "." + gltfElement("targets", t) + "." + attribute;
        out.push_back({pose_.weights[t], open(document_, element, found->second, minComponents,
                                              maxComponents, vertexCount)});
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
        const int type = joints->componentType();
        if (joints->isNormalized() || (type != TINYGLTF_COMPONENT_TYPE_UNSIGNED_BYTE &&
                                       type != TINYGLTF_COMPONENT_TYPE_UNSIGNED_SHORT))
            document_.fail(element_ + ".attributes.JOINTS_" + std::to_string(set),
                           joints->element() +
                               " must have unsigned bytes or shorts that are not normalized");
        influences_.push_back({*joints, *weights});
    }
    if (influences_.empty())
        document_.warn(element_, "has no JOINTS_0 or no WEIGHTS_0, so its skin does not move it");
    checkWeights(vertexCount);
}

void GltfPosedVertices::checkWeights(size_t vertexCount) const
{
    bool free = false;
    for (size_t i = 0; i < vertexCount && !influences_.empty(); ++i) {
        double total = 0;
        for (const Influences& influences : influences_) {
            const glm::dvec4 weights(influences.weights.read(i));
            for (int c = 0; c < 4; ++c) {
                if (!(weights[c] >= 0))
                    document_.fail(element_, "vertex " + std::to_string(i) +
                                                 " has a joint whose weight is not 0 or more");
                total += weights[c];
            }
        }
        free = free || total == 0;
    }
    if (free)
        document_.warn(element_, "has vertices whose weights are 0, which follow the first joint");
}

// The mean of the joints' transforms, weighted by what they contribute to vertex i.
glm::dmat4 GltfPosedVertices::meshFromVertex(size_t i) const
{
    if (influences_.empty())
        return pose_.meshFromRest;
    glm::dmat4 sum{0};
    double total = 0;
    for (const Influences& influences : influences_) {
        const glm::dvec4 joints(influences.joints.read(i));
        const glm::dvec4 weights(influences.weights.read(i));
        for (int c = 0; c < 4; ++c) {
            if (weights[c] == 0)
                continue;
            const auto joint = size_t(joints[c]);
            const size_t count = pose_.meshFromBind.size();
            if (joint >= count)
                document_.fail(element_, "vertex " + std::to_string(i) + " follows joint " +
                                             std::to_string(joint) + ", but " + pose_.skin +
                                             " has " + std::to_string(count) +
                                             (count == 1 ? " joint" : " joints"));
            sum += weights[c] * pose_.meshFromBind[joint];
            total += weights[c];
        }
    }
    return total > 0 ? sum / total : pose_.meshFromBind[0];
}

glm::dvec3 GltfPosedVertices::position(size_t i, const glm::dvec3& rest) const
{
    const glm::dvec3 p = morphed(rest, positions_, i);
    return isSkinned() ? glm::dvec3(meshFromVertex(i) * glm::dvec4(p, 1)) : p;
}

glm::dvec3 GltfPosedVertices::normal(size_t i, const glm::dvec3& rest) const
{
    const glm::dvec3 n = morphed(rest, normals_, i);
    if (!isSkinned())
        return n;
    const glm::dmat3 m(meshFromVertex(i));
    return normalizedOrZero(cofactors(m) * n) * (glm::determinant(m) < 0 ? -1.0 : 1.0);
}

glm::dvec3 GltfPosedVertices::tangent(size_t i, const glm::dvec3& rest) const
{
    const glm::dvec3 t = morphed(rest, tangents_, i);
    return isSkinned() ? normalizedOrZero(glm::dmat3(meshFromVertex(i)) * t) : t;
}

glm::vec2 GltfPosedVertices::uv(size_t i, size_t set, const glm::vec2& rest) const
{
    return glm::vec2(morphed(glm::dvec2(rest), uvs_[set], i));
}

glm::vec4 GltfPosedVertices::color(size_t i, const glm::vec4& rest) const
{
    return glm::vec4(morphed(glm::dvec4(rest), colors_, i));
}

} // namespace candelabra::app
