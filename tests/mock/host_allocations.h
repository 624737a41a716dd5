// SPDX-License-Identifier: Apache-2.0
// What code under test takes from the heap: counted, or refused.
#pragma once

#include <cstdint>

namespace candelabra::test
{

// Counts calls of operator new that may throw, of this thread, from the construction to the
// destruction, but for those while a Pause lives.
class HostAllocations
{
public:
    // The call number `failing`, from 0, throws std::bad_alloc.
    explicit HostAllocations(uint64_t failing = UINT64_MAX);
    ~HostAllocations();
    HostAllocations(const HostAllocations&) = delete;
    HostAllocations& operator=(const HostAllocations&) = delete;
    uint64_t count() const;

    struct Pause {
        Pause();
        ~Pause();
    };
};

} // namespace candelabra::test
