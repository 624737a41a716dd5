// SPDX-License-Identifier: Apache-2.0
// The C++ interface of the C ABI: handles that own their objects, results instead of
// out-parameters, and structSize filled in. It needs C++17. The examples in the documents use
// C++20, because they initialise members by name. Units, ranges, ownership and thread rules are
// those of candelabra.h. Nothing throws.
#pragma once

#if __cplusplus < 201703L && (!defined(_MSVC_LANG) || _MSVC_LANG < 201703L)
#error "candelabra/candelabra.hpp needs C++17. Use candelabra/candelabra.h with C and older C++."
#endif

#include <array>
#include <cstdint>
#include <cstdio>
#include <cstdlib>
#include <optional>
#include <utility>
#if __has_include(<version>)
#include <version>
#endif
#if defined(__cpp_lib_span)
#include <span>
#endif

#include "candelabra/candelabra.h"

namespace candelabra
{

#if defined(__cpp_lib_span)
template <typename T>
using Span = std::span<T>;
#else
// A view of contiguous elements, of an array, a std::vector or the like.
template <typename T>
class Span
{
public:
    constexpr Span() = default;
    constexpr Span(T* data, size_t size) : data_(data), size_(size) {}
    template <size_t n>
    constexpr Span(T (&array)[n]) : data_(array), size_(n)
    {
    }
    template <typename Container, typename = decltype(std::declval<Container&>().data()),
              typename = decltype(std::declval<Container&>().size())>
    constexpr Span(Container&& container) : data_(container.data()), size_(container.size())
    {
    }
    constexpr T* data() const { return data_; }
    constexpr size_t size() const { return size_; }
    constexpr T* begin() const { return data_; }
    constexpr T* end() const { return data_ + size_; }

private:
    T* data_ = nullptr;
    size_t size_ = 0;
};
#endif

namespace detail
{

// Prints the sentence of an error to stderr and ends the program.
[[noreturn]] inline void end(const CndError& error) noexcept
{
    std::fprintf(stderr, "candelabra: %s\n", error.message);
    std::abort();
}

} // namespace detail

// A value of type T, or the error that prevented it. value(), * and -> of an error print its
// sentence to stderr and abort the program.
template <typename T>
class [[nodiscard]] Result
{
public:
    Result(T value) : value_(std::move(value)) {}
    Result(const CndError& error) : error_(error) {}
    explicit operator bool() const { return value_.has_value(); }
    T& value() &
    {
        check();
        return *value_;
    }
    const T& value() const&
    {
        check();
        return *value_;
    }
    T&& value() && { return std::move(value()); }
    T& operator*() & { return value(); }
    const T& operator*() const& { return value(); }
    T&& operator*() && { return std::move(*this).value(); }
    T* operator->() { return &value(); }
    const T* operator->() const { return &value(); }
    const CndError& error() const { return error_; }

private:
    void check() const
    {
        if (!value_)
            detail::end(error_);
    }

    std::optional<T> value_;
    CndError error_{};
};

// Success, or an error. value() returns nothing: it ends the program as above unless the call has
// succeeded.
template <>
class [[nodiscard]] Result<void>
{
public:
    Result() = default;
    Result(const CndError& error) : error_(error) {}
    explicit operator bool() const { return error_.code >= CND_SUCCESS; }
    void value() const
    {
        if (!*this)
            detail::end(error_);
    }
    const CndError& error() const { return error_; }

private:
    CndError error_{};
};

namespace detail
{

// Calls an ABI function whose last argument is the error to fill in.
template <typename Function, typename... Arguments>
Result<void> call(Function function, Arguments... arguments) noexcept
{
    CndError error{};
    function(arguments..., &error);
    return error;
}

// Calls an ABI function that writes a light, its last argument but one, and an error.
template <typename Function, typename... Arguments>
Result<CndLight> convert(Function function, Arguments... arguments) noexcept
{
    CndLight light{};
    CndError error{};
    if (function(arguments..., &light, &error) != CND_SUCCESS)
        return error;
    return light;
}

// Move-only owner of one ABI object.
template <typename H, void (*destroy)(H)>
class Owner
{
public:
    using Handle = H;

