// SPDX-License-Identifier: Apache-2.0
// What a user can ask of a scene besides its name.
#pragma once

#include <cstdint>
#include <optional>
#include <string>

#include "candelabra/candelabra.h"

namespace candelabra::app
{

struct SceneOptions {
    std::optional<uint32_t> lights; // hall/field/fence: number of sphere lights (default 4000);
                                    // files: extra random sphere lights inside the bounds
    uint32_t seed = 1;
    std::optional<double> overlaps; // mean lights that contribute to a pixel that shows a surface:
                                    // inside their influence, not wholly below its horizon
                                    // (default 8, with few lights half of what is possible)
    bool moving = false;            // lights get a LightMotion
    std::optional<double> punctualRadius; // metres: point lights without a radius become spheres
    std::optional<double> sunRadius;      // sine of an angular radius: directional lights become
                                          // distant spheres
    std::string environment;              // .hdr, .exr or .pfm file; empty: none
    double environmentRotation = 0;       // radians
    double environmentScale = 1;
    std::optional<CndLobeJoining> lobes; // default: sum for .json, else conserving
    bool energyCompensation = false;
};

} // namespace candelabra::app
