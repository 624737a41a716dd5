// SPDX-License-Identifier: Apache-2.0
// The pose in which a node draws its mesh: the weights of morph targets, and the joints of a skin
// where the nodes of the file put them. Animations are not played. Internal to the glTF loader. All
// functions throw SceneError.
#pragma once

#include <cstdint>
#include <string>
#include <vector>

#include <glm/glm.hpp>

#include "gltf/accessor.h"
#include "gltf/document.h"
#include "gltf/nodes.h"

namespace candelabra::app
{

struct GltfPose {
    static constexpr int64_t ofMesh = -1;

    // The node that has the pose, or ofMesh if all nodes without their own pose share it.
    int64_t owner = ofMesh;
    std::vector<double> weights; // of the morph targets; those beyond the list are 0
    // The transform of the mesh's node. glTF ignores it for a node with a skin (glTF 2.0, section
    // 3.7.3.3). There this is a translation to the skin's first joint, so that positions keep their
    // digits far from the origin.
    glm::dmat4 worldFromMesh{1};
    std::string skin; // its name in messages
    // For each joint of the skin, the transform from the mesh as it is in the file to the posed
    // mesh. Empty without a skin.
    std::vector<glm::dmat4> meshFromBind;
    // With a skin, the same for primitives that no joint moves, which the node's transform places.
    glm::dmat4 meshFromRest{1};
};

class GltfPoses
{
public:
    explicit GltfPoses(const GltfDocument& document);
    // The pose of a node that has a mesh.
    GltfPose of(const GltfPlacedNode& placed) const;

private:
    const GltfDocument& document_;
    std::vector<glm::dmat4> worldFromNodes_; // empty if the file has no skin
};

// Poses the vertices of a primitive. The arguments `rest` are the attributes of vertex i without
// morph targets and skin. A skin changes neither texture coordinates nor colours.
class GltfPosedVertices
{
public:
    GltfPosedVertices(const GltfDocument& document, const tinygltf::Primitive& primitive,
                      const std::string& element, const GltfPose& pose, size_t vertexCount);

    glm::dvec3 position(size_t i, const glm::dvec3& rest) const;
    // Not normalised, unless the primitive has a skin.
    glm::dvec3 normal(size_t i, const glm::dvec3& rest) const;
    glm::dvec3 tangent(size_t i, const glm::dvec3& rest) const;
    glm::vec2 uv(size_t i, size_t set, const glm::vec2& rest) const; // set: 0 or 1
    glm::vec4 color(size_t i, const glm::vec4& rest) const;          // may leave 0..1

private:
    struct Morph {
        double weight;
        GltfAccessor offsets;
    };
    struct Influences {
        GltfAccessor joints, weights; // four of each per vertex
    };

    using OpenAttribute = decltype(&gltfVertexAttribute);

    // The targets of an attribute with weights other than 0. There are none if the primitive does
    // not have the attribute.
    std::vector<Morph> morphs(const tinygltf::Primitive& primitive, const char* attribute,
                              OpenAttribute open, int minComponents, int maxComponents,
                              size_t vertexCount) const;
    void readInfluences(const tinygltf::Primitive& primitive, size_t vertexCount);
    void checkWeights(size_t vertexCount) const;
    glm::dmat4 meshFromVertex(size_t i) const;
    bool isSkinned() const { return !pose_.meshFromBind.empty(); }

    const GltfDocument& document_;
    std::string element_;
    const GltfPose& pose_;
    std::vector<Morph> positions_, normals_, tangents_, uvs_[2], colors_;
    std::vector<Influences> influences_; // empty if no joint moves the vertices
};

} // namespace candelabra::app
