// SPDX-License-Identifier: Apache-2.0
#include "lighting/lighting.h"

#include <algorithm>
#include <cmath>

#include "candelabra_shaders.h"
#include "tables/ltc_table.h"

namespace candelabra::lighting
{
namespace
{

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
    if (desc.influenceByError && desc.hostKernels.count)
        gpu::failArgument("CndLightingDesc: influenceByError cannot measure with hostKernels");
    if (desc.materialClasses & ~uint32_t(CND_MATERIAL_DIFFUSE_ONLY | CND_MATERIAL_SPECULAR_ONLY))
        gpu::failArgument("CndLightingDesc: materialClasses has bits beyond CndMaterialClass");
    if (!desc.specularMethods)
        desc.specularMethods = 1u << CND_SPECULAR_CONIC;
    if (desc.lightTypes >> CND_LIGHT_TYPE_COUNT)
        gpu::failArgument("CndLightingDesc: lightTypes has bits beyond the last CndLightType");
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

Kernels::Kernels(const gpu::Device& device, const HostKernels& host, const CndLightingDesc& desc,
                 uint32_t gbuffer, bool withIds)
    : prepareLights(device, spirv::prepare_lights_comp, {{gpu::PREPARE_LIGHTS_WITH_IDS, withIds}}),
      order(device),
      clusters(device, host, gbuffer, tileClassesOf(desc)),
      shade(device, host, gbuffer, desc.specularMethods, tileClassesOf(desc),
            desc.influenceByError),
      influence(desc.influenceByError ? InfluenceKernels(device) : InfluenceKernels()),
      surfaceOverlay(device, host.of(spirv::surface_overlay_comp), {{gpu::SPEC_GBUFFER, gbuffer}},
                     host.setLayout())
{
}

Lighting::Lighting(const CndDeviceDesc& device, const CndLightingDesc& desc)
    : device_(device),
      desc_(checked(desc)),
      gbuffer_(device_, desc_.gbufferLayout, desc_.gbuffer),
      hostKernels_(desc_.hostKernels, desc_.gbufferLayout),
      kernels_(device_, hostKernels_, desc_, gbuffer_.code(), readsIds()),
      dfg_(device_),
      ltc_(createLtcBuffer(device_)),
      forwardLayout_(createForwardLayout(device_, desc_.forwardStages)),
      deviceLights_(device_)
{
    requireRoom("CndLightingDesc: lightCapacity", desc_.lightCapacity);
    for (uint32_t type = 0; type < CND_LIGHT_TYPE_COUNT; ++type)
        if (withReserved({})[type])
            kernels_.shade.require(type);
    grow(0, {}, false);
    if (const uint32_t batch = lightsPerBatch(0); batch != UINT32_MAX)
        device_.say(CND_MESSAGE_INFO,
                    "cndCreateLighting: the device ends loops after %u iterations: lists of more "
                    "than %u lights are shaded in parts, slower",
                    device_.maxLoopIterations, batch);
    if (!lightsAsTexels(device_))
        device_.say(CND_MESSAGE_INFO,
                    "cndCreateLighting: maxTexelBufferElements is %u: lights are read from storage "
                    "buffers, which may be slower",
                    device_.limits.maxTexelBufferElements);
}

LightTypeCounts Lighting::withReserved(LightTypeCounts types) const noexcept
{
    for (uint32_t type = 0; type < CND_LIGHT_TYPE_COUNT; ++type)
        types[type] += desc_.lightTypes >> type & 1;
    return types;
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

VkDescriptorSetLayout Lighting::forwardLayout() const
{
    if (!forwardLayout_)
        gpu::failArgument("cndGetForwardSetLayout: CndLightingDesc::forwardStages was 0");
    return forwardLayout_.get();
}

void Lighting::requireRoom(const char* what, uint64_t count) const
{
    if (count > maxLights(device_.limits))
        gpu::failUnsupported(std::string(what) + ": " + std::to_string(count) +
                             " lights are more than the device can take, " +
                             std::to_string(maxLights(device_.limits)));
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
    requireRoom("CndLightSet", total);
    for (const double o : set.origin)
        if (!std::isfinite(o))
            gpu::failArgument("CndLightSet: origin must be finite");
    const std::span lights(set.lights, set.count);
    validateLights(lights);
    LightTypeCounts counts = countTypes(lights);
    ReachBoxes reach = reachOf(lights);
    if (device) {
        counts[device->type] += device->maxCount;
        ReachBox& box = reach[device->type]; // nobody here knows where they are
        box = endlessReach(box.layers | layersOf(device->layers));
    }
    requirePipelines(counts);
    freeRetired();
    lights_.reserveSet(set.count);
    std::shared_ptr<gpu::Bindings> bindings;
    if (device)
        bindings = deviceLights_.prepare(*device, total > lightCapacity_);
    if (bindings) // to be replaced
        retired_.push_back({deviceLights_.bindings(), recordings_});
    grow(uint32_t(total), counts, false);
    Staging& staging = freeStaging(); // the last that can fail
    if (device)
        deviceLights_.take(*device, store_.records, std::move(bindings));
    else
        deviceLights_.takeNone();
    firstRecord_ = device ? device->maxCount : 0;
    packLights(lights, hostRecords(staging));
    lights_.set(lights);
    pending_ = &staging;
    carriedFrom_ = VK_NULL_HANDLE;
    onDevice_ = 0;
    typeCounts_ = counts;
    lightCount_ = uint32_t(total);
    deviceLightsPending_ = device;
    ++lightSet_;
    std::copy_n(set.origin, 3, origin_);
    extent_ = currentExtent();
    editsSinceExtent_ = 0;
    reach_ = reach;
}

LightTypeCounts Lighting::countsInView(const CndCamera& camera, uint32_t layers) const
{
    LightTypeCounts out = countsInLayers(layers);
    for (uint32_t type = 0; type < CND_LIGHT_TYPE_COUNT; ++type)
        if (out[type] && !reachesView(reach_[type], origin_, camera))
            out[type] = 0;
    return out;
}

LightTypeCounts Lighting::countsInLayers(uint32_t layers) const
{
    LightTypeCounts out = typeCounts_;
    for (uint32_t type = 0; type < CND_LIGHT_TYPE_COUNT; ++type)
        if (!(reach_[type].layers & layers))
            out[type] = 0;
    return out;
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
