// SPDX-License-Identifier: Apache-2.0
// A hash that distinguishes contents that differ by accident. It does not protect against contents
// that were chosen to have the same hash. std::hash is not used, because hashes are stored in
// files and it may differ between standard libraries.
#pragma once

#include <cstdint>
#include <span>
#include <type_traits>

namespace candelabra::app
{

// FNV-1a, 64 bits (Fowler, Noll and Vo 1991).
class Hash
{
public:
    // Adds the bytes of the values to the hash. Only arithmetic types are allowed: they have no
    // padding.
    template <typename T>
    void add(std::span<const T> values)
    {
        static_assert(std::is_arithmetic_v<T>);
        const auto* bytes = reinterpret_cast<const unsigned char*>(values.data());
        for (size_t i = 0; i < values.size_bytes(); ++i)
            value_ = (value_ ^ bytes[i]) * 0x100000001b3;
    }
    template <typename T>
    void add(const T& value)
    {
        add(std::span<const T>(&value, 1));
    }
    uint64_t value() const { return value_; }

private:
    uint64_t value_ = 0xcbf29ce484222325;
};

} // namespace candelabra::app
