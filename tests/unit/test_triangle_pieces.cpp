// SPDX-License-Identifier: Apache-2.0
// Tests the plan of cull_triangles: which batches are tested, and where their pieces are.
#include <gtest/gtest.h>

#include "gbuffer/batches.h"
#include "gbuffer/triangle_pieces.h"

namespace candelabra::test
{
namespace
{

using gbuffer::PackedLevel;
using gbuffer::PackedMesh;
using gbuffer::TrianglePieces;

// A mesh that begins at an index, with as many triangles in each level.
PackedMesh meshOf(uint32_t firstIndex, const std::vector<uint32_t>& triangles)
{
    PackedMesh mesh;
    for (const uint32_t count : triangles) {
        mesh.levels.push_back({firstIndex, 3 * count, 0});
        firstIndex += 3 * count;
    }
    mesh.min[0] = -3;
    mesh.max[0] = 1;
    mesh.max[1] = 2;
    return mesh;
}

} // namespace

TEST(TrianglePieces, FollowEachOther)
{
    constexpr uint32_t n = gpu::PIECE_TRIANGLES;
    const PackedMesh one = meshOf(0, {n, 50}), two = meshOf(3 * (n + 50), {n + 1});
    TrianglePieces pieces;
    EXPECT_EQ(pieces.add(one, 4, 10, {.firstCommand = 7}), 10u);
    EXPECT_EQ(pieces.add(two, 5, 3, {.firstCommand = 9}), 6u); // one triangle too many for one
    EXPECT_EQ(pieces.add(one, 4, 2, {.firstCommand = 11}), 2u);
    ASSERT_EQ(pieces.batches().size(), 3u);
    const gpu::PieceBatch &a = pieces.batches()[0], &b = pieces.batches()[1],
                          &c = pieces.batches()[2];
    EXPECT_EQ(a.firstPiece, 0u);
    EXPECT_EQ(b.firstPiece, 10u);
    EXPECT_EQ(c.firstPiece, 16u);
    EXPECT_EQ(a.levelCount, 2u);
    EXPECT_EQ(b.firstCommand, 9u);
    EXPECT_EQ(b.firstKept, 10 * 3 * n);
    EXPECT_EQ(c.firstKept, 10 * 3 * n + 3 * 3 * (n + 1));
    EXPECT_EQ(b.firstCorner, 3 * (n + 50)); // after both levels of the first mesh
    EXPECT_EQ(b.firstIndex, 3 * (n + 50));
    EXPECT_EQ(c.firstCorner, 0u); // the corners of a mesh are there once
    EXPECT_EQ(a.reach, 5.f);
    EXPECT_EQ(pieces.keptCount(), 12 * 3 * n + 3 * 3 * (n + 1));
    EXPECT_EQ(pieces.batchOfPiece()[15], 1u);
    EXPECT_EQ(pieces.batchOfPiece()[16], 2u);
}

TEST(TrianglePieces, LeaveSmallMeshesAlone)
{
    TrianglePieces pieces;
    EXPECT_EQ(pieces.add(meshOf(0, {gbuffer::minTestedTriangles - 1}), 0, 5, {}), 0u);
    EXPECT_EQ(pieces.add(meshOf(0, {gbuffer::minTestedTriangles}), 0, 5, {}), 5u);
}

TEST(TrianglePieces, LeaveBatchesAloneForWhichThereIsNoRoom)
{
    TrianglePieces pieces;
    const PackedMesh small = meshOf(0, {gbuffer::minTestedTriangles}),
                     large = meshOf(100, {gbuffer::maxKeptIndices / 3});
    EXPECT_EQ(pieces.add(small, 0, gbuffer::maxPieces + 1, {}), 0u);
    EXPECT_EQ(pieces.add(large, 1, 2, {}), 0u);
    EXPECT_GT(pieces.add(large, 1, 1, {}), 0u);
    EXPECT_EQ(pieces.add(small, 0, 1, {}), 0u); // less than a triangle has room now
    EXPECT_EQ(pieces.batches().size(), 1u);
    EXPECT_LE(pieces.keptCount(), gbuffer::maxKeptIndices);

    TrianglePieces fewCorners(3 * (gbuffer::minTestedTriangles + 5)), none(0);
    EXPECT_EQ(fewCorners.add(small, 0, 7, {}), 7u);
    EXPECT_EQ(fewCorners.add(small, 1, 7, {}), 0u); // another mesh has corners of its own
    EXPECT_EQ(fewCorners.add(small, 0, 7, {}), 7u);
    EXPECT_EQ(none.add(small, 0, 7, {}), 0u);
}

// However few draws a run may have, the runs that are tested have all pieces, in order.
TEST(TrianglePieces, AreDividedAmongTheRuns)
{
    const std::vector<PackedMesh> meshes{meshOf(0, {100, 50, 25}), meshOf(525, {10}),
                                         meshOf(555, {40, 20})};
    const std::vector<gbuffer::Material> materials(1);
    std::vector<gbuffer::Instance> instances;
    for (uint32_t i = 0; i < 9; ++i) {
        gbuffer::Instance instance{.mesh = i % 3, .worldFromObject = {}};
        for (int k = 0; k < 4; ++k)
            instance.worldFromObject[5 * k] = 1;
        instances.push_back(instance);
    }
    const gbuffer::GeometryDesc desc{.materials = materials, .instances = instances};
    for (const uint32_t maxDraws : {1u, 2u, 3u, 100u}) {
        SCOPED_TRACE(maxDraws);
        const gbuffer::Batches b =
            gbuffer::buildBatches(desc, meshes, maxDraws, gbuffer::maxCorners);
        uint32_t pieces = 0, commands = 0;
        for (const gbuffer::Run& run : b.runs) {
            EXPECT_LE(run.commandCount, maxDraws);
            EXPECT_EQ(run.firstCommand, commands);
            commands += run.commandCount;
            for (uint32_t c = run.firstCommand; c < commands; ++c)
                EXPECT_EQ(run.tested, b.commands[c].firstIndex != 525); // the small mesh
            if (run.pieceCount) {
                EXPECT_EQ(run.firstPiece, pieces);
            }
            pieces += run.pieceCount;
        }
        EXPECT_EQ(commands, 6u);
        EXPECT_EQ(pieces, 6u); // one for each instance that is tested
        EXPECT_EQ(b.pieces.batchOfPiece().size(), 6u);
    }
}

TEST(TrianglePieces, KnowTheCornersOfTheirMeshes)
{
    gbuffer::PackedMeshes all;
    for (uint32_t i = 0; i < 200; ++i)
        all.core.push_back({{float(i), 2, 0}, {}});
    for (uint32_t i = 0; i < 3 + 72; ++i)
        all.indices.push_back(99 - i);
    all.meshes = {meshOf(0, {1}), meshOf(3, {20, 4})};
    all.meshes[1].vertexOffset = 10;
    TrianglePieces pieces;
    ASSERT_GT(pieces.add(all.meshes[1], 1, 1, {}), 0u);
    const std::vector<gpu::TriangleCorner> corners = pieces.corners(all);
    ASSERT_EQ(corners.size(), 72u);
    EXPECT_EQ(corners[20].vertex, 99 - 23);
    EXPECT_EQ(corners[20].position, glm::vec3(99 - 23 + 10, 2, 0));
}

} // namespace candelabra::test
