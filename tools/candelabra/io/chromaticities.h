// SPDX-License-Identifier: Apache-2.0
// Primaries of images. What the program draws has those of Rec. 709 and the white D65.
#pragma once

#include "io/image.h"

namespace candelabra::app
{

// CIE xy coordinates. The values are those of Rec. 709.
struct Chromaticities {
    glm::dvec2 red{0.64, 0.33}, green{0.30, 0.60}, blue{0.15, 0.06}, white{0.3127, 0.3290};
};

// Converts a colour image with these primaries to Rec. 709. White stays white (Bradford's
// adaptation), except that XYZ values, which have no white of their own, are the colours that they
// name. Returns false, and leaves the image as it is, if the chromaticities span no colours.
// Grey images stay as they are.
bool convertToRec709(Image& image, const Chromaticities& from);

} // namespace candelabra::app