    Owner() = default;
    explicit Owner(H handle) : handle_(handle) {}
    Owner(Owner&& other) noexcept : handle_(std::exchange(other.handle_, nullptr)) {}
    // The object that *this owned before is destroyed.
    Owner& operator=(Owner&& other) noexcept
    {
        Owner moved(std::move(other));
        std::swap(handle_, moved.handle_);
        return *this;
    }
    ~Owner()
    {
        if (handle_)
            destroy(handle_);
    }
    H get() const { return handle_; }

protected:
    H handle_ = nullptr;
};

// Calls an ABI function that creates an object from `from`: a device, or a parent object.
template <typename Object, typename Function, typename From, typename Desc>
Result<Object> create(Function function, From from, Desc desc) noexcept
{
    desc.structSize = sizeof desc;
    typename Object::Handle handle = nullptr;
    CndError error{};
    if (function(from, &desc, &handle, &error) != CND_SUCCESS)
        return error;
    return Object(handle);
}

template <typename Object, typename Function, typename Desc>
Result<Object> createOn(CndDeviceDesc device, Function function, const Desc& desc) noexcept
{
    device.structSize = sizeof device;
    return create<Object>(function, &device, desc);
}

// Calls an ABI function that writes a CndMemoryUsage, its last argument but one, and an error.
template <typename Function, typename... Arguments>
Result<CndMemoryUsage> usage(Function function, Arguments... arguments) noexcept
{
    CndMemoryUsage out{};
    out.structSize = sizeof out;
    if (const Result<void> done = call(function, arguments..., &out); !done)
        return done.error();
    return out;
}

template <typename Function, typename Desc, typename... Arguments>
Result<CndMemoryUsage> plan(CndDeviceDesc device, Function function, Desc desc,
                            Arguments... arguments) noexcept
{
    device.structSize = sizeof device;
    desc.structSize = sizeof desc;
    return usage(function, &device, &desc, arguments...);
}

// Calls an ABI function that writes the statistics of a frame slot.
template <typename Stats, typename Function, typename H>
Result<std::optional<Stats>> stats(Function function, H handle, uint32_t frameSlot) noexcept
{
    Stats out{};
    out.structSize = sizeof out;
    const CndResult code = function(handle, frameSlot, &out);
    if (code == CND_NOT_READY)
        return std::optional<Stats>();
    if (code == CND_ERROR_INVALID_ARGUMENT)
        return CndError{code, VK_SUCCESS,
                        "stats: no frame was recorded in this slot, or there is no such slot"};
    if (code != CND_SUCCESS)
        return CndError{code, VK_SUCCESS, "stats: reading timestamps failed"};
    return std::optional<Stats>(out);
}

} // namespace detail

// Returns success, or an error whose message names everything that the device lacks of what the
// modules (a mask of CndModuleBits; 0: all) need. CndDeviceDesc::device is not used.
inline Result<void> checkDevice(CndDeviceDesc device, uint32_t modules = 0) noexcept
{
    device.structSize = sizeof device;
    return detail::call(cndCheckDevice, &device, modules);
}

// Sets the features that the modules (a mask of CndModuleBits; 0: all) need, in the structs of the
// chain.
inline Result<void> requireFeatures(VkPhysicalDeviceFeatures2& features,
                                    uint32_t modules = 0) noexcept
{
    return detail::call(cndRequireFeatures, modules, &features);
}

// Returns the largest number of lights in a set for a device with these limits.
inline uint32_t maxLightCount(const VkPhysicalDeviceLimits& limits) noexcept
{
    return cndMaxLightCount(&limits);
}

// One view of a Lighting. Destroy it before the Lighting.
class LightingView : public detail::Owner<CndLightingView, cndDestroyLightingView>
{
public:
    using Owner::Owner;

    Result<void> record(VkCommandBuffer cmd, CndLightingFrame frame) const noexcept
    {
        frame.structSize = sizeof frame;
        return detail::call(cndRecordLighting, handle_, cmd, &frame);
    }
    // Records a picture of what is read from the G-buffer, in addition to record() or instead of
    // it.
    Result<void> recordOverlay(VkCommandBuffer cmd, CndLightingFrame frame,
                               CndSurfaceOverlay overlay) const noexcept
    {
        frame.structSize = sizeof frame;
        overlay.structSize = sizeof overlay;
        return detail::call(cndRecordSurfaceOverlay, handle_, cmd, &frame, &overlay);
    }
    // Fails if CndLightingDesc::forwardStages is 0.
    Result<VkDescriptorSet> forwardSet(uint32_t frameSlot) const noexcept
    {
        VkDescriptorSet set{};
        CndError error{};
        if (cndGetForwardSet(handle_, frameSlot, &set, &error) != CND_SUCCESS)
            return error;
        return set;
    }
    // Empty until the GPU has finished the slot's frame; an error if no frame was recorded in it.
    Result<std::optional<CndLightingStats>> stats(uint32_t frameSlot) const noexcept
    {
        return detail::stats<CndLightingStats>(cndGetLightingStats, handle_, frameSlot);
    }
};

// Pipelines, one light set, and what casts shadows.
class Lighting : public detail::Owner<CndLighting, cndDestroyLighting>
{
public:
    using Owner::Owner;

