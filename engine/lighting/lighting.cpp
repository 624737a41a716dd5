// SPDX-License-Identifier: Apache-2.0
#include "lighting/lighting.h"

#include <algorithm>
#include <cmath>

#include "candelabra_shaders.h"
#include "lighting/pack_lights.h"

namespace candelabra::lighting
{
namespace
{

// Light buffers start with this capacity and grow by half, so that a growing scene reallocates
// rarely; the smallest is 56 + 64 bytes per light.
constexpr uint32_t minCapacity = 1024;

constexpr VkBufferUsageFlags storageUse =
    VK_BUFFER_USAGE_STORAGE_BUFFER_BIT | VK_BUFFER_USAGE_TRANSFER_DST_BIT;

// Texel buffers when they can hold every light that the other limits let in.
uint32_t lightsAsTexels(const gpu::Device& device)
{
    return device.limits.maxTexelBufferElements / gpu::LIGHT_CORE_STRIDE >=
           maxLights(device.limits);
}

void createShadeKernels(ShadeKernels& out, const gpu::Device& device, const gpu::Spirv& spirv,
                        CndGBufferLayout layout)
{
    for (uint32_t method = 0; method < CND_SPECULAR_METHOD_COUNT; ++method)
        for (const bool onlySpheres : {false, true}) {
            auto& kernels = onlySpheres ? out.onlySpheres : out.anyLights;
            kernels[method] =
                gpu::Kernel<gpu::ShadeParams>(device, spirv,
                                              {{gpu::SPEC_LIGHTS_AS_TEXELS, lightsAsTexels(device)},
                                               {gpu::SPEC_SPECULAR_METHOD, method},
                                               {gpu::SPEC_ONLY_SPHERES, onlySpheres},
                                               {gpu::SPEC_GBUFFER_LAYOUT, uint32_t(layout)}});
        }
}

// The hungriest kernel is tile_lists: it may walk every light and every mask word twice, and adds
// up the 64 lists of a group twice. shade_tiles walks a list and its blocks, then every light it
// found.
uint32_t batchSize(const gpu::Device& device)
{
    if (device.maxLoopIterations == UINT32_MAX)
        return UINT32_MAX;
    constexpr uint32_t fixedIterations = 1024; // sums over the group and retries of the reservation
    constexpr uint32_t multiple = 1024;
    const uint64_t lights = uint64_t(device.maxLoopIterations - fixedIterations) * gpu::MASK_BITS /
                            (2 * (gpu::MASK_BITS + 1));
    return uint32_t(lights / multiple * multiple);
}

CndLightingDesc checked(const CndLightingDesc& desc)
{
    if (desc.structSize != sizeof desc)
        gpu::failArgument("CndLightingDesc: structSize is " + std::to_string(desc.structSize) +
                          ", this library expects " + std::to_string(sizeof desc));
    if (desc.framesInFlight < 1 || desc.framesInFlight > 8)
        gpu::failArgument("CndLightingDesc: framesInFlight must be 1..8, is " +
                          std::to_string(desc.framesInFlight));
    if (desc.gbufferLayout != CND_GBUFFER_FULL && desc.gbufferLayout != CND_GBUFFER_COMPACT)
        gpu::failArgument("CndLightingDesc: gbufferLayout is not a CndGBufferLayout");
    return desc;
}

} // namespace

// What the record buffer, one dispatch of prepare_lights and the 32-bit sums of count_pairs over
// the 64 pixels of a tile can take.
uint32_t maxLights(const VkPhysicalDeviceLimits& limits)
{
    constexpr uint64_t countable = UINT32_MAX / (gpu::TILE_SIZE * gpu::TILE_SIZE);
    const uint64_t stored = limits.maxStorageBufferRange / sizeof(gpu::LightRecord);
    const uint64_t dispatched =
        uint64_t(limits.maxComputeWorkGroupCount[0]) * gpu::PREPARE_LIGHTS_GROUP;
    return uint32_t(std::min({countable, stored, dispatched}));
}

Kernels::Kernels(const gpu::Device& device, CndGBufferLayout layout)
    : prepareLights(device, spirv::prepare_lights_comp),
      tileBounds(device, spirv::tile_bounds_comp),
      coarseBounds(device, spirv::coarse_bounds_comp),
      coarseMasks(device, spirv::coarse_masks_comp,
                  {{gpu::SPEC_LIGHTS_AS_TEXELS, lightsAsTexels(device)}}),
      tileLists(device, spirv::tile_lists_comp,
                {{gpu::SPEC_LIGHTS_AS_TEXELS, lightsAsTexels(device)}}),
      countPairs(device, spirv::count_pairs_comp,
                 {{gpu::SPEC_LIGHTS_AS_TEXELS, lightsAsTexels(device)},
                  {gpu::SPEC_GBUFFER_LAYOUT, uint32_t(layout)}})
{
    createShadeKernels(shadeTiles, device, spirv::shade_tiles_comp, layout);
    createShadeKernels(shadeBrute, device, spirv::shade_brute_comp, layout);
}

Lighting::Lighting(const CndDeviceDesc& device, const CndLightingDesc& desc)
    : device_(device),
      desc_(checked(desc)),
      kernels_(device_, desc_.gbufferLayout),
      lightsPerBatch_(batchSize(device_))
{
    grow(0);
}

void Lighting::setLights(const CndLightSet& set)
{
    if (set.structSize != sizeof set)
        gpu::failArgument("CndLightSet: structSize is " + std::to_string(set.structSize) +
                          ", this library expects " + std::to_string(sizeof set));
    if (set.count && !set.lights)
        gpu::failArgument("CndLightSet: lights is null but count is " + std::to_string(set.count));
    if (set.count > maxLights(device_.limits))
        gpu::failUnsupported("CndLightSet: " + std::to_string(set.count) +
                             " lights are more than the device can take, " +
                             std::to_string(maxLights(device_.limits)));
    for (const double o : set.origin)
        if (!std::isfinite(o))
            gpu::failArgument("CndLightSet: origin must be finite");
    const std::span lights(set.lights, set.count);
    const bool onlySpheres = validateLights(lights);
    freeRetired();
    grow(set.count);
    Staging& staging = freeStaging();
    packLights(lights, staging.buffer.as<gpu::LightRecord>());
    pending_ = &staging;
    onlySpheres_ = onlySpheres;
    lightCount_ = set.count;
    std::copy_n(set.origin, 3, origin_);
}

Lighting::Staging& Lighting::freeStaging()
{
    if (pending_) // never recorded: overwrite in place
        return *pending_;
    const uint64_t running = oldest(&View::oldestRunning);
    for (Staging& staging : staging_)
        if (staging.recording < running)
            return staging;
    return staging_.emplace_back(createStaging(lightCapacity_));
}

gpu::Buffer Lighting::createStaging(uint32_t capacity) const
{
    return gpu::createBuffer(device_, "light staging", capacity * sizeof(gpu::LightRecord),
                             VK_BUFFER_USAGE_TRANSFER_SRC_BIT, gpu::MemoryUse::Upload);
}

void Lighting::recordUpload(VkCommandBuffer cmd, uint64_t recording) noexcept
{
    if (!pending_)
        return;
    if (lightCount_) {
        const VkBufferCopy copy{.size = lightCount_ * sizeof(gpu::LightRecord)};
        device_.CmdCopyBuffer(cmd, pending_->buffer.get(), records_.get(), 1, &copy);
    }
    pending_->recording = recording;
    pending_ = nullptr;
}

void Lighting::grow(uint32_t count)
{
    if (lightCapacity_ && count <= lightCapacity_)
        return;
    const uint32_t wanted = std::max({count, minCapacity, lightCapacity_ + lightCapacity_ / 2});
    const uint32_t previous = lightCapacity_;
    const uint32_t capacity = std::min(wanted, maxLights(device_.limits));
    // Everything is allocated before anything is replaced: a failure leaves the old set in place.
    gpu::Buffer records =
        gpu::createBuffer(device_, "light records", capacity * sizeof(gpu::LightRecord), storageUse,
                          gpu::MemoryUse::Device);
    std::deque<Staging> staging;
    staging.emplace_back(createStaging(capacity)); // what fills the new records
    try {
        lightCapacity_ = capacity;
        for (View* view : views_)
            view->growLightBuffers();
    } catch (...) {
        lightCapacity_ = previous;
        throw;
    }
    replace(records_, std::move(records));
    for (Staging& old : staging_)
        replace(old.buffer, {});
    staging_ = std::move(staging);
    pending_ = nullptr;
}

void Lighting::replace(gpu::Buffer& buffer, gpu::Buffer&& with)
{
    if (buffer.buffer)
        retired_.push_back({std::move(buffer), recordings_});
    buffer = std::move(with);
}

uint64_t Lighting::oldest(uint64_t (View::*ofView)() const) const
{
    uint64_t result = recordings_ + 1;
    for (const View* view : views_)
        if (const uint64_t recording = (view->*ofView)())
            result = std::min(result, recording);
    return result;
}

void Lighting::freeRetired()
{
    const uint64_t pending = oldest(&View::oldestPending);
    std::erase_if(retired_, [&](const Retired& r) { return r.recording < pending; });
}

} // namespace candelabra::lighting
