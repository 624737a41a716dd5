// SPDX-License-Identifier: Apache-2.0
// The shaders' evaluation of lights, compiled as C++ in double precision
// (shaders/double_shaders.cmake): the formulas that ship, without the rounding of float32. It does
// not say whether the formulas are right: that is found by comparison with engine/reference, which
// includes none of this.
#pragma once

#include <cstdint>
#include <span>

#include <glm/vec3.hpp>

#include "candelabra/lighting.h"
#include "shared/conic_constants.h"
#include "shared/lighting_data.h"

namespace candelabra::formula
{

// The fitted constants of shared/conic_constants.h, with the values that the shaders have.
struct ConicConstants {
#define X(name, value, meaning) double name = value;
    CND_CONIC_FITTED(X)
#undef X
};

struct Settings {
    CndSpecularMethod method =
        CND_SPECULAR_CONIC;      // one that canonicalMethod() returns for the type
    uint32_t sampleCount = 1024; // CND_SPECULAR_SAMPLED
    ConicConstants constants;
};

struct Receiver {
    glm::dvec3 n; // unit
    glm::dvec3 v; // to the eye, any length but 0
    double perceptualRoughness = 0;
    glm::dvec3 position{0};
};

// A light of emission 1 that reaches everything, as kernels read it (shared/lighting_data.h).
struct Light {
    uint32_t type = CND_LIGHT_SPHERE;
    glm::dvec3 centre; // distant types: unit direction towards the light
    double boundingRadius = 0;
    gpu::LightShape shape{};                    // spheres need none
    std::span<const gpu::LightShape> corners{}; // of a polygon
    uint32_t index = 0;                         // from which CND_SPECULAR_SAMPLED has its samples
};

// The form factor, and the specular response with F = 1 (a) and with F = (1 - VoH)^5 (b), as in
// BenchResponse.
struct Response {
    double f = 0, a = 0, b = 0;
    uint32_t way = 0; // EVALUATE_*: the case that shading/classify_lights.glsl finds for the light
};

// Throws std::logic_error if the type of light or the method is unknown.
Response respond(const Settings& settings, const Receiver& receiver, const Light& light);

} // namespace candelabra::formula
