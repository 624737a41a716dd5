// SPDX-License-Identifier: Apache-2.0
#include "scene/light_layers.h"

#include <algorithm>
#include <iterator>

namespace candelabra::app
{

bool isShown(const CndLight& light, const Camera& camera)
{
    return !light.layers || !camera.layers || light.layers & camera.layers;
}

std::vector<CndLight> lightsShown(const std::vector<CndLight>& lights, const Camera& camera)
{
    std::vector<CndLight> shown;
    std::ranges::copy_if(lights, std::back_inserter(shown),
                         [&](const CndLight& light) { return isShown(light, camera); });
    return shown;
}

} // namespace candelabra::app
