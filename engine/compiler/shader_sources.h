// SPDX-License-Identifier: Apache-2.0
// The shaders as text, found by the name that #include uses. embed.cmake generates the definition.
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
