// SPDX-License-Identifier: Apache-2.0
// Tells whether all tests run in full (tools/test --full), and whether they have AddressSanitizer.
#pragma once

#include <cstdlib>
#include <cstring>

namespace candelabra::test
{

// True in a build with AddressSanitizer (g++ and clang announce it in different ways), in which
// tests take ten times as long.
#if defined(__SANITIZE_ADDRESS__)
inline constexpr bool sanitized = true;
#elif defined(__has_feature)
inline constexpr bool sanitized = __has_feature(address_sanitizer);
#else
inline constexpr bool sanitized = false;
#endif

// Returns whether the slow sweeps were requested: tools/test --full.
inline bool fullTests()
{
    const char* value = std::getenv("CANDELABRA_FULL_TESTS");
    return value && std::strcmp(value, "1") == 0;
}

} // namespace candelabra::test
