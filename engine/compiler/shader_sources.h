// SPDX-License-Identifier: Apache-2.0
// The shaders as text, by the name that includes give them. Made by embed.cmake.
#pragma once

#include <span>
#include <string_view>

namespace candelabra::compiler
{

struct ShaderSource {
    std::string_view name; // "lib/math.glsl"
    std::string_view text;
};
std::span<const ShaderSource> shaderSources();

} // namespace candelabra::compiler
