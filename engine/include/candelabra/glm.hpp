// SPDX-License-Identifier: Apache-2.0
// Conversions between GLM types and the structs of candelabra.h, for hosts that use GLM (0.9.9 or
// later). No other header of Candelabra includes GLM or this header.
#pragma once

#include <glm/mat3x3.hpp>
#include <glm/mat4x4.hpp>
#include <glm/vec3.hpp>

#include "candelabra/candelabra.h"

namespace candelabra
{

// These copy three numbers to and from GLM vectors: positions, axes and emission of lights, and
// origins of light sets.
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

// Copies a rotation into CndEnvironmentFrame::worldFromEnvironment, column by column.
template <glm::qualifier Q>
void assign(float (&to)[9], const glm::mat<3, 3, float, Q>& from) noexcept
{
    for (glm::length_t i = 0; i < 9; ++i)
        to[i] = from[i / 3][i % 3];
}

// Copies a transform from the space of a mesh to the world into CndOccluderInstance::worldFromMesh,
// row by row.
template <typename T, glm::qualifier Q>
void assign(double (&to)[12], const glm::mat<4, 4, T, Q>& from) noexcept
{
    for (glm::length_t i = 0; i < 12; ++i)
        to[i] = from[i % 4][i / 4];
}

// Makes a CndCamera. `viewFromWorld` is a rotation and a translation. `clipFromView` is a
// projection for Vulkan's clip space, with depth 0..1 (GLM_FORCE_DEPTH_ZERO_TO_ONE) and with y
// pointing down. In glm::perspective y points up, so negate its [1][1].
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
