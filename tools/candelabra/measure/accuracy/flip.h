// SPDX-License-Identifier: Apache-2.0
// FLIP: the difference that a viewer sees when alternating between two displayed images.
#pragma once

#include <cstdint>
#include <vector>

#include <glm/glm.hpp>

namespace candelabra::app
{

// sRGB-encoded values in [0, 1], rows from the top.
struct DisplayImage {
    uint32_t width = 0, height = 0;
    std::vector<glm::vec3> pixels;
};

// Andersson, Nilsson, Akenine-Moller, Oskarsson, Astrom and Fairchild 2020, "FLIP: A Difference
// Evaluator for Alternating Images", for low dynamic range. Per pixel 0 (equal) to 1; both images
// have the same size. `pixelsPerDegree`: of the viewer's field of view; theirs is a screen of 3840
// pixels and 0.7 m seen from 0.7 m.
std::vector<float> flipMap(const DisplayImage& reference, const DisplayImage& test,
                           double pixelsPerDegree = 67.0206);

double meanOf(const std::vector<float>& map);

} // namespace candelabra::app
