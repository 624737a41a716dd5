// SPDX-License-Identifier: Apache-2.0
// Owners of the C ABI's objects, and their calls with failures as exceptions.
#pragma once

#include <utility>

#include "render/error.h"

namespace candelabra::app
{

template <typename T, void (*destroy)(T)>
class Module
{
public:
    Module() = default;
    explicit Module(T object) : object_(object) {}
    Module(Module&& other) noexcept : object_(std::exchange(other.object_, nullptr)) {}
    Module& operator=(Module&& other) noexcept
    {
        std::swap(object_, other.object_);
        return *this;
    }
    ~Module()
    {
        if (object_)
            destroy(object_);
    }
    T get() const { return object_; }

private:
    T object_ = nullptr;
};

using Lighting = Module<CndLighting, cndDestroyLighting>;
using LightingView = Module<CndLightingView, cndDestroyLightingView>;
using Exposure = Module<CndExposure, cndDestroyExposure>;

// Calls `function(arguments..., &error)`; throws RunError with its sentence when it fails.
template <typename... Parameters, typename... Arguments>
void call(CndResult (*function)(Parameters...), Arguments... arguments)
{
    CndError error{};
    check(function(arguments..., &error), error);
}

// create(device, &desc, &object, &error).
template <typename M, typename T, typename Parent, typename Desc>
M create(CndResult (*function)(Parent, const Desc*, T*, CndError*), Parent parent, const Desc& desc)
{
    T object{};
    call(function, parent, &desc, &object);
    return M(object);
}

} // namespace candelabra::app