    static Result<Lighting> create(const CndDeviceDesc& device,
                                   const CndLightingDesc& desc) noexcept
    {
        return detail::createOn<Lighting>(device, cndCreateLighting, desc);
    }
    // Returns the memory that a Lighting and these views will take. Creates nothing.
    template <size_t n>
    static Result<CndMemoryUsage> plan(const CndDeviceDesc& device, const CndLightingDesc& desc,
                                       std::array<CndLightingViewDesc, n> views) noexcept
    {
        return plan(device, desc, Span<CndLightingViewDesc>(views));
    }
    // The same for any number of views. They are not const because it fills in their structSize.
    static Result<CndMemoryUsage> plan(const CndDeviceDesc& device, const CndLightingDesc& desc,
                                       Span<CndLightingViewDesc> views = {}) noexcept
    {
        for (CndLightingViewDesc& view : views)
            view.structSize = sizeof view;
        return detail::plan(device, cndPlanLighting, desc, uint32_t(views.size()), views.data());
    }
    // Returns the memory that the Lighting and its views hold now.
    Result<CndMemoryUsage> memory() const noexcept
    {
        return detail::usage(cndGetLightingMemory, handle_);
    }
    // See cndAddLightingPipelines. May run on another thread while this object is used, but not
    // while it is moved or destroyed.
    Result<void> addPipelines(CndLightingPipelines pipelines) const noexcept
    {
        pipelines.structSize = sizeof pipelines;
        return detail::call(cndAddLightingPipelines, handle_, &pipelines);
    }
    // `origin` is the point in world space that the lights' positions are relative to.
    Result<void> setLights(Span<const CndLight> lights, const double (&origin)[3]) noexcept
    {
        return setLights({0,
                          uint32_t(lights.size()),
                          lights.data(),
                          {origin[0], origin[1], origin[2]},
                          nullptr});
    }
    Result<void> setLights(CndLightSet set) noexcept
    {
        set.structSize = sizeof set;
        return detail::call(cndSetLights, handle_, &set);
    }
    // Writes the lights' ids to `ids`, which must have as many elements as `lights`.
    Result<void> addLights(Span<const CndLight> lights, Span<CndLightId> ids) noexcept
    {
        if (ids.size() != lights.size())
            return CndError{CND_ERROR_INVALID_ARGUMENT, VK_SUCCESS,
                            "Lighting::addLights: ids must have as many elements as lights"};
        return detail::call(cndAddLights, handle_, uint32_t(lights.size()), lights.data(),
                            ids.data());
    }
    Result<CndLightId> addLight(const CndLight& light) noexcept
    {
        CndLightId id = 0;
        if (const Result<void> added = addLights({&light, 1}, {&id, 1}); !added)
            return added.error();
        return id;
    }
    Result<void> updateLights(Span<const CndLightId> ids, Span<const CndLight> lights) noexcept
    {
        if (ids.size() != lights.size())
            return CndError{CND_ERROR_INVALID_ARGUMENT, VK_SUCCESS,
                            "Lighting::updateLights: ids must have as many elements as lights"};
        return detail::call(cndUpdateLights, handle_, uint32_t(ids.size()), ids.data(),
                            lights.data());
    }
    Result<void> removeLights(Span<const CndLightId> ids) noexcept
    {
        return detail::call(cndRemoveLights, handle_, uint32_t(ids.size()), ids.data());
    }
    // The calls about occluders need CndLightingDesc::shadows. They write the ids of what they add
    // to `ids`, which must have as many elements.
    Result<void> addOccluderMeshes(Span<const CndOccluderMesh> meshes,
                                   Span<CndOccluderMeshId> ids) noexcept
    {
        if (ids.size() != meshes.size())
            return CndError{
                CND_ERROR_INVALID_ARGUMENT, VK_SUCCESS,
                "Lighting::addOccluderMeshes: ids must have as many elements as meshes"};
        return detail::call(cndAddOccluderMeshes, handle_, uint32_t(meshes.size()), meshes.data(),
                            ids.data());
    }
    Result<CndOccluderMeshId> addOccluderMesh(const CndOccluderMesh& mesh) noexcept
    {
        CndOccluderMeshId id = 0;
        if (const Result<void> added = addOccluderMeshes({&mesh, 1}, {&id, 1}); !added)
            return added.error();
        return id;
    }
    // `positions` has as many as the mesh was added with.
    Result<void> replaceOccluderPositions(CndOccluderMeshId mesh, const float* positions,
                                          uint32_t stride = 0) noexcept
    {
        return detail::call(cndReplaceOccluderPositions, handle_, mesh, positions, stride);
    }
    Result<void> replaceOccluderPositionsOnDevice(Span<const CndDevicePositions> positions) noexcept
    {
        return detail::call(cndReplaceOccluderPositionsOnDevice, handle_,
                            uint32_t(positions.size()), positions.data());
    }
    Result<void> removeOccluderMeshes(Span<const CndOccluderMeshId> ids) noexcept
    {
        return detail::call(cndRemoveOccluderMeshes, handle_, uint32_t(ids.size()), ids.data());
    }
    Result<void> addOccluders(Span<const CndOccluderInstance> instances,
                              Span<CndOccluderId> ids) noexcept
    {
        if (ids.size() != instances.size())
            return CndError{CND_ERROR_INVALID_ARGUMENT, VK_SUCCESS,
                            "Lighting::addOccluders: ids must have as many elements as instances"};
        return detail::call(cndAddOccluders, handle_, uint32_t(instances.size()), instances.data(),
                            ids.data());
    }
    Result<CndOccluderId> addOccluder(const CndOccluderInstance& instance) noexcept
    {
        CndOccluderId id = 0;
        if (const Result<void> added = addOccluders({&instance, 1}, {&id, 1}); !added)
            return added.error();
        return id;
    }
    Result<void> updateOccluders(Span<const CndOccluderId> ids,
                                 Span<const CndOccluderInstance> instances) noexcept
    {
        if (ids.size() != instances.size())
            return CndError{
                CND_ERROR_INVALID_ARGUMENT, VK_SUCCESS,
                "Lighting::updateOccluders: ids must have as many elements as instances"};
        return detail::call(cndUpdateOccluders, handle_, uint32_t(ids.size()), ids.data(),
                            instances.data());
    }
    Result<void> removeOccluders(Span<const CndOccluderId> ids) noexcept
    {
        return detail::call(cndRemoveOccluders, handle_, uint32_t(ids.size()), ids.data());
    }
    Result<VkDescriptorSetLayout> forwardSetLayout() const noexcept
    {
        VkDescriptorSetLayout layout{};
        CndError error{};
        if (cndGetForwardSetLayout(handle_, &layout, &error) != CND_SUCCESS)
            return error;
        return layout;
    }
    Result<LightingView> createView(const CndLightingViewDesc& desc) const noexcept
    {
        return detail::create<LightingView>(cndCreateLightingView, handle_, desc);
    }
};

// An image of the far surroundings that lights surfaces.
class Environment : public detail::Owner<CndEnvironment, cndDestroyEnvironment>
{
public:
    using Owner::Owner;

