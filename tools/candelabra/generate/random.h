// SPDX-License-Identifier: Apache-2.0
// The random numbers of generators and benchmarks. They are equal on every platform, unlike those
// of the distributions of the standard library.
#pragma once

#include <cstddef>
#include <cstdint>
#include <iterator>

#include <glm/glm.hpp>

namespace candelabra::app
{

template <typename T>
struct Share {
    float share; // all shares of a list add up to 1
    T value;
};

// PCG32 (O'Neill 2014, "PCG: A Family of Simple Fast Space-Efficient Statistically Good Algorithms
// for Random Number Generation", pcg32_random_r). Do not call it twice in one expression, unless it
// is a list in braces: the order of the calls must be defined.
class Random
{
public:
    // Different streams of one seed are independent sequences.
    explicit Random(uint64_t seed, uint64_t stream = 0) : increment_(stream << 1u | 1u)
    {
        bits();
        state_ += seed;
        bits();
    }

    uint32_t bits()
    {
        const uint64_t old = state_;
        state_ = old * 6364136223846793005ull + increment_;
        const uint32_t xorShifted = uint32_t(((old >> 18u) ^ old) >> 27u);
        const uint32_t rotation = uint32_t(old >> 59u);
        return xorShifted >> rotation | xorShifted << ((0u - rotation) & 31u);
    }

    // Uniform in [0, 1). It has 24 bits, so that the float is exact and never rounds to 1.
    float uniform() { return float(bits() >> 8u) * 0x1p-24f; }

    float uniform(float low, float high) { return low + (high - low) * uniform(); }

    // Uniform in 0 .. count - 1, but for a bias of count / 2^32, which does not matter here.
    uint32_t below(uint32_t count) { return uint32_t(uint64_t(bits()) * count >> 32u); }

    bool chance(float probability) { return uniform() < probability; }

    float side() { return chance(0.5f) ? 1.0f : -1.0f; }

    // From `low` to `high`; small values are frequent.
    float skewed(float low, float high)
    {
        const float share = uniform();
        return low + (high - low) * share * share;
    }

    // Returns one of the values, which are equally likely.
    const auto& anyOf(const auto& values) { return values[below(uint32_t(std::size(values)))]; }
    // Returns one of the values, each with the probability of its share.
    template <typename T, size_t N>
    T oneOf(const Share<T> (&choices)[N])
    {
        float at = uniform();
        for (const Share<T>& choice : choices) {
            if (at < choice.share)
                return choice.value;
            at -= choice.share;
        }
        return choices[0].value; // sums of shares are rounded
    }

    // Roughly normal with mean 0 and standard deviation 1/3, within (-1, 1): the mean of three
    // uniform numbers.
    float bell()
    {
        float sum = uniform();
        sum += uniform();
        sum += uniform();
        return sum * (2.0f / 3.0f) - 1.0f;
    }

    glm::vec2 uniform2() { return glm::vec2{uniform(), uniform()}; }

    glm::vec3 uniform3() { return glm::vec3{uniform(), uniform(), uniform()}; }

private:
    uint64_t state_ = 0;
    uint64_t increment_;
};

} // namespace candelabra::app
