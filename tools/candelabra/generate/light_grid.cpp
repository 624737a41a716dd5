// SPDX-License-Identifier: Apache-2.0
#include "generate/light_grid.h"

namespace candelabra::app
{

LightGrid::LightGrid(const std::vector<glm::dvec3>& positions)
{
    starts_.assign(2, 0);
    if (positions.empty())
        return;
    glm::dvec3 low = positions.front(), high = low;
    for (const glm::dvec3& position : positions) {
        low = glm::min(low, position);
        high = glm::max(high, position);
    }
    // Flat sets of points get a thickness, so that the volume of cells is not 0 and their number is
    // bounded.
    const glm::dvec3 size = high - low;
    const double longest = std::max({size.x, size.y, size.z, 1e-3});
    const glm::dvec3 extent = glm::max(size, glm::dvec3(longest / 256));
    // There are about two lights per cell.
    cell_ = std::cbrt(2 * extent.x * extent.y * extent.z / double(positions.size()));
    cell_ = std::max(cell_, longest / 1024);
    origin_ = low;
    size_ = glm::ivec3(glm::floor(size / cell_)) + 1;
    maxCell_ = glm::dvec3(size_ - 1);

    const auto flat = [this](const glm::dvec3& position) {
        const glm::ivec3 c = cellOf(position);
        return (size_t(c.z) * size_.y + c.y) * size_.x + c.x;
    };
    starts_.assign(size_t(size_.x) * size_.y * size_.z + 1, 0);
    for (const glm::dvec3& position : positions)
        ++starts_[flat(position) + 1];
    for (size_t i = 1; i < starts_.size(); ++i)
        starts_[i] += starts_[i - 1];
    std::vector<uint32_t> next(starts_.begin(), starts_.end() - 1);
    order_.resize(positions.size());
    for (uint32_t i = 0; i < positions.size(); ++i)
        order_[next[flat(positions[i])]++] = i;
}

} // namespace candelabra::app
