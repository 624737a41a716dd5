// SPDX-License-Identifier: Apache-2.0
// The exposure module, which candelabra/exposure.h declares: histogram, adaptation and tone
// mapping of one view.
#pragma once

#include <array>
#include <vector>

#include "gpu/kernel.h"
#include "shared/exposure_data.h"

namespace candelabra::exposure
{

// Both throw gpu::Failure naming the field that is out of its documented range.
void validateSettings(const CndExposureSettings& settings);
void validateMask(const uint8_t* weights, uint32_t width, uint32_t height);
// Converts settings and time step, both valid, into kernel parameters; `owner` is left 0.
gpu::AdaptExposureParams adaptParams(const CndExposureSettings& settings, float deltaTime,
                                     bool reset) noexcept;

class Exposure
{
public:
    Exposure(const CndDeviceDesc& device, const CndExposureDesc& desc);
    Exposure(const Exposure&) = delete; // not copied or moved: members point to device_
    Exposure& operator=(const Exposure&) = delete;

    void setMask(const uint8_t* weights, uint32_t width, uint32_t height);
    // Throws gpu::Failure on arguments out of range; once recording starts nothing can fail.
    void record(VkCommandBuffer cmd, const CndExposureFrame& frame);
    CndResult stats(uint32_t slot, CndExposureStats& stats) const noexcept;
    const gpu::Device& device() const { return device_; }

private:
    void validate(const CndExposureFrame& frame) const;
    void writeBindings(const CndExposureFrame& frame) const;
    void recordHistogram(const gpu::Frame& f, const CndExposureFrame& frame) const noexcept;
    void recordAdaptation(const gpu::Frame& f, const CndExposureFrame& frame) const noexcept;
    void recordToneMap(const gpu::Frame& f, const CndExposureFrame& frame) const noexcept;
    void recordReadback(const gpu::Frame& f) const noexcept;

    struct Sets {
        gpu::Bindings histogram, adapt, toneMap;
    };

    gpu::Device device_;
    CndExposureDesc desc_;
    gpu::Timer timer_;
    std::array<gpu::Kernel<gpu::LuminanceHistogramParams>, CND_METERING_MASK + 1>
        histogram_; // by CndMetering
    gpu::Kernel<gpu::AdaptExposureParams> adapt_;
    gpu::Kernel<gpu::ToneMapParams> toneMap_[CND_TONEMAP_COUNT];
    Sets sets_;
    gpu::Buffer data_, state_, mask_;
    std::vector<gpu::Buffer> readback_; // per frame slot
    struct Slot {
        uint32_t marker = 0; // value that the GPU writes when the frame is done; 0: slot not used
                             // yet
        bool manual = false, toneMapped = false;
    };
    std::vector<Slot> slots_;
    glm::uvec2 maskSize_{0};
    uint32_t recordings_ = 0;
    uint32_t owner_; // marks this object's history in state_, see EXPOSURE_FIRST_OWNER
};

} // namespace candelabra::exposure
