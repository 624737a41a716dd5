// SPDX-License-Identifier: Apache-2.0
// Predicts what a change of lights would do to a frame: how many pairs of light and pixel would be
// evaluated, and how long shading and the frame would take.
#pragma once

#include <span>
#include <string>
#include <vector>

#include "io/report.h"
#include "measure/profile/profile_frames.h"
#include "scene/scene.h"

namespace candelabra::app
{

struct WhatIf {
    enum class Change { Influence, Radius, Off, Method };

    Change change = Change::Off;
    double factor = 1; // of the influence radius, or of every length of the emitter
    CndSpecularMethod method = CND_SPECULAR_CONIC;
    std::string text; // as the user gave it

    bool changesLights() const { return change != Change::Method; }
};

// Reads "influence=FACTOR", "radius=FACTOR", "off" or "method=NAME". Throws UsageError.
WhatIf parseWhatIf(const std::string& text);

struct ChangedScene {
    Scene scene;
    std::vector<uint32_t> changed; // indices of lights in the scene without the change
    std::vector<uint32_t> kept;    // lights that do not have what was to be changed
};

// Returns the scene with `lights` changed. Luminance and intensity stay. Throws UsageError if no
// light can be changed, or if a light would become one that the engine refuses, because its
// influence radius would not be greater than the bounding radius of its emitter.
ChangedScene changedScene(const Scene& scene, std::span<const uint32_t> lights,
                          const WhatIf& whatIf);

// What was counted in two variants of a frame: A without the change and B with it.
struct WhatIfPairs {
    size_t lights = 0; // of the scene without the change
    std::vector<uint32_t> changed, kept;
    uint64_t a = 0, b = 0; // LightCosts::pairs
};

// The answer in one sentence, preceded by one about lights that were kept. `profile` has the
// times of A and of B.
std::string whatIfText(const WhatIf& whatIf, const WhatIfPairs& pairs, const Profile& profile);
Json whatIfJson(const WhatIf& whatIf, const WhatIfPairs& pairs, const Profile& profile);

} // namespace candelabra::app
