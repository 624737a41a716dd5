// SPDX-License-Identifier: Apache-2.0
// Which triangles of an occluder mesh share their edges (gpu::OccluderNeighbours).
#pragma once

#include <span>
#include <vector>

#include "shared/occluder_data.h"

namespace candelabra::lighting
{

using Neighbours = std::vector<gpu::OccluderNeighbours>;

// Returns the neighbours of all triangles of a mesh. Two triangles are neighbours at an edge if its
// ends have equal bits in both of them, and no third triangle has the same edge.
Neighbours findNeighbours(std::span<const gpu::OccluderTriangle> triangles);

// Copies `neighbours` without those that do not share an edge any more, after the triangles have
// got new positions.
void copyNeighboursThatMeet(std::span<const gpu::OccluderTriangle> triangles,
                            std::span<const gpu::OccluderNeighbours> neighbours,
                            std::span<gpu::OccluderNeighbours> out) noexcept;

// Copies those of `neighbours` that share an edge whatever the positions are: its ends are the same
// vertices in both triangles. `corners`: the vertices of each triangle.
void copyNeighboursOfVertices(std::span<const glm::uvec3> corners,
                              std::span<const gpu::OccluderNeighbours> neighbours,
                              std::span<gpu::OccluderNeighbours> out) noexcept;

} // namespace candelabra::lighting
