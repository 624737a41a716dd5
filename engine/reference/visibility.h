// SPDX-License-Identifier: Apache-2.0
// The light of a surface point that nothing stops.
#pragma once

#include <cstdint>
#include <span>

#include <glm/glm.hpp>

#include "candelabra/candelabra.h"
#include "reference/occluders.h"
#include "reference/surface.h"

namespace candelabra::reference
{

// Stratified points of an emitter at first and at most. They are doubled until no channel of the
// pixel changes by more than this share of its brightest one.
inline constexpr uint32_t firstShadowPoints = 4096, mostShadowPoints = 65536;
inline constexpr double shadowTolerance = 1e-3;

struct LightsOfPixel {
    std::span<const CndLight> lights;
    std::span<const uint32_t> ignoredLayers; // as Scene::ignoredLayers
    glm::dvec3 lightOrigin{0};
    const Occluders* occluders = nullptr; // null: nothing stops light
    double relative = 1e-4;               // tolerance of what a light adds without occluders
    uint64_t seed = 0;                    // of the points; every pixel should have another one
};

// Adds to `pixel` the luminance that the lights send from the surface to the eye. Returns how many
// of them missed a tolerance. A light that occluders hide in part adds its truth (truth.h), each
// term multiplied by a quotient of two sums over the same points of the true emitter: the term's
// integrand at the visible points, and at all. A light without a hidden point adds its truth,
// unchanged, one without a visible point adds nothing. Where the specular lobe is narrower than the
// emitter, points would miss it; so as many points again are those seen along random directions of
// the lobe (Heitz 2018), and the balance heuristic (Veach 1997) weights both kinds.
uint64_t addLights(const LightsOfPixel& lights, const SurfacePoint& surface,
                   const Material& material, glm::dvec3& pixel);

} // namespace candelabra::reference
