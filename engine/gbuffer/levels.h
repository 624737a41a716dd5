// SPDX-License-Identifier: Apache-2.0
// Coarser levels of a mesh: triangles of the same vertices, fewer from level to level, with a
// measured error each.
#pragma once

#include <cstdint>
#include <span>
#include <vector>

#include "gbuffer/geometry.h"

namespace candelabra::gbuffer
{

struct Level {
    std::vector<uint32_t> indices;
    // The distance of the level from the mesh, in units of object space: no vertex of the mesh is
    // farther from the level, and no middle of an edge or of a triangle of the level is farther
    // from the mesh. A vertex attribute that is off by x at a vertex of the mesh counts as far as
    // levels.cpp says.
    float error;
};

// The vertex attributes that are drawn.
enum class Attributes { Normals, All };

// Makes the coarser levels of a mesh, finest first, with errors that do not fall; none for meshes
// that are small or cannot be simplified. Open edges stay as they are, so that meshes that meet at
// them do not come apart.
std::vector<Level> coarserLevels(std::span<const Vertex> vertices,
                                 std::span<const uint32_t> indices, Attributes attributes);

} // namespace candelabra::gbuffer
