// SPDX-License-Identifier: Apache-2.0
#pragma once

#include "candelabra/candelabra.h"
#include "scene/scene.h"

namespace candelabra::app
{

// All that shapes the lit image of one scene at one size.
struct Lit {
    Camera camera;
    double lightTime;
    bool lightsVisible;
    CndSpecularMethod specular;
    uint32_t sampleCount, sampleSeed;
    float errorBudget;
    CndCulling culling;
    CndInfluenceRule influence;
    float influenceError, influenceExposure; // BY_ERROR
    CndToneMap influenceToneMap;

    bool operator==(const Lit&) const = default;
    bool sameSurfaces(const Lit& other) const
    {
        return camera == other.camera && lightsVisible == other.lightsVisible;
    }
};

} // namespace candelabra::app