    static Result<Environment> create(const CndDeviceDesc& device,
                                      const CndEnvironmentDesc& desc) noexcept
    {
        return detail::createOn<Environment>(device, cndCreateEnvironment, desc);
    }
    static Result<CndMemoryUsage> plan(const CndDeviceDesc& device,
                                       const CndEnvironmentDesc& desc) noexcept
    {
        return detail::plan(device, cndPlanEnvironment, desc);
    }
    Result<CndMemoryUsage> memory() const noexcept
    {
        return detail::usage(cndGetEnvironmentMemory, handle_);
    }
    Result<void> recordMap(VkCommandBuffer cmd, CndEnvironmentMap map) const noexcept
    {
        map.structSize = sizeof map;
        return detail::call(cndRecordEnvironmentMap, handle_, cmd, &map);
    }
    Result<void> record(VkCommandBuffer cmd, CndEnvironmentFrame frame) const noexcept
    {
        frame.structSize = sizeof frame;
        return detail::call(cndRecordEnvironment, handle_, cmd, &frame);
    }
    Result<std::optional<CndEnvironmentStats>> stats(uint32_t frameSlot) const noexcept
    {
        return detail::stats<CndEnvironmentStats>(cndGetEnvironmentStats, handle_, frameSlot);
    }
};

// Eye adaptation and tone mapping of one view.
class Exposure : public detail::Owner<CndExposure, cndDestroyExposure>
{
public:
    using Owner::Owner;

