// SPDX-License-Identifier: Apache-2.0
// In a file of its own, so that no caller's compiler sees that operator new is malloc.
#include "mock/host_allocations.h"

#include <cstdlib>
#include <new>

namespace candelabra::test
{
namespace
{

struct HeapState {
    uint64_t count = 0, failing = UINT64_MAX;
    int paused = 1; // allocations count while this is 0
};
thread_local HeapState heap;

} // namespace

HostAllocations::HostAllocations(uint64_t failing)
{
    heap = {.failing = failing, .paused = 0};
}

HostAllocations::~HostAllocations()
{
    heap.paused = 1;
}

uint64_t HostAllocations::count() const
{
    return heap.count;
}

HostAllocations::Pause::Pause()
{
    ++heap.paused;
}

HostAllocations::Pause::~Pause()
{
    --heap.paused;
}

} // namespace candelabra::test

// Replaces operator new of the whole program. Outside of HostAllocations it is malloc and free.
void* operator new(size_t size)
{
    using candelabra::test::heap;
    const bool counted = heap.paused == 0;
    if (counted && heap.count++ == heap.failing)
        throw std::bad_alloc();
    if (void* memory = std::malloc(size ? size : 1))
        return memory;
    throw std::bad_alloc();
}

// Callers of this form can do without memory (std::stable_sort), so it is neither counted nor
// refused.
void* operator new(size_t size, const std::nothrow_t&) noexcept
{
    return std::malloc(size ? size : 1);
}

void operator delete(void* memory) noexcept
{
    std::free(memory);
}

void operator delete(void* memory, size_t) noexcept
{
    std::free(memory);
}
