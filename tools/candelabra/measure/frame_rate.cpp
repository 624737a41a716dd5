// SPDX-License-Identifier: Apache-2.0
#include "measure/frame_rate.h"

#include <fmt/format.h>

#include "io/table.h"
#include "render/setting_names.h"

namespace candelabra::app
{
namespace
{

std::string rateText(double framesPerSecond, int digits = 6)
{
    return fmt::format("{:.{}g} frames/s", framesPerSecond, digits);
}

std::string lightsText(uint32_t lights, const FrameCondition& condition)
{
    return counted(lights, condition.addedLights ? "added sphere light" : "sphere light");
}

std::string conditionText(const FrameCost& cost, const FrameCondition& c)
{
    return fmt::format("({}, {}x{}, {:.2g} lights per pixel, {}, on {})", c.scene, c.size.width,
                       c.size.height, cost.lightsPerPixel,
                       c.shadows ? fmt::format("shadows {}", shadowsName(c.shadows)) : "no shadows",
                       c.device);
}

// The parts of the frame, of which `ofMs` are available or used.
std::string partsText(const FrameCost& c, double ofMs)
{
    const char* limit = c.restMs() > std::max(c.lightingMs, c.rasterMs) ? "the rest"
                        : c.lightingMs > c.rasterMs                     ? "lighting"
                                                                        : "the raster pass";
    return fmt::format("lighting {} of {} ms, raster pass {} ms, the rest {} ms; {} is the limit",
                       threeDigits(c.lightingMs), threeDigits(ofMs), threeDigits(c.rasterMs),
                       threeDigits(c.restMs()), limit);
}

} // namespace

std::string costSentence(const FrameCost& cost, const FrameCondition& condition)
{
    const std::string at = "at " + lightsText(cost.lights, condition);
    if (!(cost.ms > 0))
        return fmt::format("{}: the frame rate is unknown, because {} has no timestamps", at,
                           condition.device);
    return fmt::format("{}: {} {}; {}", at, rateText(cost.framesPerSecond(), 3),
                       conditionText(cost, condition), partsText(cost, cost.ms));
}

std::string searchSentence(double framesPerSecond, const LightSearch& search, const FrameCost& cost,
                           const FrameCondition& condition, const std::string& fewest)
{
    const double ms = 1000 / framesPerSecond;
    const std::string where = conditionText(cost, condition);
    if (!search.lights) {
        const std::string none = cost.lights == 1
                                     ? "not even one light"
                                     : "not even " + lightsText(cost.lights, condition);
        const std::string why = cost.rasterMs > ms
                                    ? fmt::format("the raster pass alone takes {} ms of {}",
                                                  threeDigits(cost.rasterMs), threeDigits(ms))
                                    : partsText(cost, ms);
        return fmt::format("{} at {} {}: {}{}", none, rateText(framesPerSecond), where, why,
                           fewest.empty() ? "" : "; fewer were not tried: " + fewest);
    }
    const std::string lights = lightsText(cost.lights, condition);
    if (search.isMost)
        return fmt::format("{}, as many as there can be on this device, at {}, more than {:g} {}: "
                           "{}",
                           lights, rateText(cost.framesPerSecond(), 3), framesPerSecond, where,
                           partsText(cost, ms));
    std::string more;
    if (const auto n = lightsWithin(search.tried, 1.1 * ms))
        more = fmt::format("; a tenth more time would carry about {}", grouped(roundedDown(*n, 2)));
    return fmt::format("{} at {} {}: {}{}", lights, rateText(framesPerSecond), where,
                       partsText(cost, ms), more);
}

} // namespace candelabra::app
