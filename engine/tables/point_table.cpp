// SPDX-License-Identifier: Apache-2.0
#include "tables/point_table.h"

#include <bit>

#include "shared/visibility_points.h"

namespace candelabra::tables
{
namespace
{

glm::uvec2 entry(const glm::vec2& point)
{
    return {std::bit_cast<uint32_t>(point.x), std::bit_cast<uint32_t>(point.y)};
}
glm::uvec2 entry(const glm::uvec2& mask)
{
    return mask;
}
glm::uvec2 entry(uint32_t mask)
{
    return {mask, 0};
}

template <typename T, size_t size>
void append(std::vector<glm::uvec2>& out, const T (&elements)[size])
{
    for (const T& element : elements)
        out.push_back(entry(element));
}

} // namespace

std::vector<glm::uvec2> pointTable(uint32_t count)
{
    std::vector<glm::uvec2> out;
    if (count == 64) {
        append(out, gpu::POINTS_64);
        append(out, gpu::POINTS_BELOW_64);
        append(out, gpu::STADIUM_64);
    } else {
        append(out, gpu::POINTS_32);
        append(out, gpu::POINTS_BELOW_32);
        append(out, gpu::STADIUM_32);
    }
    return out;
}

} // namespace candelabra::tables
