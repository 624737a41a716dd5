// SPDX-License-Identifier: Apache-2.0
// GLM types in the structs of candelabra.h, for hosts that use GLM (0.9.9 or later). The one header
// of Candelabra that needs it; nothing else includes this.
#pragma once

#include <glm/mat3x3.hpp>
#include <glm/mat4x4.hpp>
#include <glm/vec3.hpp>

#include "candelabra/candelabra.h"

namespace candelabra
{

// Into and out of three numbers: positions, axes and emission of lights, origins of light sets.
template <typename T, glm::qualifier Q>
void assign(T (&to)[3], const glm::vec<3, T, Q>& from) noexcept
{
    for (glm::length_t i = 0; i < 3; ++i)
        to[i] = from[i];
}
template <typename T>
glm::vec<3, T> toGlm(const T (&from)[3]) noexcept
{
    return {from[0], from[1], from[2]};
}

// As CndEnvironmentFrame::worldFromEnvironment.
template <glm::qualifier Q>
void assign(float (&to)[9], const glm::mat<3, 3, float, Q>& from) noexcept
{
    for (glm::length_t i = 0; i < 9; ++i)
        to[i] = from[i / 3][i % 3];
}

// `viewFromWorld`: rotation and translation; `clipFromView`: with Vulkan's y, pointing down
// (glm::perspective points it up: negate its [1][1]), and depth 0..1 (GLM_FORCE_DEPTH_ZERO_TO_ONE).
inline CndCamera camera(const glm::dmat4& viewFromWorld, const glm::mat4& clipFromView) noexcept
{
    CndCamera out{};
    for (glm::length_t i = 0; i < 16; ++i) {
        out.viewFromWorld[i] = viewFromWorld[i / 4][i % 4];
        out.clipFromView[i] = clipFromView[i / 4][i % 4];
    }
    return out;
}

} // namespace candelabra
