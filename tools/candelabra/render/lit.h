// SPDX-License-Identifier: Apache-2.0
#pragma once

#include "candelabra/candelabra.h"
#include "render/accumulation.h"
#include "scene/scene.h"

namespace candelabra::app
{

// Everything that decides the lit image of one scene at one size: two frames with equal values have
// the same image.
struct Lit {
    Camera camera;
    FrameSample sample;
    double lightTime;
    bool lightsVisible;
    bool levels;
    CndSpecularMethod specular;
    uint32_t sampleCount, sampleSeed;
    CndCulling culling;
    CndInfluenceRule influence;
    float influenceError, influenceExposure; // of CND_INFLUENCE_BY_ERROR
    CndToneMap influenceToneMap;

    bool operator==(const Lit&) const = default;
    bool sameSurfaces(const Lit& other) const
    {
        return camera == other.camera && sample == other.sample &&
               lightsVisible == other.lightsVisible && levels == other.levels;
    }
};

} // namespace candelabra::app
