// SPDX-License-Identifier: Apache-2.0
// glTF primitives -> triangle meshes. Internal to the glTF loader; throws SceneError.
#pragma once

#include <cstdint>
#include <optional>

#include "gltf/document.h"
#include "scene/scene.h"

namespace candelabra::app
{

// Sizes accepted for one scene, so that a small file with shared accessors cannot fill the memory:
// 2.4 GB of vertices and 1.1 GB of indices.
constexpr uint64_t maxSceneVertices = uint64_t{1} << 25;
constexpr uint64_t maxSceneIndices = uint64_t{1} << 28;

// What is left of them while a file is read.
struct GltfMeshBudget {
    uint64_t vertices = maxSceneVertices;
    uint64_t indices = maxSceneIndices;
};

// Takes from the budget or fails naming `element`.
void takeGltfBudget(const GltfDocument& document, const std::string& element, uint64_t vertices,
                    uint64_t indices, GltfMeshBudget& budget);

// The triangles of one primitive with all vertex attributes filled in: missing normals are flat
// (corners no longer shared), missing tangents follow the UVs of `material`'s normal map. Empty,
// with a warning, for points, lines and primitives without triangles.
std::optional<Mesh> readGltfPrimitive(const GltfDocument& document, size_t mesh, size_t primitive,
                                      const Material& material, GltfMeshBudget& budget);

// The mesh reflected in its object-space x axis, front faces counter-clockwise again: drawn with
// M * diag(-1, 1, 1), it looks as the original drawn with a mirroring M.
Mesh mirroredMesh(const Mesh& mesh);

// --- frames.cpp ---
// Gives every corner its own vertex with the normal of its triangle.
void makeFlatNormals(Mesh& mesh);
// Replaces normals of zero length by the area-weighted mean of the triangles around; returns how
// many there were.
size_t repairNormals(Mesh& mesh);
// Tangents along u of uv set ref.uvSet after ref's transform; vertices where triangles of both
// orientations meet are split. Where u has no direction, any tangent perpendicular to the normal.
void makeTangents(Mesh& mesh, const TextureRef& ref);
// Any unit tangent perpendicular to the unit normal.
glm::vec4 anyTangent(const glm::vec3& normal);

} // namespace candelabra::app
