// SPDX-License-Identifier: Apache-2.0
// A measure of the difference of two images that also judges their dark parts.
#pragma once

#include <algorithm>
#include <cmath>
#include <vector>

#include <glm/glm.hpp>

namespace candelabra::test
{

// Returns the largest difference of a pixel, relative to its brightest channel or to 1e-5 of the
// image's brightest value, whichever is larger.
inline double maxPixelDifference(const std::vector<glm::vec4>& a, const std::vector<glm::vec4>& b)
{
    const auto brightest = [](const glm::vec4& v) { return double(std::max({v.x, v.y, v.z})); };
    double peak = 0, largest = 0;
    for (const glm::vec4& pixel : b)
        peak = std::max(peak, brightest(pixel));
    for (size_t i = 0; i < a.size(); ++i)
        for (int c = 0; c < 3; ++c) {
            const double difference =
                std::abs(double(a[i][c]) - b[i][c]) / std::max(brightest(b[i]), 1e-5 * peak);
            largest = !(difference <= largest) ? difference : largest; // NaN counts as the largest
                                                                       // difference
        }
    return a.size() == b.size() && peak > 0 ? largest : INFINITY;
}

} // namespace candelabra::test
