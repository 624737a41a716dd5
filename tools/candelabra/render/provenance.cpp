// SPDX-License-Identifier: Apache-2.0
#include "render/provenance.h"

#include <ctime>

#include <fmt/chrono.h>
#include <fmt/format.h>

#include "candelabra/candelabra.h"
#include "candelabra_commit.h"

namespace candelabra::app
{

Json provenance(const DeviceInfo& device, const std::string& commandLine)
{
    const uint32_t version = cndGetVersion();
    const std::time_t now = std::time(nullptr);
    return {{"candelabra",
             fmt::format("{}.{}.{}", version >> 22, (version >> 12) & 0x3ff, version & 0xfff)},
            {"commit", commit},
            {"utc", fmt::format("{:%Y-%m-%dT%H:%M:%SZ}", fmt::gmtime(now))},
            {"device", device.name},
            {"deviceType", deviceTypeName(device.type)},
            {"driver", device.driver},
            {"vulkan", device.vulkanVersion},
            {"commandLine", commandLine}};
}

} // namespace candelabra::app
