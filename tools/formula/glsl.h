// SPDX-License-Identifier: Apache-2.0
// What GLSL has built in, in double precision, as far as the shaders use it of which
// shaders/double_shaders.cmake makes C++. GLM's functions are templates, which do not convert
// arguments as GLSL does.
#pragma once

#include <bit>
#include <cmath>
#include <cstdint>

#include <glm/glm.hpp>

namespace candelabra::formula
{

using uint = std::uint32_t;
using vec2 = glm::dvec2;
using vec3 = glm::dvec3;
using vec4 = glm::dvec4;
using mat3 = glm::dmat3;
using glm::uvec2;

using glm::cross;
using glm::dot;
using glm::greaterThan;
using glm::length;
using glm::lessThan;
using glm::normalize;
using std::cos;
using std::log;
using std::sin;
using std::sqrt;

inline double inversesqrt(double x)
{
    return 1 / std::sqrt(x);
}
inline double fma(double a, double b, double c)
{
    return a * b + c;
}
inline double atan(double y, double x)
{
    return std::atan2(y, x);
}
inline double atan(double x)
{
    return std::atan(x);
}
inline double uintBitsToFloat(uint x)
{
    return double(std::bit_cast<float>(x));
}
inline int bitCount(uint x)
{
    return std::popcount(x);
}
inline uint findLSB(uint x)
{
    return uint(std::countr_zero(x));
}
inline uint findMSB(uint x)
{
    return x ? 31u - uint(std::countl_zero(x)) : ~0u;
}

// The functions that work by component.
#define BY_COMPONENT(T)                                                                            \
    inline T abs(T x)                                                                              \
    {                                                                                              \
        return glm::abs(x);                                                                        \
    }                                                                                              \
    inline T min(T x, T y)                                                                         \
    {                                                                                              \
        return glm::min(x, y);                                                                     \
    }                                                                                              \
    inline T max(T x, T y)                                                                         \
    {                                                                                              \
        return glm::max(x, y);                                                                     \
    }                                                                                              \
    inline T clamp(T x, T low, T high)                                                             \
    {                                                                                              \
        return glm::clamp(x, low, high);                                                           \
    }                                                                                              \
    inline T mix(T x, T y, double share)                                                           \
    {                                                                                              \
        return glm::mix(x, y, share);                                                              \
    }
BY_COMPONENT(double)
BY_COMPONENT(vec2)
BY_COMPONENT(vec3)
#undef BY_COMPONENT

inline uint min(uint x, uint y)
{
    return x < y ? x : y;
}
inline uint max(uint x, uint y)
{
    return x < y ? y : x;
}
inline vec2 max(vec2 x, double y)
{
    return glm::max(x, y);
}
inline vec2 mix(vec2 x, vec2 y, glm::bvec2 second)
{
    return glm::mix(x, y, second);
}
inline double smoothstep(double low, double high, double x)
{
    return glm::smoothstep(low, high, x);
}

} // namespace candelabra::formula
