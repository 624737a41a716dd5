// SPDX-License-Identifier: Apache-2.0
// Vulkan instance, validation messages, and the list of devices with what each lacks.
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
    Headless, // never touches a display
    Window,   // instance and device can present to GLFW windows
};

struct ValidationMessage {
    std::string id; // e.g. "VUID-vkCmdDraw-None-02699"
    std::string text;
};

// Warnings and errors of the validation layers, from any thread.
class MessageLog
{
public:
    void add(ValidationMessage message);
    // All messages since the last call.
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
    std::string missing;       // what candelabra needs and the device lacks; empty: usable
};

// Lights that the device has room for: their records share one storage buffer. The lighting module
// refuses more by itself, but only after a scene with that many has been made.
uint32_t maxLightsOf(const DeviceInfo& device);

// "discrete GPU", "integrated GPU", "virtual GPU", "CPU" or "other".
const char* deviceTypeName(VkPhysicalDeviceType type);

class VulkanInstance
{
public:
    // Throws RunError without a Vulkan loader or, when asked for, validation layer or display.
    VulkanInstance(Validation validation, Presentation presentation);
    ~VulkanInstance();
    VulkanInstance(const VulkanInstance&) = delete;
    VulkanInstance& operator=(const VulkanInstance&) = delete;

    VkInstance get() const { return instance_; }
    Validation validation() const { return validation_; }
    Presentation presentation() const { return presentation_; }
    bool debugUtils() const { return debugUtils_; }
    MessageLog& messages() const { return *messages_; }

    // In the loader's order; throws gpu::Failure when they cannot be listed.
    std::vector<DeviceInfo> devices() const;

private:
    VkInstance instance_ = VK_NULL_HANDLE;
    VkDebugUtilsMessengerEXT messenger_ = VK_NULL_HANDLE;
    Validation validation_;
    Presentation presentation_;
    bool debugUtils_ = false;
    std::unique_ptr<MessageLog> messages_ = std::make_unique<MessageLog>();
};

// The device to use. `wanted` is empty (discrete, then integrated, virtual, CPU; among those that
// lack nothing), an index, or a part of the name in any case. Throws UsageError when `wanted` names
// no device or one that lacks something, RunError when no device will do.
DeviceInfo chooseDevice(const std::vector<DeviceInfo>& devices, const std::string& wanted);

} // namespace candelabra::app
