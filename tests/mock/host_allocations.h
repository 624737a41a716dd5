// SPDX-License-Identifier: Apache-2.0
// Counts or refuses heap allocations of the code under test.
#pragma once

#include <cstdint>

namespace candelabra::test
{

// Counts the calls of throwing operator new on this thread while the object lives, except while a
// Pause lives.
class HostAllocations
{
public:
    // Call number `failing`, counted from 0, throws std::bad_alloc.
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
