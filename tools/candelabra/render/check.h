// SPDX-License-Identifier: Apache-2.0
// Turns failed calls of Vulkan and of the engine into exceptions.
#pragma once

#include <type_traits>
#include <utility>

#include "candelabra/candelabra.hpp"
#include "gpu/failure.h"
#include "io/error.h"

namespace candelabra::app
{

// check(result, what) throws gpu::Failure if a Vulkan call failed; `what` says what the call was
// for.
using gpu::check;

// Returns the value of a result of the engine, or throws its error as a RunError.
template <typename T>
T valueOrThrow(Result<T> result)
{
    if (!result)
        throw RunError(result.error().message);
    if constexpr (!std::is_void_v<T>)
        return std::move(result.value());
}

} // namespace candelabra::app
