// SPDX-License-Identifier: Apache-2.0
#include "exposure/exposure_module.h"

#include <algorithm>
#include <cmath>
#include <cstddef>
#include <string>

#include "candelabra_shaders.h"
#include "gpu/display_format.h"
#include "gpu/image_format.h"
#include "gpu/recordings.h"

namespace candelabra::exposure
{
namespace
{

using gpu::Binding;
using gpu::divideUp;

static_assert(gpu::HISTOGRAM_BINS == CND_HISTOGRAM_BINS);
static_assert(gpu::METERING_CENTRE_WEIGHTED == CND_METERING_CENTRE_WEIGHTED);
static_assert(gpu::METERING_MASK == CND_METERING_MASK);
static_assert(gpu::TONEMAP_REINHARD == CND_TONEMAP_REINHARD);
static_assert(gpu::TONEMAP_ACES == CND_TONEMAP_ACES);
static_assert(gpu::TONEMAP_PBR_NEUTRAL == CND_TONEMAP_PBR_NEUTRAL);
static_assert(gpu::TONEMAP_AGX == CND_TONEMAP_AGX);

constexpr VkDeviceSize maskBytes = 64 * 64 * sizeof(uint32_t); // the largest mask: 64 x 64 weights

struct Readback {
    gpu::HistogramData data;
    gpu::ExposureState state;
    uint32_t marker; // written last: the frame is done
};

// Returns a number that no other Exposure of this process has.
uint32_t nextOwner() noexcept
{
    static std::atomic<uint32_t> next{gpu::EXPOSURE_FIRST_OWNER};
    return next++;
}

CndExposureDesc checkedDesc(const gpu::Device& device, CndExposureDesc desc)
{
    if (desc.structSize != sizeof desc)
        gpu::failArgument("CndExposureDesc: structSize is " + std::to_string(desc.structSize) +
                          ", this library expects " + std::to_string(sizeof desc));
    if (desc.framesInFlight < 1 || desc.framesInFlight > 8)
        gpu::failArgument("CndExposureDesc: framesInFlight must be 1..8, is " +
                          std::to_string(desc.framesInFlight));
    desc.displayFormat =
        gpu::checkedDisplayFormat(device, "CndExposureDesc: displayFormat", desc.displayFormat);
    return desc;
}

} // namespace

Exposure::Exposure(const CndDeviceDesc& device, const CndExposureDesc& desc)
    : device_(device, gpu::exposureModule),
      desc_(checkedDesc(device_, desc)),
      timer_(device_, "exposure", desc_.framesInFlight, desc_.timestamps),
      adapt_(device_, spirv::adapt_exposure_comp),
      slots_(desc.framesInFlight),
      owner_(nextOwner())
{
    for (uint32_t metering = 0; metering < histogram_.size(); ++metering)
        histogram_[metering] = gpu::Kernel<gpu::LuminanceHistogramParams>(
            device_, spirv::luminance_histogram_comp, {{gpu::SPEC_METERING, metering}});
    const gpu::FormattedSpirv toneMap(spirv::tone_map_comp, gpu::TONE_MAP_DISPLAY,
                                      desc_.displayFormat, gpu::StorageUse::Write);
    for (uint32_t curve = 0; curve < CND_TONEMAP_COUNT; ++curve)
        toneMap_[curve] = gpu::Kernel<gpu::ToneMapParams>(
            device_, toneMap,
            {{gpu::SPEC_TONE_MAP, curve},
             {gpu::SPEC_DISPLAY_STEPS, gpu::lastDisplayStep(desc_.displayFormat)}});
    const uint32_t slots = desc.framesInFlight;
    sets_ = {histogram_[0].createBindings(slots), adapt_.createBindings(slots),
             toneMap_[0].createBindings(slots)};
    constexpr VkBufferUsageFlags use = VK_BUFFER_USAGE_STORAGE_BUFFER_BIT |
                                       VK_BUFFER_USAGE_TRANSFER_SRC_BIT |
                                       VK_BUFFER_USAGE_TRANSFER_DST_BIT;
    data_ = gpu::createBuffer(device_, "luminance histogram", sizeof(gpu::HistogramData), use,
                              gpu::MemoryUse::Scratch);
    state_ = gpu::createBuffer(device_, "exposure state", sizeof(gpu::ExposureState), use,
                               gpu::MemoryUse::Device);
    mask_ = gpu::createBuffer(device_, "metering mask", maskBytes,
                              VK_BUFFER_USAGE_STORAGE_BUFFER_BIT, gpu::MemoryUse::Upload);
    for (uint32_t i = 0; i < slots; ++i)
        readback_.push_back(gpu::createBuffer(device_, "exposure statistics", sizeof(Readback),
                                              VK_BUFFER_USAGE_TRANSFER_DST_BIT,
                                              gpu::MemoryUse::Readback));
    for (const gpu::Buffer& buffer : readback_)
        buffer.as<Readback>()[0].marker = 0;
}

void Exposure::setMask(const uint8_t* weights, uint32_t width, uint32_t height)
{
    validateMask(weights, width, height);
    std::copy_n(weights, width * height, mask_.as<uint32_t>().begin());
    maskSize_ = {width, height};
}

void Exposure::validate(const CndExposureFrame& frame) const
{
    if (frame.structSize != sizeof frame)
        gpu::failArgument("CndExposureFrame: structSize is " + std::to_string(frame.structSize) +
                          ", this library expects " + std::to_string(sizeof frame));
    if (frame.frameSlot >= slots_.size())
        gpu::failArgument("CndExposureFrame: frameSlot is " + std::to_string(frame.frameSlot) +
                          ", framesInFlight is " + std::to_string(slots_.size()));
    gpu::requireRect("CndExposureFrame", frame.x, frame.y, frame.width, frame.height);
    if (!frame.radiance)
        gpu::failArgument("CndExposureFrame: radiance is null");
    if (!gpu::canBeRead(frame.radianceImageLayout))
        gpu::failArgument("CndExposureFrame: radianceImageLayout must be SHADER_READ_ONLY_OPTIMAL, "
                          "READ_ONLY_OPTIMAL or GENERAL");
    if (!(frame.deltaTime >= 0 && std::isfinite(frame.deltaTime)))
        gpu::failArgument("CndExposureFrame: deltaTime must be finite and >= 0");
    validateSettings(frame.settings);
    if (frame.settings.metering == CND_METERING_MASK && !frame.settings.manual && !maskSize_.x)
        gpu::failArgument("CndExposureFrame: metering by mask without cndSetExposureMask");
}

void Exposure::writeBindings(const CndExposureFrame& frame) const
{
    using namespace gpu;
    const uint32_t slot = frame.frameSlot;
    const SampledImage radiance = SampledImage::of(frame.radiance, frame.radianceImageLayout);
    const SampledImage metered =
        frame.meteredRadiance ? SampledImage::of(frame.meteredRadiance, frame.radianceImageLayout)
                              : radiance;
    if (!frame.settings.manual)
        sets_.histogram.write(slot, {Binding::sampled(HISTOGRAM_RADIANCE, metered),
                                     Binding::of(HISTOGRAM_MASK, mask_),
                                     Binding::of(HISTOGRAM_DATA, data_)});
    sets_.adapt.write(slot, {Binding::of(ADAPT_DATA, data_), Binding::of(ADAPT_STATE, state_)});
    if (frame.display)
        sets_.toneMap.write(slot, {Binding::sampled(TONE_MAP_RADIANCE, radiance),
                                   Binding::of(TONE_MAP_STATE, state_),
                                   Binding::storage(TONE_MAP_DISPLAY, frame.display)});
}

void Exposure::record(VkCommandBuffer cmd, const CndExposureFrame& frame)
{
    validate(frame);
    writeBindings(frame);
    if (!++recordings_) // 0 stands for an unused slot
        ++recordings_;
    slots_[frame.frameSlot] = {recordings_, frame.settings.manual == VK_TRUE,
                               frame.display != VK_NULL_HANDLE};

    const gpu::Frame f{device_, cmd, timer_, frame.frameSlot};
    device_.beginLabel(cmd, "candelabra exposure");
    timer_.begin(cmd, frame.frameSlot);
    f.barrier(); // waits for the previous frame, which uses the same buffers
    device_.CmdFillBuffer(cmd, data_.get(), 0, VK_WHOLE_SIZE, 0);
    f.barrier();
    if (!frame.settings.manual) {
        recordHistogram(f, frame);
        f.barrier();
    }
    recordAdaptation(f, frame);
    f.barrier();
    if (frame.display)
        recordToneMap(f, frame);
    recordReadback(f);
    device_.endLabel(cmd);
}

void Exposure::recordHistogram(const gpu::Frame& f, const CndExposureFrame& frame) const noexcept
{
    histogram_[frame.settings.metering].dispatch(f, sets_.histogram.set(f.slot),
                                                 {.size = {frame.width, frame.height},
                                                  .maskSize = maskSize_,
                                                  .firstTexel = {frame.x, frame.y}},
                                                 divideUp(frame.width, gpu::HISTOGRAM_COLUMNS),
                                                 divideUp(frame.height, gpu::HISTOGRAM_ROWS));
}

void Exposure::recordAdaptation(const gpu::Frame& f, const CndExposureFrame& frame) const noexcept
{
    gpu::AdaptExposureParams params = adaptParams(frame.settings, frame.deltaTime, frame.reset);
    params.owner = owner_;
    adapt_.dispatch(f, sets_.adapt.set(f.slot), params, 1);
}

void Exposure::recordToneMap(const gpu::Frame& f, const CndExposureFrame& frame) const noexcept
{
    toneMap_[frame.settings.toneMap].dispatch(f, sets_.toneMap.set(f.slot),
                                              {.size = {frame.width, frame.height},
                                               .dither = frame.settings.dither ? 1u : 0u,
                                               .ditherSeed = frame.ditherSeed,
                                               .firstTexel = {frame.x, frame.y}},
                                              divideUp(frame.width, gpu::TONE_MAP_GROUP),
                                              divideUp(frame.height, gpu::TONE_MAP_ROWS));
}

void Exposure::recordReadback(const gpu::Frame& f) const noexcept
{
    const VkBuffer target = readback_[f.slot].get();
    const VkBufferCopy data{.size = sizeof(gpu::HistogramData)};
    device_.CmdCopyBuffer(f.cmd, data_.get(), target, 1, &data);
    const VkBufferCopy state{.dstOffset = offsetof(Readback, state),
                             .size = sizeof(gpu::ExposureState)};
    device_.CmdCopyBuffer(f.cmd, state_.get(), target, 1, &state);
    f.barrier(); // the marker may be written only after all the rest
    device_.CmdFillBuffer(f.cmd, target, offsetof(Readback, marker), sizeof(uint32_t),
                          slots_[f.slot].marker);
    f.hostBarrier();
}

CndResult Exposure::stats(uint32_t slot, CndExposureStats& out) const noexcept
{
    if (slot >= slots_.size() || !slots_[slot].marker || out.structSize != sizeof out)
        return CND_ERROR_INVALID_ARGUMENT;
    Readback& read = readback_[slot].as<Readback>()[0];
    if (!gpu::hasArrived(read.marker, slots_[slot].marker))
        return CND_NOT_READY;
    out.targetEv100 = read.state.targetEv100;
    out.adaptedEv100 = read.state.adaptedEv100;
    out.exposure = read.state.exposure;
    out.invalidPixels = read.data.invalidPixels;
    out.passCount = 3;
    out.passes[0] = {"luminance_histogram", slots_[slot].manual ? "manual exposure" : nullptr};
    out.passes[1] = {"adapt_exposure", nullptr};
    out.passes[2] = {"tone_map", slots_[slot].toneMapped ? nullptr : "no display image"};
    std::copy_n(read.data.counts, CND_HISTOGRAM_BINS, out.histogram);
    return timer_.read(slot, out.kernelTimes, out.kernelTimeCount);
}

} // namespace candelabra::exposure
