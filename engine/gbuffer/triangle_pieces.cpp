// SPDX-License-Identifier: Apache-2.0
#include "gbuffer/triangle_pieces.h"

#include <algorithm>
#include <cmath>

#include <glm/gtc/type_ptr.hpp>

#include "gpu/kernel.h"

namespace candelabra::gbuffer
{
namespace
{

// The levels of a mesh are consecutive ranges of the index buffer.
uint32_t indexCountOfAllLevels(const PackedMesh& mesh)
{
    return mesh.levels.back().firstIndex + mesh.levels.back().indexCount -
           mesh.levels.front().firstIndex;
}

} // namespace

uint32_t TrianglePieces::add(const PackedMesh& mesh, uint32_t meshIndex, uint32_t count,
                             gpu::PieceBatch batch)
{
    const uint32_t triangles = mesh.levels.front().indexCount / 3;
    const uint64_t pieces = uint64_t(count) * gpu::divideUp(triangles, gpu::PIECE_TRIANGLES);
    const uint64_t kept = uint64_t(count) * triangles * 3;
    const uint32_t corners = firstCorners_.contains(meshIndex) ? 0 : indexCountOfAllLevels(mesh);
    if (triangles < minTestedTriangles || pieces > maxPieces - batchOfPiece_.size() ||
        kept > maxKeptIndices - keptCount_ || corners > most_ - cornerCount_ || most_ == 0)
        return 0;
    const auto [corner, isNew] = firstCorners_.try_emplace(meshIndex, cornerCount_);
    if (isNew)
        meshes_.push_back(meshIndex);
    cornerCount_ += corners;
    batch.firstPiece = uint32_t(batchOfPiece_.size());
    batch.levelCount = uint32_t(mesh.levels.size());
    batch.firstKept = keptCount_;
    batch.firstCorner = corner->second;
    batch.firstIndex = mesh.levels.front().firstIndex;
    for (int i = 0; i < 3; ++i)
        batch.reach += std::max(std::abs(mesh.min[i]), std::abs(mesh.max[i]));
    batchOfPiece_.insert(batchOfPiece_.end(), size_t(pieces), uint32_t(batches_.size()));
    batches_.push_back(batch);
    keptCount_ += uint32_t(kept);
    return uint32_t(pieces);
}

std::vector<gpu::TriangleCorner> TrianglePieces::corners(const PackedMeshes& meshes) const
{
    std::vector<gpu::TriangleCorner> corners;
    corners.reserve(cornerCount_);
    for (const uint32_t index : meshes_) {
        const PackedMesh& mesh = meshes.meshes[index];
        const uint32_t first = mesh.levels.front().firstIndex;
        for (uint32_t i = 0; i < indexCountOfAllLevels(mesh); ++i) {
            const uint32_t vertex = meshes.indices[first + i];
            corners.push_back(
                {glm::make_vec3(meshes.core[mesh.vertexOffset + vertex].position), float(vertex)});
        }
    }
    return corners;
}

} // namespace candelabra::gbuffer
