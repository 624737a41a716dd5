// SPDX-License-Identifier: Apache-2.0
// Occluders: what casts shadows (CndLightingDesc::shadows).
#ifndef CANDELABRA_OCCLUDERS_H
#define CANDELABRA_OCCLUDERS_H

#include "candelabra/lighting.h"

#ifdef __cplusplus
extern "C" {
#endif

// Identifies a mesh, or an instance of one, until it is removed. Ids are at least 2^32 and are
// never reused. The id of something that has been removed is refused.
typedef uint64_t CndOccluderMeshId;
typedef uint64_t CndOccluderId;

// A mesh that casts shadows, in the host's memory. It is copied before the call returns. Its
// triangles are two-sided and need not be connected or closed. Triangles without an area are
// allowed and cast no shadow. A mesh takes about 80 bytes of device memory per triangle, and
// as much plus 24 bytes of host memory. If its positions are written on the device, such as those
// of skinned meshes, give those of a typical pose here (CndDevicePositions).
typedef struct CndOccluderMesh {
    // The first of vertexCount positions, three floats each, in metres in the mesh's own space.
    // Each coordinate is within 1e15. All positions are checked, also those that no triangle uses.
    const float* positions;
    uint32_t stride; // bytes from one position to the next, a multiple of 4, at least 12; 0: 12
    uint32_t vertexCount; // > 0
    // 3 * triangleCount indices below vertexCount; NULL: the vertices in order, vertexCount is then
    // 3 * triangleCount.
    const uint32_t* indices;
    // 1..2^28. The triangles of all meshes must fit into a buffer of maxStorageBufferRange bytes,
    // 36 bytes each. So must all nodes, 32 bytes each: about one per triangle and two per instance.
    // Otherwise the call fails with CND_ERROR_UNSUPPORTED.
    uint32_t triangleCount;
} CndOccluderMesh;

// Positions of a mesh that are written on the device, for example by a skinning kernel, and never
// visit the host. They stand for those of CndOccluderMesh: as many, in the same order and unit.
//
// The buffer is borrowed until the mesh gets other positions or is removed, and until the GPU has
// finished the recordings made before that. Those recordings may read it, and the first one after
// the call does. On entry to each of them the positions are visible to COMPUTE_SHADER /
// SHADER_STORAGE_READ, and they must not change until the GPU has finished it: an execution barrier
// from COMPUTE_SHADER comes before the next pose is written.
//
// The host cannot check these positions. A coordinate that is not finite, or not within 1e15,
// counts as 0.
typedef struct CndDevicePositions {
    CndOccluderMeshId mesh;
    VkBuffer buffer;     // usage STORAGE_BUFFER
    VkDeviceSize offset; // bytes, a multiple of 4: of the first position, which is three floats
    uint32_t stride;     // bytes from one position to the next, a multiple of 4, at least 12; 0: 12
} CndDevicePositions;

// One placement of a mesh. Moving objects are updated.
typedef struct CndOccluderInstance {
    CndOccluderMeshId mesh;
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
} CndOccluderInstance;

// The functions below edit the occluders of a module, which all its views share. They need
// CndLightingDesc::shadows and otherwise fail with CND_ERROR_INVALID_ARGUMENT. All that they are
// given is read before they return. Edits take effect at the next recording, which uploads what has
// changed. So frames in flight keep the shadows that they were recorded with. On error nothing has
// changed, and no id has been written. CND_ERROR_INVALID_ARGUMENT names the element and the member
// that is out of range. CND_ERROR_UNSUPPORTED: there would be more occluders than the device can
// take. Memory is allocated if the occluders grow beyond CndShadowDesc, and for staging buffers, as
// by cndSetLights. With a count of 0 a call does nothing.

// Adds `count` meshes and writes their ids to `ids` (`count` elements). Builds a tree over the
// triangles of each, on the calling thread. A mesh casts shadows where it has an instance.
CND_API CndResult cndAddOccluderMeshes(CndLighting lighting, uint32_t count,
                                       const CndOccluderMesh* meshes, CndOccluderMeshId* ids,
                                       CndError* error);
// Replaces the positions of a mesh: as many as its vertexCount, laid out as CndOccluderMesh says.
// Its indices and the shape of its tree stay, so this takes far less time than a new mesh. But
// shadows take longer to find if the triangles have moved far from where the tree was built for
// them. All instances of the mesh change.
CND_API CndResult cndReplaceOccluderPositions(CndLighting lighting, CndOccluderMeshId mesh,
                                              const float* positions, uint32_t stride,
                                              CndError* error);
// Gives meshes positions that are written on the device. No mesh may occur twice. The next
// recording writes their triangles and fits the boxes around them, and around all instances, on the
// device. For positions that were written later, call it again, with the same values or others;
// once as many frames have been in flight as ever will be, that allocates no device memory.
// cndReplaceOccluderPositions takes a mesh back to positions of the host. CND_ERROR_UNSUPPORTED:
// the positions of a mesh take more than maxStorageBufferRange.
//
// Such a mesh proves that lights are hidden (CndLightingStats::wonProofs) only across edges whose
// two triangles have the same indices there: vertices that merely are in one place may part. Its
// memory grows by 17 bytes per triangle, on the device and on the host. The first call makes three
// pipelines.
CND_API CndResult cndReplaceOccluderPositionsOnDevice(CndLighting lighting, uint32_t count,
                                                      const CndDevicePositions* positions,
                                                      CndError* error);
// Removes the meshes with these ids. No id may occur twice, and no instance may use one of them.
CND_API CndResult cndRemoveOccluderMeshes(CndLighting lighting, uint32_t count,
                                          const CndOccluderMeshId* ids, CndError* error);
// Adds `count` instances and writes their ids to `ids` (`count` elements). The next recording
// builds the tree over all instances anew, on its thread.
CND_API CndResult cndAddOccluders(CndLighting lighting, uint32_t count,
                                  const CndOccluderInstance* instances, CndOccluderId* ids,
                                  CndError* error);
// Replaces the instances with these ids, for example of objects that have moved. Everything may
// change, even the mesh. No id may occur twice. The tree over all instances is fitted, and built
// anew only when that has made its boxes much larger.
CND_API CndResult cndUpdateOccluders(CndLighting lighting, uint32_t count, const CndOccluderId* ids,
                                     const CndOccluderInstance* instances, CndError* error);
// Removes the instances with these ids. No id may occur twice.
CND_API CndResult cndRemoveOccluders(CndLighting lighting, uint32_t count, const CndOccluderId* ids,
                                     CndError* error);

#ifdef __cplusplus
}
#endif

#endif
