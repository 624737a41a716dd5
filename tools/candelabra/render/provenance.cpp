// SPDX-License-Identifier: Apache-2.0
#include "render/provenance.h"

#include <ctime>
#include <thread>

#include <sys/utsname.h>

#include <fmt/chrono.h>
#include <fmt/format.h>

#include "candelabra/candelabra.h"
#include "candelabra_commit.h"

namespace candelabra::app
{

namespace
{

// `machine` describes what the numbers were computed on.
Json provenanceOn(const Json& machine, const std::string& commandLine)
{
    const uint32_t version = cndGetVersion();
    const std::time_t now = std::time(nullptr);
    Json out{{"candelabra",
              fmt::format("{}.{}.{}", version >> 22, (version >> 12) & 0x3ff, version & 0xfff)},
             {"commit", commit},
             {"utc", fmt::format("{:%Y-%m-%dT%H:%M:%SZ}", fmt::gmtime(now))}};
    out.update(machine);
    out["commandLine"] = commandLine;
    return out;
}

} // namespace

Json provenance(const DeviceInfo& device, const std::string& commandLine)
{
    return provenanceOn({{"device", device.name},
                         {"deviceType", deviceTypeName(device.type)},
                         {"driver", device.driver},
                         {"vulkan", device.vulkanVersion}},
                        commandLine);
}

Json provenance(const std::string& commandLine)
{
    utsname system{};
    uname(&system);
    return provenanceOn(
        {{"processor", system.machine}, {"hardwareThreads", std::thread::hardware_concurrency()}},
        commandLine);
}

} // namespace candelabra::app
