// SPDX-License-Identifier: Apache-2.0
// How the program fails: what() is one sentence for the user; the type decides the exit code.
#pragma once

#include <stdexcept>
#include <string>
#include <type_traits>
#include <utility>

#include "candelabra/candelabra.hpp"
#include "gpu/failure.h"

namespace candelabra::app
{

constexpr int exitOk = 0;
constexpr int exitFailed = 1; // something that should have worked did not, or a check failed
constexpr int exitUsage = 2;  // arguments, files or an environment the program cannot work with
constexpr int exitSlower = 3; // candelabra compare: something takes longer

// Arguments that cannot be used. Exit code 2.
struct UsageError : std::runtime_error {
    using std::runtime_error::runtime_error;
};

// A failing call or check. Exit code 1.
struct RunError : std::runtime_error {
    using std::runtime_error::runtime_error;
};

// Throws gpu::Failure when a Vulkan call failed; `what` says what was being done.
using gpu::check;

// The value of a result of the engine, or its error as a RunError.
template <typename T>
T take(Result<T> result)
{
    if (!result)
        throw RunError(result.error().message);
    if constexpr (!std::is_void_v<T>)
        return std::move(result.value());
}

} // namespace candelabra::app
