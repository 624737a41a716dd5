// SPDX-License-Identifier: Apache-2.0
// Failing calls of Vulkan and of the engine as exceptions.
#pragma once

#include <type_traits>
#include <utility>

#include "candelabra/candelabra.hpp"
#include "gpu/failure.h"
#include "io/error.h"

namespace candelabra::app
{

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
