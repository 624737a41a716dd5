// SPDX-License-Identifier: Apache-2.0
// Whether the slow sweeps are asked for: tools/test --full.
#pragma once

#include <cstdlib>
#include <cstring>

namespace candelabra::test
{

inline bool fullTests()
{
    const char* value = std::getenv("CANDELABRA_FULL_TESTS");
    return value && std::strcmp(value, "1") == 0;
}

} // namespace candelabra::test
