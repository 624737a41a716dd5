// SPDX-License-Identifier: Apache-2.0
// Plans what cull_triangles works on: which batches, and in which pieces.
#pragma once

#include <cstdint>
#include <map>
#include <vector>

#include "gbuffer/meshes.h"
#include "shared/raster.h"

namespace candelabra::gbuffer
{

// Meshes of fewer triangles are drawn untested: testing the boxes of the fence saves nothing.
constexpr uint32_t minTestedTriangles = 20;
// Room for the indices of triangles that remain, and for pieces. Batches beyond it are drawn
// untested.
constexpr uint32_t maxKeptIndices = 1u << 22, maxPieces = 1u << 17;

class TrianglePieces
{
public:
    // Plans the batch of `count` instances of a mesh whose first command is `batch.firstCommand`.
    // Of `batch`, firstCommand, scale and front are read. Returns its number of pieces; 0: the mesh
    // is too small or there is no room, and the batch is drawn untested.
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
    uint32_t cornerCount_ = 0;
};

} // namespace candelabra::gbuffer
