// SPDX-License-Identifier: Apache-2.0
#include "scene/cone.h"

#include <algorithm>
#include <cmath>
#include <numbers>

namespace candelabra::app
{

bool setCone(double inner, double outer, CndLight& light)
{
    constexpr float edge = CND_MIN_CONE_EDGE;
    constexpr double roundedUp = 1.5708; // exporters may round pi/2 so
    const float widest = std::nextafter(float(std::numbers::pi / 2), 0.0f);
    light.outerConeAngle = std::clamp(float(outer), edge, widest);
    // A float below the difference, which may have been rounded up.
    const float largestInner = std::max(std::nextafter(light.outerConeAngle - edge, 0.0f), 0.0f);
    light.innerConeAngle = std::clamp(float(inner), 0.0f, largestInner);
    return outer >= double{edge} && outer <= roundedUp && inner >= 0 &&
           light.innerConeAngle == float(inner);
}

} // namespace candelabra::app