    static Result<Exposure> create(const CndDeviceDesc& device,
                                   const CndExposureDesc& desc) noexcept
    {
        return detail::createOn<Exposure>(device, cndCreateExposure, desc);
    }
    static Result<CndMemoryUsage> plan(const CndDeviceDesc& device,
                                       const CndExposureDesc& desc) noexcept
    {
        return detail::plan(device, cndPlanExposure, desc);
    }
    Result<CndMemoryUsage> memory() const noexcept
    {
        return detail::usage(cndGetExposureMemory, handle_);
    }
    Result<void> setMask(Span<const uint8_t> weights, uint32_t width, uint32_t height) noexcept
    {
        if (weights.size() != size_t(width) * height)
            return CndError{CND_ERROR_INVALID_ARGUMENT, VK_SUCCESS,
                            "Exposure::setMask: weights must have width * height elements"};
        return detail::call(cndSetExposureMask, handle_, weights.data(), width, height);
    }
    Result<void> record(VkCommandBuffer cmd, CndExposureFrame frame) const noexcept
    {
        frame.structSize = sizeof frame;
        return detail::call(cndRecordExposure, handle_, cmd, &frame);
    }
    Result<std::optional<CndExposureStats>> stats(uint32_t frameSlot) const noexcept
    {
        return detail::stats<CndExposureStats>(cndGetExposureStats, handle_, frameSlot);
    }
};

// Returns the lumens per channel that a light emits. Fails for directional and distant lights.
inline Result<std::array<float, 3>> luminousPowerOfLight(const CndLight& light) noexcept
{
    std::array<float, 3> power{};
    CndError error{};
    if (cndLuminousPowerOfLight(&light, power.data(), &error) != CND_SUCCESS)
        return error;
    return power;
}

// Makes `light` a polygon light with these corners in space; see cndPolygonFromCorners. `light`
// then points to `polygon`.
inline Result<void> polygonFromCorners(Span<const std::array<float, 3>> corners, CndLight& light,
                                       CndPolygon& polygon) noexcept
{
    CndError error{};
    if (cndPolygonFromCorners(reinterpret_cast<const float(*)[3]>(corners.data()),
                              uint32_t(corners.size()), &light, &polygon, &error) != CND_SUCCESS)
        return error;
    return {};
}

// Conversions between types of lights; see lights.h. If radius, sine or distance is 0, the library
// chooses it.

inline Result<CndLight> sphereFromPoint(const CndLight& point, const float (&at)[3],
                                        float radius = 0) noexcept
{
    return detail::convert(cndSphereFromPoint, &point, radius, at);
}
inline Result<CndLight> pointFromSphere(const CndLight& sphere) noexcept
{
    return detail::convert(cndPointFromSphere, &sphere);
}
inline Result<CndLight> distantSphereFromDirectional(const CndLight& directional,
                                                     float sine = 0) noexcept
{
    return detail::convert(cndDistantSphereFromDirectional, &directional, sine);
}
inline Result<CndLight> directionalFromDistantSphere(const CndLight& distantSphere) noexcept
{
    return detail::convert(cndDirectionalFromDistantSphere, &distantSphere);
}
inline Result<CndLight> sphereFromDirectional(const CndLight& directional, const float (&at)[3],
                                              float distance = 0, float sine = 0) noexcept
{
    return detail::convert(cndSphereFromDirectional, &directional, at, distance, sine);
}
inline Result<CndLight> directionalFromSphere(const CndLight& sphere, const float (&at)[3]) noexcept
{
    return detail::convert(cndDirectionalFromSphere, &sphere, at);
}

inline CndExposureSettings defaultExposureSettings() noexcept
{
    CndExposureSettings settings{};
    cndDefaultExposureSettings(&settings);
    return settings;
}

} // namespace candelabra
