// SPDX-License-Identifier: Apache-2.0
// FLIP: the difference that a viewer sees when alternating between two displayed images. Debian has
// no package of it.
#pragma once

#include <vector>

#include "io/image.h"

namespace candelabra::app
{

// FLIP for low dynamic range (Andersson, Nilsson, Akenine-Moller, Oskarsson, Astrom and Fairchild
// 2020, "FLIP: A Difference Evaluator for Alternating Images"). Returns a value of 0 (equal) to 1
// per pixel. Both images have the same size. `pixelsPerDegree` is the resolution in the viewer's
// field of view; the default is that of the paper, a screen 0.7 m wide with 3840 pixels across,
// seen from 0.7 m.
std::vector<float> flipMap(const DisplayImage& reference, const DisplayImage& test,
                           double pixelsPerDegree = 67.0206);

double meanOf(const std::vector<float>& map);

} // namespace candelabra::app
