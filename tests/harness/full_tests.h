// SPDX-License-Identifier: Apache-2.0
// Returns whether the slow sweeps were requested: tools/test --full.
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
