// SPDX-License-Identifier: Apache-2.0
// GpuClock converts timestamps of the device to times of the CPU's clock, and measures what a
// timestamp costs.
#pragma once

#include <chrono>

#include "render/frame_stamps.h"
#include "render/vulkan_context.h"

namespace candelabra::app
{

using CpuClock = std::chrono::steady_clock;

inline double msBetween(CpuClock::time_point from, CpuClock::time_point to)
{
    return std::chrono::duration<double, std::milli>(to - from).count();
}

class GpuClock
{
public:
    // Measures the cost of a timestamp, for which the GPU must be idle. `context` must outlive the
    // clock. With `byExtension` false the clock calibrates as on a device without the extension.
    explicit GpuClock(const VulkanContext& context, bool byExtension = true);

    // Reads both clocks at the same time, with VK_EXT_calibrated_timestamps or
    // VK_KHR_calibrated_timestamps if the device has one of them. Otherwise a timestamp is
    // submitted and waited for, which needs an idle GPU, and is assumed to lie in the middle
    // between submission and end. Clocks drift, so a calibration is valid for some seconds.
    void calibrate();
    // Returns the CPU's time at a time of the device's clock, which may have wrapped around since
    // the calibration.
    CpuClock::time_point cpuTime(double deviceMs) const;
    double uncertaintyMs() const { return uncertaintyMs_; } // of the last calibration
    const char* method() const;                             // names what the last calibration used

    // The time that a timestamp adds to a frame: the median of several measurements of timestamps
    // in a row. 0 if the device has no timestamps.
    double stampMs() const { return stampMs_; }

private:
    void calibrateByExtension();
    void calibrateByStamp();
    const VulkanContext& context_;
    FrameStamps stamps_;
    double wrapMs_ = 0;
    double deviceMs_ = 0; // the device's clock at the calibration; cpu_ is the CPU's clock then
    CpuClock::time_point cpu_;
    double uncertaintyMs_ = 0, stampMs_ = 0;
    bool byExtension_;
};

} // namespace candelabra::app
