// SPDX-License-Identifier: Apache-2.0
// Plans what cull_triangles works on: which batches, and in which pieces.
#pragma once

#include <algorithm>
#include <cstdint>
#include <map>
#include <vector>

#include "gbuffer/meshes.h"
#include "gpu/device.h"
#include "shared/raster.h"

namespace candelabra::gbuffer
{

// Tells whether triangles and emitters that cover no sample are left out before they are
// rasterised. That pays off only on llvmpipe, which sets up triangles in one thread of the CPU.
inline bool cullsTriangles(const gpu::Device& device)
{
    return device.lanesAreCpuVector;
}

// Meshes of fewer triangles are drawn untested: the scene `fence`, which consists of boxes of 12
// triangles, is drawn no faster if they are tested.
constexpr uint32_t minTestedTriangles = 20;
// Room for the indices of triangles that remain, for the corners of meshes and for pieces. A batch
// for which there is no room is drawn untested as a whole.
constexpr uint32_t maxKeptIndices = 1u << 22, maxCorners = 1u << 23, maxPieces = 1u << 17;
// A mesh that is tested has no more vertices than indices, so TriangleCorner::vertex is exact.
static_assert(maxKeptIndices <= 1u << 24);

class TrianglePieces
{
public:
    // `most` limits the room for corners further; with 0 nothing is tested.
    explicit TrianglePieces(uint32_t most = maxCorners) : most_(std::min(most, maxCorners)) {}

    // Plans the batch of `count` instances of a mesh whose first command is `batch.firstCommand`.
    // Of `batch`, firstCommand, scale and front are read; the largest scale of an instance limits
    // how well the triangles of all are tested. Returns its number of pieces; 0: the mesh is too
    // small or there is no room, and the batch is drawn untested.
    uint32_t add(const PackedMesh& mesh, uint32_t meshIndex, uint32_t count, gpu::PieceBatch batch);
    // Returns the corners of all meshes that were added, in the order of PieceBatch::firstCorner.
    std::vector<gpu::TriangleCorner> corners(const PackedMeshes& meshes) const;

    const std::vector<gpu::PieceBatch>& batches() const { return batches_; }
    const std::vector<uint32_t>& batchOfPiece() const { return batchOfPiece_; }
    uint32_t keptCount() const { return keptCount_; } // room for indices

private:
    std::vector<gpu::PieceBatch> batches_;
    std::vector<uint32_t> batchOfPiece_;
    uint32_t keptCount_ = 0;
    std::vector<uint32_t> meshes_;              // that have corners, in order
    std::map<uint32_t, uint32_t> firstCorners_; // by mesh
    uint32_t most_;                             // corners
    uint32_t cornerCount_ = 0;
};

} // namespace candelabra::gbuffer
