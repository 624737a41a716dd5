// SPDX-License-Identifier: Apache-2.0
// What hosts say about occluders. These structs have the members and the documentation that the
// structs of the C ABI will have.
#pragma once

#include <cstdint>

#include "candelabra/candelabra.h"

namespace candelabra::lighting
{

// Identifies a mesh, or an instance of one, until it is removed. Ids are at least 2^32 and are
// never reused. The id of something that has been removed is refused.
using OccluderMeshId = uint64_t;
using OccluderId = uint64_t;

// A mesh that casts shadows, in the host's memory. It is copied before the call returns. Its
// triangles are two-sided and need not be connected or closed. Triangles without an area are
// allowed and cast no shadow. A mesh takes about 70 bytes of device memory per triangle, and
// as much plus 12 bytes of host memory. What an upload reads, as large as what has changed, stays
// until a later change.
struct OccluderMesh {
    // The first of vertexCount positions, three floats each, in metres in the mesh's own space.
    // Each coordinate is within 1e15. All positions are checked, also those that no triangle uses.
    const float* positions;
    uint32_t stride; // bytes from one position to the next, a multiple of 4, at least 12; 0: 12
    uint32_t vertexCount; // > 0
    // 3 * triangleCount indices below vertexCount; NULL: the vertices in order, vertexCount is then
    // 3 * triangleCount.
    const uint32_t* indices;
    // 1..2^28. The triangles of all meshes must fit into a buffer of maxStorageBufferRange bytes,
    // 36 bytes each, and so must the nodes of their trees, 32 bytes each (about one per triangle).
    // Otherwise the call fails with CND_ERROR_UNSUPPORTED.
    uint32_t triangleCount;
};

// Occluders are in one of so many occluder layers. Lights name the layers that do not shadow them.
inline constexpr uint32_t occluderLayerCount = 6;

// One placement of a mesh. Moving objects are updated.
struct OccluderInstance {
    OccluderMeshId mesh;
    // Three rows of four: the transform of a point of the mesh to the world, in metres. Translation
    // and lengths of the columns are within 1e15, and the lengths are at least 1e-15. The transform
    // may mirror, stretch and shear. It must be invertible: the determinant of the columns, each
    // divided by its length, is beyond 1e-4 or -1e-4 (it is 1 for axes at right angles, however
    // long they are, and 1e-4 if one of them is 0.006 degrees from the plane of the others).
    double worldFromMesh[12];
    // Metres, >= 0 and finite: how far the drawn surface may lie from this mesh (levels of detail,
    // coarse balls). A surface within this distance of a triangle's plane is not shadowed by the
    // triangle.
    float surfaceError;
    uint32_t occluderLayer; // below CND_OCCLUDER_LAYER_COUNT, which is 6
    // Mask of 1 << layer, layer < CND_LAYER_COUNT; 0: all layers. The instance casts shadows in
    // frames that share a layer with it (CndLightingFrame::layers).
    uint32_t layers;
};

} // namespace candelabra::lighting
