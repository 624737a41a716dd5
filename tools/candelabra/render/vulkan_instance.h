// SPDX-License-Identifier: Apache-2.0
// The Vulkan instance, the messages of the validation layers, and the list of devices, which says
// what each device lacks.
#pragma once

#include <memory>
#include <mutex>
#include <string>
#include <vector>

#include <vulkan/vulkan.h>

namespace candelabra::app
{

enum class Validation {
    Off,
    On, // core and synchronisation validation
};

enum class Presentation {
    Headless, // no display is used
    Window,   // the instance and the device can present to GLFW windows
};

struct ValidationMessage {
    std::string id; // e.g. "VUID-vkCmdDraw-None-02699"
    std::string text;
};

// Collects warnings and errors of the validation layers, which may come from any thread.
class MessageLog
{
public:
    void add(ValidationMessage message);
    // Returns all messages since the last call.
    std::vector<ValidationMessage> take();

private:
    std::mutex mutex_;
    std::vector<ValidationMessage> messages_;
};

struct DeviceInfo {
    uint32_t index = 0;
    VkPhysicalDevice handle = VK_NULL_HANDLE;
    std::string name;
    VkPhysicalDeviceType type = VK_PHYSICAL_DEVICE_TYPE_OTHER;
    std::string vulkanVersion; // "1.3.230"
    std::string driver;        // driver name and version as the driver states them
    std::string missing;       // what candelabra needs and the device lacks; empty: it is usable
};

// The largest number of lights whose records fit into one storage buffer of the device. The
// lighting module itself refuses more, but only after a scene with so many lights has been made.
uint32_t maxLightsOf(const DeviceInfo& device);

// "discrete GPU", "integrated GPU", "virtual GPU", "CPU" or "other".
const char* deviceTypeName(VkPhysicalDeviceType type);

class VulkanInstance
{
public:
    // `apiVersion`: VkApplicationInfo::apiVersion. Throws RunError if there is no Vulkan loader, or
    // no validation layer or display where one is asked for.
    VulkanInstance(Validation validation, Presentation presentation,
                   uint32_t apiVersion = VK_API_VERSION_1_3);
    ~VulkanInstance();
    VulkanInstance(const VulkanInstance&) = delete;
    VulkanInstance& operator=(const VulkanInstance&) = delete;

    VkInstance get() const { return instance_; }
    Validation validation() const { return validation_; }
    Presentation presentation() const { return presentation_; }
    bool debugUtils() const { return debugUtils_; }
    MessageLog& messages() const { return *messages_; }

    // Returns the devices in the loader's order. Throws gpu::Failure if they cannot be listed.
    std::vector<DeviceInfo> devices() const;

private:
    VkInstance instance_ = VK_NULL_HANDLE;
    VkDebugUtilsMessengerEXT messenger_ = VK_NULL_HANDLE;
    Validation validation_;
    Presentation presentation_;
    bool debugUtils_ = false;
    std::unique_ptr<MessageLog> messages_ = std::make_unique<MessageLog>();
};

// Chooses the device to use. `wanted` is an index, or a part of the device's name in upper or lower
// case. If it is empty, the device is the first that lacks nothing: a discrete GPU, else an
// integrated one, else a virtual one, else a CPU. Throws UsageError if `wanted` names no device or
// one that lacks something, and RunError if no device is usable.
DeviceInfo chooseDevice(const std::vector<DeviceInfo>& devices, const std::string& wanted);

} // namespace candelabra::app
