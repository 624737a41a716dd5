// SPDX-License-Identifier: Apache-2.0
#include "lighting/lighting.h"

#include <algorithm>
#include <cmath>
#include <numeric>

#include "candelabra_shaders.h"
#include "tables/ltc_table.h"

namespace candelabra::lighting
{
namespace
{

// Light buffers start with this capacity and grow by half, so that a growing scene reallocates
// rarely; the smallest is 64 + 64 bytes per light.
constexpr uint32_t minCapacity = 1024;

constexpr VkBufferUsageFlags storageUse =
    VK_BUFFER_USAGE_STORAGE_BUFFER_BIT | VK_BUFFER_USAGE_TRANSFER_DST_BIT;

CndLightingDesc checked(CndLightingDesc desc)
{
    if (desc.structSize != sizeof desc)
        gpu::failArgument("CndLightingDesc: structSize is " + std::to_string(desc.structSize) +
                          ", this library expects " + std::to_string(sizeof desc));
    if (desc.framesInFlight < 1 || desc.framesInFlight > 8)
        gpu::failArgument("CndLightingDesc: framesInFlight must be 1..8, is " +
                          std::to_string(desc.framesInFlight));
    if (desc.specularMethods >> CND_SPECULAR_METHOD_COUNT)
        gpu::failArgument("CndLightingDesc: specularMethods has bits beyond the last "
                          "CndSpecularMethod");
    if (!desc.specularMethods)
        desc.specularMethods = 1u << CND_SPECULAR_CONIC;
    return desc;
}

gpu::Buffer createLtcBuffer(const gpu::Device& device)
{
    const VkDeviceSize bytes = tables::ltcTable().size_bytes();
    constexpr VkDeviceSize maxUpdate = 65536; // of vkCmdUpdateBuffer
    static_assert(gpu::LTC_TABLE_SIZE * gpu::LTC_TABLE_SIZE * gpu::LTC_TEXELS * sizeof(glm::vec4) <=
                  maxUpdate);
    gpu::Buffer out = gpu::createBuffer(device, "transformed cosines", bytes,
                                        VK_BUFFER_USAGE_UNIFORM_TEXEL_BUFFER_BIT |
                                            VK_BUFFER_USAGE_TRANSFER_DST_BIT,
                                        gpu::MemoryUse::Device);
    gpu::createTexelView(device, out);
    return out;
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

Kernels::Kernels(const gpu::Device& device, const CndLightingDesc& desc, uint32_t gbuffer)
    : prepareLights(device, spirv::prepare_lights_comp),
      order(device),
      clusters(device, gbuffer),
      shade(device, gbuffer, desc.specularMethods),
      surfaceOverlay(device, spirv::surface_overlay_comp, {{gpu::SPEC_GBUFFER, gbuffer}})
{
}

Lighting::Lighting(const CndDeviceDesc& device, const CndLightingDesc& desc)
    : device_(device),
      desc_(checked(desc)),
      gbuffer_(device_, desc_.gbufferLayout, desc_.gbuffer),
      kernels_(device_, desc_, gbuffer_.code()),
      dfg_(device_),
      ltc_(createLtcBuffer(device_)),
      deviceLights_(device_)
{
    grow(0, {});
}

// Shading a list takes at most this many loop iterations per light: a test, a turn in each of four
// classes (the lanes of a vector may differ), and per block of 63 the exits of its loops.
uint32_t Lighting::lightsPerBatch(uint32_t loopIterations) const
{
    if (device_.maxLoopIterations == UINT32_MAX)
        return UINT32_MAX;
    constexpr uint32_t fixedIterations = 1024; // before and behind the walk
    const uint64_t per32 = 32 * (5 + uint64_t(loopIterations)) + 8;
    const uint64_t lights = uint64_t(device_.maxLoopIterations - fixedIterations) * 32 / per32;
    return uint32_t(std::max<uint64_t>(lights, gpu::TREE_WIDTH));
}

void Lighting::setLights(const CndLightSet& set)
{
    if (set.structSize != sizeof set)
        gpu::failArgument("CndLightSet: structSize is " + std::to_string(set.structSize) +
                          ", this library expects " + std::to_string(sizeof set));
    if (set.count && !set.lights)
        gpu::failArgument("CndLightSet: lights is null but count is " + std::to_string(set.count));
    const CndDeviceLights* const device = set.deviceLights;
    if (device)
        checkDeviceLights(device_, *device);
    const uint64_t total = uint64_t(set.count) + (device ? device->maxCount : 0);
    if (total > maxLights(device_.limits))
        gpu::failUnsupported("CndLightSet: " + std::to_string(total) +
                             " lights are more than the device can take, " +
                             std::to_string(maxLights(device_.limits)));
    for (const double o : set.origin)
        if (!std::isfinite(o))
            gpu::failArgument("CndLightSet: origin must be finite");
    const std::span lights(set.lights, set.count);
    validateLights(lights);
    LightTypeCounts counts = countTypes(lights);
    LightExtent extent = extentOf(lights);
    ReachBoxes reach = reachOf(lights);
    uint32_t deviceRecord = 0; // behind the host's of that type
    if (device) {
        const size_t distant = counts[CND_LIGHT_DIRECTIONAL] + counts[CND_LIGHT_DISTANT_SPHERE];
        extent = extentWith(extent, lights.size() - distant, *device);
        deviceRecord = std::accumulate(counts.begin(), counts.begin() + device->type + 1, 0u);
        counts[device->type] += device->maxCount;
        reach[device->type] = endlessReach(); // nobody here knows where they are
    }
    for (uint32_t type = 0; type < CND_LIGHT_TYPE_COUNT; ++type)
        if (counts[type])
            kernels_.shade.require(type);
    freeRetired();
    std::vector<uint32_t> recordOf = recordsOf(lights, counts);
    std::vector<VkBufferCopy> regions(set.count ? 1 : 0,
                                      {.size = total * sizeof(gpu::LightRecord)});
    std::shared_ptr<gpu::Bindings> bindings;
    if (device)
        bindings = deviceLights_.prepare(*device, total > lightCapacity_);
    if (bindings) // to be replaced
        retired_.push_back({deviceLights_.bindings(), recordings_});
    grow(uint32_t(total), counts); // the last that can fail
    Staging& staging = freeStaging();
    if (device)
        deviceLights_.take(*device, deviceRecord, records_, std::move(bindings));
    else
        deviceLights_.takeNone();
    packLights(lights, recordOf, staging.buffer.as<gpu::LightRecord>());
    recordOf_ = std::move(recordOf);
    staging.regions = std::move(regions);
    pending_ = &staging;
    typeCounts_ = counts;
    lightCount_ = uint32_t(total);
    deviceLightsPending_ = device;
    ++lightSet_;
    std::copy_n(set.origin, 3, origin_);
    extent_ = extent;
    reach_ = reach;
}

LightTypeCounts Lighting::countsInView(const CndCamera& camera) const
{
    LightTypeCounts out = typeCounts_;
    for (uint32_t type = 0; type < CND_LIGHT_TYPE_COUNT; ++type)
        if (out[type] && !reachesView(reach_[type], origin_, camera))
            out[type] = 0;
    return out;
}

uint32_t Lighting::typeOfRecord(uint32_t record) const
{
    uint32_t type = 0;
    for (uint32_t end = typeCounts_[0]; end <= record; end += typeCounts_[type])
        ++type;
    return type;
}

void Lighting::updateLights(uint32_t first, std::span<const CndLight> lights)
{
    if (first > recordOf_.size() || lights.size() > recordOf_.size() - first)
        gpu::failArgument("cndUpdateLights: lights " + std::to_string(first) + " to " +
                          std::to_string(uint64_t(first) + lights.size()) +
                          " are not all of the set, which has " + std::to_string(recordOf_.size()));
    validateLights(lights);
    for (size_t i = 0; i < lights.size(); ++i)
        if (const uint32_t type = typeOfRecord(recordOf_[first + i]); lights[i].type != type)
            gpu::failArgument("lights[" + std::to_string(i) + "]: type is " +
                              std::to_string(lights[i].type) + ", of the light it replaces " +
                              std::to_string(type));
    if (lights.empty())
        return;
    freeRetired();
    Staging& staging = freeStaging();
    std::vector<VkBufferCopy> regions;
    if (pending_)
        regions = staging.regions;
    const VkDeviceSize all = lightCount_ * sizeof(gpu::LightRecord);
    const bool whole = !regions.empty() && regions[0].size == all;
    constexpr VkDeviceSize bytes = sizeof(gpu::LightRecord);
    for (size_t i = 0; i < lights.size() && !whole; ++i) {
        const VkDeviceSize at = recordOf_[first + i] * bytes;
        if (!regions.empty() && regions.back().dstOffset + regions.back().size == at)
            regions.back().size += bytes;
        else
            regions.push_back({at, at, bytes});
    }
    packLights(lights, std::span(recordOf_).subspan(first, lights.size()),
               staging.buffer.as<gpu::LightRecord>());
    widen(reach_, reachOf(lights)); // what was replaced stays in the boxes
    staging.regions = std::move(regions);
    pending_ = &staging;
    ++lightSet_;
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

void Lighting::recordUpload(const gpu::Frame& frame, uint64_t recording) noexcept
{
    if (!pending_)
        return;
    pending_->recording = recording;
    if (lightCount_) {
        if (!pending_->regions.empty())
            device_.CmdCopyBuffer(frame.cmd, pending_->buffer.get(), records_.get(),
                                  uint32_t(pending_->regions.size()), pending_->regions.data());
        if (deviceLightsPending_) {
            deviceLights_.recordReset(frame);
            frame.barrier();
            deviceLights_.record(frame);
        }
        frame.barrier();
        kernels_.order.record(frame, sort_, lightCount_, extent_);
    }
    pending_ = nullptr;
    deviceLightsPending_ = false;
}

void Lighting::recordDeviceCounts(const gpu::Frame& frame,
                                  const gpu::Buffer& counters) const noexcept
{
    if (!deviceLights_.present())
        return;
    static_assert(offsetof(gpu::LightingCounters, rejectedLights) ==
                  offsetof(gpu::LightingCounters, deviceLights) +
                      offsetof(gpu::DeviceLightCounts, rejected));
    const VkBufferCopy copy{.dstOffset = offsetof(gpu::LightingCounters, deviceLights),
                            .size = sizeof(gpu::DeviceLightCounts)};
    device_.CmdCopyBuffer(frame.cmd, deviceLights_.counts().get(), counters.get(), 1, &copy);
}

void Lighting::recordTables(const gpu::Frame& frame, bool directionalAlbedo) noexcept
{
    if (directionalAlbedo)
        dfg_.recordFill(frame);
    if (ltcFilled_)
        return;
    ltcFilled_ = true;
    const std::span<const float> table = tables::ltcTable();
    device_.CmdUpdateBuffer(frame.cmd, ltc_.get(), 0, table.size_bytes(), table.data());
}

void Lighting::grow(uint32_t count, const LightTypeCounts& counts)
{
    if (lightCapacity_ && count <= lightCapacity_) {
        for (View* view : views_)
            view->makeRoom(counts);
        return;
    }
    const uint32_t wanted = std::max({count, minCapacity, lightCapacity_ + lightCapacity_ / 2});
    const uint32_t previous = lightCapacity_;
    const uint32_t capacity = std::min(wanted, maxLights(device_.limits));
    // Everything is allocated before anything is replaced: a failure leaves the old set in place.
    gpu::Buffer records =
        gpu::createBuffer(device_, "light records", capacity * sizeof(gpu::LightRecord), storageUse,
                          gpu::MemoryUse::Device);
    LightOrder::State sort = kernels_.order.createState(capacity, records);
    std::deque<Staging> staging;
    staging.emplace_back(createStaging(capacity)); // what fills the new records
    try {
        lightCapacity_ = capacity;
        for (View* view : views_)
            view->makeRoom(counts);
    } catch (...) {
        lightCapacity_ = previous;
        throw;
    }
    replace(records_, std::move(records));
    replace(sort_, std::move(sort));
    for (Staging& old : staging_)
        replace(old.buffer, gpu::Buffer());
    staging_ = std::move(staging);
    pending_ = nullptr;
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
