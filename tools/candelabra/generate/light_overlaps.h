// SPDX-License-Identifier: Apache-2.0
// Finds how far lights must reach so that a wanted number of them lights the average visible point.
#pragma once

#include <vector>

#include <glm/glm.hpp>

#include "scene/scene.h"

namespace candelabra::app
{

// A point on a surface and the side it is seen from.
struct SurfaceSample {
    glm::dvec3 position{0};
    glm::dvec3 normal{0, 1, 0};
};

// The points that the scene's default camera sees at 16:9 (or its own aspect), on a fixed grid of
// pixels that hit a surface; when these are few, points spread evenly over all instances. May be
// empty.
std::vector<SurfaceSample> visibleSamples(const Scene& scene);

// The largest part of a light's influence radius that its radius may take: small lights with a
// short reach shrink, so that the emitter always stays well inside its influence.
constexpr double maxRadiusShare = 0.25;

// A light before its reach is known. With a scale s, its influence radius is s * reach and its
// radius min(radius, radiusShare * s * reach).
struct LightReach {
    glm::dvec3 position{0};              // as the samples
    double reach = 1;                    // > 0
    double radius = 0;                   // > 0
    double radiusShare = maxRadiusShare; // > 0, at most maxRadiusShare
};

// The scale at which a mean of `overlaps` lights contributes to a sample: nearer than the influence
// radius, and not wholly below the sample's horizon. This is what
// CndLightingStats::contributingPairs counts per pixel. When no scale reaches that many, `scale` is
// 0 and `reachable` the mean at an unlimited scale.
struct OverlapScale {
    double scale = 0;
    double reachable = 0;
};
OverlapScale scaleForOverlaps(const std::vector<SurfaceSample>& samples,
                              const std::vector<LightReach>& lights, double overlaps);

} // namespace candelabra::app
