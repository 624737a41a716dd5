// SPDX-License-Identifier: Apache-2.0
#include <memory>

#include <fmt/format.h>

#include "commands/commands.h"
#include "io/error.h"
#include "io/report.h"
#include "io/table.h"

namespace candelabra::app
{
namespace
{

Json deviceJson(const DeviceInfo& device)
{
    return {{"index", device.index},
            {"name", device.name},
            {"type", deviceTypeName(device.type)},
            {"vulkan", device.vulkanVersion},
            {"driver", device.driver},
            {"usable", device.missing.empty()},
            {"missing", device.missing}};
}

int listDevices(bool json)
{
    const VulkanInstance instance(Validation::Off, Presentation::Headless);
    const std::vector<DeviceInfo> devices = instance.devices();
    if (json) {
        Json list = Json::array();
        for (const DeviceInfo& device : devices)
            list.push_back(deviceJson(device));
        writeJson("-", {{"schema", "candelabra devices 1"}, {"devices", list}});
        return exitOk;
    }
    if (devices.empty())
        chooseDevice(devices, ""); // throws an error that says so
    Table table({"device", "type", "Vulkan", "driver", "lacks"});
    for (const DeviceInfo& device : devices)
        table.add({fmt::format("{} {}", device.index, device.name), deviceTypeName(device.type),
                   device.vulkanVersion, device.driver,
                   device.missing.empty() ? "nothing" : device.missing});
    writeText("-", table.text());
    return exitOk;
}

} // namespace

void addDevicesCommand(CLI::App& app, Run& run)
{
    CLI::App* command =
        app.add_subcommand("devices", "List the Vulkan devices and what each one lacks");
    const auto json = std::make_shared<bool>(false);
    command->add_flag("--json", *json, "print the list as JSON");
    command->footer("Examples:\n"
                    "  candelabra devices\n"
                    "  candelabra devices --json");
    command->callback(
        [&run, json] { run = [json](const ProgramContext&) { return listDevices(*json); }; });
}

} // namespace candelabra::app
