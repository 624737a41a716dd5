// SPDX-License-Identifier: Apache-2.0
// The options of a scene that a user can set.
#pragma once

#include <cstdint>
#include <optional>
#include <string>

#include "candelabra/candelabra.h"

namespace candelabra::app
{

// Largest number of lights that can be asked for: 2^24. A float counts no further, and lists and
// buffers of lights stop fitting into common devices.
constexpr uint32_t maxLights = 1u << 24;

struct SceneOptions {
    // For hall, field, fence and rooms the number of sphere lights (default 4000). For files the
    // number of random sphere lights that are added inside the scene's bounds.
    std::optional<uint32_t> lights;
    uint32_t seed = 1; // of everything random in the scene
    // The mean number of lights that contribute to a pixel with a surface: the pixel lies within
    // their influence, and they are not wholly below its horizon. Default: 8, or half of what is
    // possible if there are few lights.
    std::optional<double> overlaps;
    bool moving = false; // lights get a LightMotion
    // Point lights without a radius become spheres of this radius, in metres.
    std::optional<double> punctualRadius;
    // Directional lights become distant spheres whose angular radius has this sine.
    std::optional<double> sunRadius;
    // Flat rectangles with an emissive material become area lights.
    bool emissiveLights = false;
    std::string environment;        // an .hdr, .exr or .pfm file; empty: no environment
    double environmentRotation = 0; // as SceneEnvironment::rotation
    double environmentScale = 1;    // as SceneEnvironment::scale
    // lx on level ground, which the environment is scaled to; used instead of environmentScale
    std::optional<double> environmentIlluminance;
    // Default: sum for scene descriptions (.json) without a source, else conserving.
    std::optional<CndLobeJoining> lobes;
    // Default: on for glTF files and for scene descriptions whose source is one, else off.
    std::optional<bool> energyCompensation;
    bool defaultLight = false; // a scene without any light gets the environment of load/studio.h
    double imageAspect = 16.0 / 9; // width / height of pictures, for automatic cameras
};

} // namespace candelabra::app
