// SPDX-License-Identifier: Apache-2.0
// GpuClock: the device's timestamps on the clock of the CPU, and what a timestamp costs.
#pragma once

#include <chrono>
#include <string>

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
    // `context` must outlive it. Measures the cost of a stamp, for which the GPU must be idle.
    // `byExtension` false: calibrates as where the device has none.
    explicit GpuClock(const VulkanContext& context, bool byExtension = true);

    // Asks both clocks at once, with VK_KHR_calibrated_timestamps or VK_EXT_calibrated_timestamps
    // where the device has it. Elsewhere a stamp is submitted and waited for, and taken to be in
    // the middle of the two: the GPU must be idle. Holds for the seconds around; clocks drift.
    void calibrate();
    // Of a time on the device's clock, which may have wrapped since.
    CpuClock::time_point cpuTime(double deviceMs) const;
    double uncertaintyMs() const { return uncertaintyMs_; } // of the last calibration
    const char* method() const;

    // What a stamp adds to a frame, median of several measurements, back to back; 0 without
    // timestamps.
    double stampMs() const { return stampMs_; }

private:
    void calibrateByExtension();
    void calibrateByStamp();
    const VulkanContext& context_;
    FrameStamps stamps_;
    double wrapMs_ = 0;
    double deviceMs_ = 0; // at calibration, and what the CPU's clock said then
    CpuClock::time_point cpu_;
    double uncertaintyMs_ = 0, stampMs_ = 0;
    bool byExtension_;
};

} // namespace candelabra::app
