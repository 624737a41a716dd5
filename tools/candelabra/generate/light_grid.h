// SPDX-License-Identifier: Apache-2.0
// Finds the points of a set that are near a given point.
#pragma once

#include <cstdint>
#include <vector>

#include <glm/glm.hpp>

namespace candelabra::app
{

class LightGrid
{
public:
    explicit LightGrid(const std::vector<glm::dvec3>& positions);

    // Calls visit(index) for every position within `radius` of `centre`, and for some farther away.
    template <typename Visit>
    void visit(const glm::dvec3& centre, double radius, Visit&& visitor) const
    {
        const glm::ivec3 low = cellOf(centre - radius), high = cellOf(centre + radius);
        for (int z = low.z; z <= high.z; ++z) {
            for (int y = low.y; y <= high.y; ++y) {
                // Cells that are neighbours in x are neighbours in memory.
                const size_t row = (size_t(z) * size_.y + y) * size_.x;
                for (uint32_t i = starts_[row + low.x]; i < starts_[row + high.x + 1]; ++i)
                    visitor(order_[i]);
            }
        }
    }

private:
    glm::ivec3 cellOf(const glm::dvec3& position) const
    {
        return glm::ivec3(
            glm::clamp(glm::floor((position - origin_) / cell_), glm::dvec3(0), maxCell_));
    }

    glm::dvec3 origin_{0};
    double cell_ = 1;
    glm::ivec3 size_{1};
    glm::dvec3 maxCell_{0};        // size_ - 1
    std::vector<uint32_t> starts_; // the first index of each cell, and the end of the last
    std::vector<uint32_t> order_;
};

} // namespace candelabra::app
