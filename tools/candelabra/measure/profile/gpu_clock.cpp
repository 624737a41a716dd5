// SPDX-License-Identifier: Apache-2.0
#include "measure/profile/gpu_clock.h"

#include <cmath>
#include <vector>

#include "io/statistics.h"
#include "render/check.h"

namespace candelabra::app
{
namespace
{

// The closest of so many calibrations counts, because the CPU may be interrupted during one.
constexpr int calibrations = 5;

constexpr uint32_t stampsInARow = 100;

} // namespace

GpuClock::GpuClock(const VulkanContext& context, bool byExtension)
    : context_(context),
      stamps_(context.device(), context.timestampValidBits(), 1, stampsInARow),
      wrapMs_(std::ldexp(double(context.device().limits.timestampPeriod) * 1e-6,
                         int(context.timestampValidBits()))),
      byExtension_(byExtension && context.getCalibratedTimestamps())
{
    constexpr int rounds = 9;
    std::vector<double> each;
    for (int round = 0; round < rounds; ++round) {
        context.submitAndWait([&](VkCommandBuffer cmd) {
            stamps_.begin(cmd, 0);
            for (uint32_t i = 0; i < stampsInARow; ++i)
                stamps_.stamp(cmd, 0);
        });
        const FrameStamps::Times times = stamps_.read(0);
        each.push_back(times.endsMs.empty() ? 0 : times.endsMs.back() / stampsInARow);
    }
    stampMs_ = medianOf(each);
    calibrate();
}

CpuClock::time_point GpuClock::cpuTime(double deviceMs) const
{
    double elapsed = deviceMs - deviceMs_;
    elapsed -= wrapMs_ * std::round(elapsed / wrapMs_);
    const std::chrono::duration<double, std::milli> since(elapsed);
    return cpu_ + std::chrono::duration_cast<CpuClock::duration>(since);
}

const char* GpuClock::method() const
{
    return byExtension_ ? context_.calibratedTimestampsExtension()
                        : "a stamp, in the middle of its submission and the end of waiting for it";
}

void GpuClock::calibrate()
{
    if (byExtension_)
        calibrateByExtension();
    else
        calibrateByStamp();
}

void GpuClock::calibrateByExtension()
{
    // std::chrono::steady_clock is CLOCK_MONOTONIC.
    const VkCalibratedTimestampInfoEXT infos[2]{
        {.sType = VK_STRUCTURE_TYPE_CALIBRATED_TIMESTAMP_INFO_EXT,
         .pNext = nullptr,
         .timeDomain = VK_TIME_DOMAIN_DEVICE_EXT},
        {.sType = VK_STRUCTURE_TYPE_CALIBRATED_TIMESTAMP_INFO_EXT,
         .pNext = nullptr,
         .timeDomain = VK_TIME_DOMAIN_CLOCK_MONOTONIC_EXT}};
    uint64_t best = ~uint64_t(0);
    for (int i = 0; i < calibrations; ++i) {
        uint64_t times[2], deviation = 0;
        check(
            context_.getCalibratedTimestamps()(context_.desc().device, 2, infos, times, &deviation),
            "asking for the time");
        if (deviation >= best)
            continue;
        best = deviation;
        deviceMs_ = double(times[0]) * double(context_.device().limits.timestampPeriod) * 1e-6;
        cpu_ = CpuClock::time_point(std::chrono::nanoseconds(times[1]));
        uncertaintyMs_ = double(deviation) * 1e-6;
    }
}

void GpuClock::calibrateByStamp()
{
    for (int i = 0; i < calibrations; ++i) {
        const CpuClock::time_point before = CpuClock::now();
        context_.submitAndWait([&](VkCommandBuffer cmd) { stamps_.begin(cmd, 0); });
        const CpuClock::time_point after = CpuClock::now();
        const double uncertainty = msBetween(before, after) / 2;
        if (i && uncertainty >= uncertaintyMs_)
            continue;
        uncertaintyMs_ = uncertainty;
        deviceMs_ = stamps_.read(0).startMs;
        cpu_ = before + (after - before) / 2;
    }
}

} // namespace candelabra::app
