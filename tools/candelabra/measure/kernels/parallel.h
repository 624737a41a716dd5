// SPDX-License-Identifier: Apache-2.0
// Distributes independent work among the CPU cores.
#pragma once

#include <atomic>
#include <cstddef>
#include <exception>
#include <mutex>
#include <thread>
#include <vector>

namespace candelabra::app
{

// Calls work(i) for every i from 0 to count - 1, in blocks on all cores. `onDone(n)` is called, by
// one thread at a time, each time n more calls are done. The last exception thrown is rethrown.
template <typename Work, typename OnDone>
void parallelFor(size_t count, Work work, OnDone onDone)
{
    constexpr size_t block = 64;
    std::atomic<size_t> next{0};
    std::mutex mutex;
    std::exception_ptr failure;
    const auto run = [&] {
        try {
            for (size_t first; (first = next.fetch_add(block)) < count;) {
                const size_t end = std::min(first + block, count);
                for (size_t i = first; i < end; ++i)
                    work(i);
                const std::lock_guard lock(mutex);
                onDone(end - first);
            }
        } catch (...) {
            const std::lock_guard lock(mutex);
            failure = std::current_exception();
            next = count;
        }
    };
    std::vector<std::thread> threads;
    for (unsigned i = 1; i < std::thread::hardware_concurrency(); ++i)
        threads.emplace_back(run);
    run();
    for (std::thread& thread : threads)
        thread.join();
    if (failure)
        std::rethrow_exception(failure);
}

} // namespace candelabra::app
