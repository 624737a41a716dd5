// SPDX-License-Identifier: Apache-2.0
// Reads glTF primitives as triangle meshes. Internal to the glTF loader. Throws SceneError.
#pragma once

#include <cstdint>
#include <optional>
#include <string>

#include "gltf/document.h"
#include "gltf/pose.h"
#include "scene/scene.h"

namespace candelabra::app
{

// The name of a primitive in messages, such as "meshes[3].primitives[0]".
std::string gltfPrimitive(size_t mesh, size_t primitive);

// The largest sizes of a scene, 2.4 GB of vertices and 1.1 GB of indices, so that a small file with
// shared accessors cannot fill the memory.
constexpr uint64_t maxSceneVertices = uint64_t{1} << 25;
constexpr uint64_t maxSceneIndices = uint64_t{1} << 28;

// The number of vertices and indices that may still be added while a file is read.
struct GltfMeshBudget {
    uint64_t vertices = maxSceneVertices;
    uint64_t indices = maxSceneIndices;
};

// Subtracts from the budget. Fails with a message that names `element` if the budget is too small.
void takeGltfBudget(const GltfDocument& document, const std::string& element, uint64_t vertices,
                    uint64_t indices, GltfMeshBudget& budget);

// Reads the triangles of one primitive in a pose and fills in all vertex attributes. Missing
// normals become flat, so that triangles share no vertices; missing tangents follow the UVs of
// `material`'s normal map. Returns nothing, with a warning, for primitives without triangles.
std::optional<Mesh> readGltfPrimitive(const GltfDocument& document, size_t mesh, size_t primitive,
                                      const Material& material, const GltfPose& pose,
                                      GltfMeshBudget& budget);

// Returns the mesh with x negated and the winding reversed, so that front faces are
// counter-clockwise again. Drawn with M * diag(-1, 1, 1), it looks like the original drawn with a
// mirroring transform M.
Mesh mirroredMesh(const Mesh& mesh);

} // namespace candelabra::app
