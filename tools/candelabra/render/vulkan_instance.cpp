// SPDX-License-Identifier: Apache-2.0
#include "render/vulkan_instance.h"

#include <algorithm>
#include <cctype>
#include <cstring>
#include <iterator>
#include <utility>

#define GLFW_INCLUDE_NONE
#include <GLFW/glfw3.h>

#include "gpu/failure.h"
#include "gpu/requirements.h"
#include "io/choice.h"
#include "io/error.h"
#include "io/table.h"
#include "render/check.h"

namespace candelabra::app
{
namespace
{

constexpr const char* noDevice = "there is no Vulkan device (Debian package mesa-vulkan-drivers "
                                 "has a software one)";
constexpr const char* validationLayer = "VK_LAYER_KHRONOS_validation";

VKAPI_ATTR VkBool32 VKAPI_CALL onMessage(VkDebugUtilsMessageSeverityFlagBitsEXT,
                                         VkDebugUtilsMessageTypeFlagsEXT,
                                         const VkDebugUtilsMessengerCallbackDataEXT* data,
                                         void* user)
{
    static_cast<MessageLog*>(user)->add(
        {data->pMessageIdName ? data->pMessageIdName : "", data->pMessage ? data->pMessage : ""});
    return VK_FALSE;
}

VkDebugUtilsMessengerCreateInfoEXT messengerInfo(MessageLog& log)
{
    return {.sType = VK_STRUCTURE_TYPE_DEBUG_UTILS_MESSENGER_CREATE_INFO_EXT,
            .messageSeverity = VK_DEBUG_UTILS_MESSAGE_SEVERITY_WARNING_BIT_EXT |
                               VK_DEBUG_UTILS_MESSAGE_SEVERITY_ERROR_BIT_EXT,
            // GENERAL is left out: such messages are the loader's own remarks about the drivers of
            // the machine.
            .messageType = VK_DEBUG_UTILS_MESSAGE_TYPE_VALIDATION_BIT_EXT |
                           VK_DEBUG_UTILS_MESSAGE_TYPE_PERFORMANCE_BIT_EXT,
            .pfnUserCallback = onMessage,
            .pUserData = &log};
}

bool hasLayer(const char* wanted)
{
    uint32_t count = 0;
    vkEnumerateInstanceLayerProperties(&count, nullptr);
    std::vector<VkLayerProperties> layers(count);
    vkEnumerateInstanceLayerProperties(&count, layers.data());
    return std::ranges::any_of(layers, [&](const VkLayerProperties& layer) {
        return std::strcmp(layer.layerName, wanted) == 0;
    });
}

bool hasExtension(const char* layer, const char* wanted)
{
    uint32_t count = 0;
    vkEnumerateInstanceExtensionProperties(layer, &count, nullptr);
    std::vector<VkExtensionProperties> extensions(count);
    vkEnumerateInstanceExtensionProperties(layer, &count, extensions.data());
    return std::ranges::any_of(extensions, [&](const VkExtensionProperties& e) {
        return std::strcmp(e.extensionName, wanted) == 0;
    });
}

void addSurfaceExtensions(std::vector<const char*>& extensions)
{
    uint32_t count = 0;
    const char** names = glfwGetRequiredInstanceExtensions(&count);
    if (!names)
        throw RunError("the Vulkan installation cannot present to this display (no surface "
                       "extension)");
    extensions.insert(extensions.end(), names, names + count);
}

std::string lower(std::string text)
{
    std::ranges::transform(text, text.begin(),
                           [](unsigned char c) { return char(std::tolower(c)); });
    return text;
}

// The types of devices, the preferred ones first.
constexpr Choice<VkPhysicalDeviceType> deviceTypes[] = {
    {"discrete GPU", VK_PHYSICAL_DEVICE_TYPE_DISCRETE_GPU},
    {"integrated GPU", VK_PHYSICAL_DEVICE_TYPE_INTEGRATED_GPU},
    {"virtual GPU", VK_PHYSICAL_DEVICE_TYPE_VIRTUAL_GPU},
    {"CPU", VK_PHYSICAL_DEVICE_TYPE_CPU},
    {"other", VK_PHYSICAL_DEVICE_TYPE_OTHER}};

// Returns the place of a type in this list. Types that later versions of Vulkan add count as
// "other".
size_t placeOf(VkPhysicalDeviceType type)
{
    size_t place = 0;
    while (place + 1 < std::size(deviceTypes) && deviceTypes[place].value != type)
        ++place;
    return place;
}

DeviceInfo deviceInfoOf(VkInstance instance, VkPhysicalDevice handle, uint32_t index)
{
    VkPhysicalDeviceDriverProperties driver{VK_STRUCTURE_TYPE_PHYSICAL_DEVICE_DRIVER_PROPERTIES};
    VkPhysicalDeviceProperties2 properties{VK_STRUCTURE_TYPE_PHYSICAL_DEVICE_PROPERTIES_2};
    vkGetPhysicalDeviceProperties(handle, &properties.properties);
    const uint32_t version = properties.properties.apiVersion;
    if (version >= VK_API_VERSION_1_2) {
        properties.pNext = &driver;
        vkGetPhysicalDeviceProperties2(handle, &properties);
    }
    std::string missing;
    try {
        const CndDeviceDesc desc{.structSize = sizeof desc,
                                 .instance = instance,
                                 .physicalDevice = handle,
                                 .getInstanceProcAddr = vkGetInstanceProcAddr};
        missing = gpu::missingNeeds(gpu::InstanceFunctions(desc), desc,
                                    gpu::allModules | gpu::rasterPass);
    } catch (const gpu::Failure& failure) {
        missing = failure.message;
    }
    std::string driverText = driver.driverName;
    if (driver.driverInfo[0])
        driverText += std::string(driverText.empty() ? "" : " ") + driver.driverInfo;
    return {.index = index,
            .handle = handle,
            .name = properties.properties.deviceName,
            .type = properties.properties.deviceType,
            .vulkanVersion = std::to_string(VK_API_VERSION_MAJOR(version)) + "." +
                             std::to_string(VK_API_VERSION_MINOR(version)) + "." +
                             std::to_string(VK_API_VERSION_PATCH(version)),
            .driver = driverText,
            .missing = missing};
}

bool isNumber(const std::string& text)
{
    return !text.empty() && text.size() < 6 &&
           std::ranges::all_of(text, [](unsigned char c) { return std::isdigit(c); });
}

// Returns the device that `wanted` names. Throws UsageError if there is none.
DeviceInfo findDevice(const std::vector<DeviceInfo>& devices, const std::string& wanted)
{
    if (isNumber(wanted)) {
        const size_t index = std::stoul(wanted);
        if (index >= devices.size())
            throw UsageError("--device " + wanted + ": there " +
                             (devices.size() == 1 ? "is " : "are ") +
                             counted(devices.size(), "device") + ", numbered from 0");
        return devices[index];
    }
    const auto match = std::ranges::find_if(devices, [&](const DeviceInfo& d) {
        return lower(d.name).find(lower(wanted)) != std::string::npos;
    });
    if (match == devices.end())
        throw UsageError("--device " + wanted +
                         ": no device has that in its name (see: candelabra devices)");
    return *match;
}

} // namespace

void MessageLog::add(ValidationMessage message)
{
    const std::lock_guard lock(mutex_);
    messages_.push_back(std::move(message));
}

std::vector<ValidationMessage> MessageLog::take()
{
    const std::lock_guard lock(mutex_);
    return std::exchange(messages_, {});
}

const char* deviceTypeName(VkPhysicalDeviceType type)
{
    return deviceTypes[placeOf(type)].name;
}

VulkanInstance::VulkanInstance(Validation validation, Presentation presentation,
                               uint32_t apiVersion)
    : validation_(validation), presentation_(presentation)
{
    const bool validate = validation == Validation::On;
    if (validate && !hasLayer(validationLayer))
        throw RunError(std::string("the layer ") + validationLayer +
                       " is not installed (Debian package vulkan-validationlayers)");
    std::vector<const char*> extensions;
    if (presentation == Presentation::Window)
        addSurfaceExtensions(extensions);
    debugUtils_ = hasExtension(nullptr, VK_EXT_DEBUG_UTILS_EXTENSION_NAME) ||
                  (validate && hasExtension(validationLayer, VK_EXT_DEBUG_UTILS_EXTENSION_NAME));
    if (debugUtils_)
        extensions.push_back(VK_EXT_DEBUG_UTILS_EXTENSION_NAME);
    if (validate)
        extensions.push_back(VK_EXT_VALIDATION_FEATURES_EXTENSION_NAME);

    const VkApplicationInfo application{.sType = VK_STRUCTURE_TYPE_APPLICATION_INFO,
                                        .pApplicationName = "candelabra",
                                        .applicationVersion = CND_VERSION,
                                        .pEngineName = "candelabra",
                                        .engineVersion = CND_VERSION,
                                        .apiVersion = apiVersion};
    VkDebugUtilsMessengerCreateInfoEXT messenger = messengerInfo(*messages_);
    const VkValidationFeatureEnableEXT enabled =
        VK_VALIDATION_FEATURE_ENABLE_SYNCHRONIZATION_VALIDATION_EXT;
    const VkValidationFeaturesEXT features{.sType = VK_STRUCTURE_TYPE_VALIDATION_FEATURES_EXT,
                                           .pNext = &messenger, // covers vkCreateInstance itself
                                           .enabledValidationFeatureCount = 1,
                                           .pEnabledValidationFeatures = &enabled};
    const VkInstanceCreateInfo info{.sType = VK_STRUCTURE_TYPE_INSTANCE_CREATE_INFO,
                                    .pNext = validate ? &features : nullptr,
                                    .pApplicationInfo = &application,
                                    .enabledLayerCount = validate ? 1u : 0u,
                                    .ppEnabledLayerNames = &validationLayer,
                                    .enabledExtensionCount = uint32_t(extensions.size()),
                                    .ppEnabledExtensionNames = extensions.data()};
    const VkResult result = vkCreateInstance(&info, nullptr, &instance_);
    if (result == VK_ERROR_INCOMPATIBLE_DRIVER)
        throw RunError(noDevice);
    check(result, "creating the Vulkan instance");
    if (!validate)
        return;
    const auto create = reinterpret_cast<PFN_vkCreateDebugUtilsMessengerEXT>(
        vkGetInstanceProcAddr(instance_, "vkCreateDebugUtilsMessengerEXT"));
    if (!create || create(instance_, &messenger, nullptr, &messenger_) != VK_SUCCESS) {
        vkDestroyInstance(instance_, nullptr);
        throw RunError("the validation layer reports no messages (no debug messenger)");
    }
}

VulkanInstance::~VulkanInstance()
{
    if (messenger_) {
        const auto destroy = reinterpret_cast<PFN_vkDestroyDebugUtilsMessengerEXT>(
            vkGetInstanceProcAddr(instance_, "vkDestroyDebugUtilsMessengerEXT"));
        destroy(instance_, messenger_, nullptr);
    }
    vkDestroyInstance(instance_, nullptr);
}

std::vector<DeviceInfo> VulkanInstance::devices() const
{
    uint32_t count = 0;
    check(vkEnumeratePhysicalDevices(instance_, &count, nullptr), "listing the Vulkan devices");
    std::vector<VkPhysicalDevice> handles(count);
    check(vkEnumeratePhysicalDevices(instance_, &count, handles.data()),
          "listing the Vulkan devices");
    std::vector<DeviceInfo> devices;
    for (uint32_t i = 0; i < count; ++i)
        devices.push_back(deviceInfoOf(instance_, handles[i], i));
    return devices;
}

DeviceInfo chooseDevice(const std::vector<DeviceInfo>& devices, const std::string& wanted)
{
    if (devices.empty())
        throw RunError(noDevice);
    if (!wanted.empty()) {
        const DeviceInfo device = findDevice(devices, wanted);
        if (!device.missing.empty())
            throw UsageError("device " + std::to_string(device.index) + " (" + device.name +
                             ") lacks: " + device.missing);
        return device;
    }
    const DeviceInfo* best = nullptr;
    for (const DeviceInfo& d : devices)
        if (d.missing.empty() && (!best || placeOf(d.type) < placeOf(best->type)))
            best = &d;
    if (!best)
        throw RunError("no Vulkan device is usable; " + devices[0].name +
                       " lacks: " + devices[0].missing);
    return *best;
}

uint32_t maxLightsOf(const DeviceInfo& device)
{
    VkPhysicalDeviceProperties properties{};
    vkGetPhysicalDeviceProperties(device.handle, &properties);
    return cndMaxLightCount(&properties.limits);
}

} // namespace candelabra::app
