// SPDX-License-Identifier: Apache-2.0
// The C++ half of prelude.h: the types of GLSL under their GLSL names.
#pragma once

#include <cstdint>

#include <glm/mat3x3.hpp>
#include <glm/mat4x4.hpp>
#include <glm/vec2.hpp>
#include <glm/vec3.hpp>
#include <glm/vec4.hpp>

namespace candelabra::gpu
{
using uint = std::uint32_t;
using glm::mat3;
using glm::mat4;
using glm::uvec2;
using glm::uvec3;
using glm::uvec4;
using glm::vec2;
using glm::vec3;
using glm::vec4;
} // namespace candelabra::gpu

#define GPU_BEGIN                                                                                  \
    namespace candelabra::gpu                                                                      \
    {
#define GPU_END }
// Checks the size of a struct in bytes. Structs of push constants must fit into the 128 bytes that
// Vulkan guarantees.
#define GPU_SIZE(Type, bytes) static_assert(sizeof(Type) == bytes);
