// SPDX-License-Identifier: Apache-2.0
#include "measure/pipelines/compile_only_device.h"

#include <algorithm>
#include <cstdlib>
#include <cstring>
#include <span>

#include "render/check.h"

namespace candelabra::app
{
namespace
{

constexpr const char* needed = VK_KHR_PIPELINE_EXECUTABLE_PROPERTIES_EXTENSION_NAME;

bool hasNeeded(VkPhysicalDevice device)
{
    uint32_t count = 0;
    vkEnumerateDeviceExtensionProperties(device, nullptr, &count, nullptr);
    std::vector<VkExtensionProperties> extensions(count);
    vkEnumerateDeviceExtensionProperties(device, nullptr, &count, extensions.data());
    return std::ranges::any_of(extensions, [](const VkExtensionProperties& e) {
        return std::strcmp(e.extensionName, needed) == 0;
    });
}

// The devices, where `missing` says what each lacks for compiling. Further needs of drawing do
// not matter here.
std::vector<DeviceInfo> compilingDevices(const VulkanInstance& instance)
{
    std::vector<DeviceInfo> devices = instance.devices();
    for (DeviceInfo& device : devices)
        device.missing = hasNeeded(device.handle) ? "" : needed;
    return devices;
}

// Returns the names of a shader's specialisation constants by their ids. The words are those of a
// module that gpu::reflect has accepted.
std::map<uint32_t, std::string> constantNames(std::span<const uint32_t> words)
{
    constexpr uint32_t opName = 5, opDecorate = 71, decorationSpecId = 1, headerWords = 5;
    std::map<uint32_t, std::string> names, out;
    for (size_t i = headerWords; i < words.size(); i += words[i] >> 16) {
        const uint32_t opcode = words[i] & 0xffff;
        if (opcode == opName) // the first name; a constant that is equal may have added its own
            names.emplace(words[i + 1], reinterpret_cast<const char*>(&words[i + 2]));
        else if (opcode == opDecorate && words[i + 2] == decorationSpecId)
            out[words[i + 3]] = names[words[i + 1]];
    }
    return out;
}

double valueOf(const VkPipelineExecutableStatisticKHR& s)
{
    switch (s.format) {
    case VK_PIPELINE_EXECUTABLE_STATISTIC_FORMAT_BOOL32_KHR:
        return s.value.b32;
    case VK_PIPELINE_EXECUTABLE_STATISTIC_FORMAT_INT64_KHR:
        return double(s.value.i64);
    case VK_PIPELINE_EXECUTABLE_STATISTIC_FORMAT_UINT64_KHR:
        return double(s.value.u64);
    default:
        return s.value.f64;
    }
}

CompileOnlyDevice* current = nullptr; // Vulkan functions have no parameter for the host

// A handle of an object that does not exist.
template <typename T>
T fakeHandle()
{
    static uint64_t last = 0;
    return reinterpret_cast<T>(++last);
}

} // namespace

// Everything that only the execution of pipelines needs succeeds without doing anything.
struct CompileOnlyDevice::Functions {
    template <typename Info, typename T>
    static VkResult VKAPI_CALL create(VkDevice, const Info*, const VkAllocationCallbacks*, T* out)
    {
        *out = fakeHandle<T>();
        return VK_SUCCESS;
    }
    template <typename T>
    static void VKAPI_CALL destroy(VkDevice, T, const VkAllocationCallbacks*)
    {
    }
    // A buffer's handle is the address of its size, which its memory requirements need.
    static VkResult VKAPI_CALL createBuffer(VkDevice, const VkBufferCreateInfo* info,
                                            const VkAllocationCallbacks*, VkBuffer* out)
    {
        *out = reinterpret_cast<VkBuffer>(new VkDeviceSize(info->size));
        return VK_SUCCESS;
    }
    static void VKAPI_CALL destroyBuffer(VkDevice, VkBuffer buffer, const VkAllocationCallbacks*)
    {
        delete reinterpret_cast<VkDeviceSize*>(buffer);
    }
    static void VKAPI_CALL bufferNeeds(VkDevice, VkBuffer buffer, VkMemoryRequirements* out)
    {
        *out = {*reinterpret_cast<VkDeviceSize*>(buffer), 1, 1};
    }
    static void VKAPI_CALL imageNeeds(VkDevice, VkImage, VkMemoryRequirements* out)
    {
        *out = {1, 1, 1}; // images are not mapped
    }
    // Zeros take memory only where the engine writes to them.
    static VkResult VKAPI_CALL allocate(VkDevice, const VkMemoryAllocateInfo* info,
                                        const VkAllocationCallbacks*, VkDeviceMemory* out)
    {
        *out = reinterpret_cast<VkDeviceMemory>(std::calloc(1, info->allocationSize));
        return *out ? VK_SUCCESS : VK_ERROR_OUT_OF_HOST_MEMORY;
    }
    static void VKAPI_CALL freeMemory(VkDevice, VkDeviceMemory memory, const VkAllocationCallbacks*)
    {
        std::free(memory);
    }
    static VkResult VKAPI_CALL map(VkDevice, VkDeviceMemory memory, VkDeviceSize offset,
                                   VkDeviceSize, VkMemoryMapFlags, void** out)
    {
        *out = reinterpret_cast<char*>(memory) + offset;
        return VK_SUCCESS;
    }
    template <typename T>
    static VkResult VKAPI_CALL bind(VkDevice, T, VkDeviceMemory, VkDeviceSize)
    {
        return VK_SUCCESS;
    }
    static VkResult VKAPI_CALL allocateSets(VkDevice, const VkDescriptorSetAllocateInfo* info,
                                            VkDescriptorSet* out)
    {
        for (uint32_t i = 0; i < info->descriptorSetCount; ++i)
            out[i] = fakeHandle<VkDescriptorSet>();
        return VK_SUCCESS;
    }
    static void VKAPI_CALL updateSets(VkDevice, uint32_t, const VkWriteDescriptorSet*, uint32_t,
                                      const VkCopyDescriptorSet*)
    {
    }
    static void VKAPI_CALL memoryProperties(VkPhysicalDevice, VkPhysicalDeviceMemoryProperties* out)
    {
        *out = {.memoryTypeCount = 1,
                .memoryTypes = {{VK_MEMORY_PROPERTY_DEVICE_LOCAL_BIT |
                                     VK_MEMORY_PROPERTY_HOST_VISIBLE_BIT |
                                     VK_MEMORY_PROPERTY_HOST_COHERENT_BIT,
                                 0}},
                .memoryHeapCount = 1,
                .memoryHeaps = {{UINT64_MAX, VK_MEMORY_HEAP_DEVICE_LOCAL_BIT}}};
    }

    static VkResult VKAPI_CALL setName(VkDevice, const VkDebugUtilsObjectNameInfoEXT* info)
    {
        if (info->objectType == VK_OBJECT_TYPE_PIPELINE_LAYOUT)
            current->layoutNames_[reinterpret_cast<VkPipelineLayout>(info->objectHandle)] =
                info->pObjectName;
        return VK_SUCCESS;
    }
    static VkResult VKAPI_CALL createModule(VkDevice device, const VkShaderModuleCreateInfo* info,
                                            const VkAllocationCallbacks* callbacks,
                                            VkShaderModule* out)
    {
        const VkResult result = vkCreateShaderModule(device, info, callbacks, out);
        if (result == VK_SUCCESS)
            current->constantNames_[*out] =
                constantNames({info->pCode, info->codeSize / sizeof(uint32_t)});
        return result;
    }
    static void destroyPipeline(VkDevice device, VkPipeline pipeline,
                                const VkAllocationCallbacks* callbacks)
    {
        vkDestroyPipeline(device, pipeline, callbacks);
    }
    static void add(PipelineRequest& request, const VkPipelineShaderStageCreateInfo& stage)
    {
        const VkSpecializationInfo* values = stage.pSpecializationInfo;
        const auto& names = current->constantNames_[stage.module];
        for (uint32_t i = 0; values && i < values->mapEntryCount; ++i) {
            const VkSpecializationMapEntry& entry = values->pMapEntries[i];
            const auto name = names.find(entry.constantID);
            if (name != names.end()) // the engine sets constants that not every kernel has
                std::memcpy(&request.constants[name->second],
                            static_cast<const char*>(values->pData) + entry.offset,
                            sizeof(uint32_t));
        }
    }
    // Compiles one pipeline by `create`, or gives an empty handle if it is not wanted. The engine
    // only passes it on to functions that are not called here.
    template <typename Info, typename Create>
    static VkResult compile(VkDevice device, Info info,
                            std::span<const VkPipelineShaderStageCreateInfo> stages, Create create,
                            VkPipeline* out)
    {
        PipelineRequest request{.kernel = current->layoutNames_[info.layout]};
        for (const VkPipelineShaderStageCreateInfo& stage : stages)
            add(request, stage);
        *out = VK_NULL_HANDLE;
        if (!current->wanted_(request))
            return VK_SUCCESS;
        info.flags |= VK_PIPELINE_CREATE_CAPTURE_STATISTICS_BIT_KHR;
        const VkResult result = create(device, VK_NULL_HANDLE, 1, &info, nullptr, out);
        if (result == VK_SUCCESS)
            current->record(request, *out);
        return result;
    }
    static VkResult VKAPI_CALL createCompute(VkDevice device, VkPipelineCache, uint32_t,
                                             const VkComputePipelineCreateInfo* info,
                                             const VkAllocationCallbacks*, VkPipeline* out)
    {
        return compile(device, *info, {&info->stage, 1}, vkCreateComputePipelines, out);
    }
    static VkResult VKAPI_CALL createGraphics(VkDevice device, VkPipelineCache, uint32_t,
                                              const VkGraphicsPipelineCreateInfo* info,
                                              const VkAllocationCallbacks*, VkPipeline* out)
    {
        return compile(device, *info, {info->pStages, info->stageCount}, vkCreateGraphicsPipelines,
                       out);
    }

    // Returns the function that replaces Vulkan's, or null if the engine may call Vulkan's.
    static PFN_vkVoidFunction find(const char* name)
    {
        const std::pair<const char*, void*> all[] = {
            {"vkGetDeviceProcAddr", reinterpret_cast<void*>(deviceFunction)},
            {"vkGetPhysicalDeviceMemoryProperties", reinterpret_cast<void*>(memoryProperties)},
            {"vkSetDebugUtilsObjectNameEXT", reinterpret_cast<void*>(setName)},
            {"vkCreateShaderModule", reinterpret_cast<void*>(createModule)},
            {"vkCreateComputePipelines", reinterpret_cast<void*>(createCompute)},
            {"vkCreateGraphicsPipelines", reinterpret_cast<void*>(createGraphics)},
            {"vkCreateBuffer", reinterpret_cast<void*>(createBuffer)},
            {"vkDestroyBuffer", reinterpret_cast<void*>(destroyBuffer)},
            {"vkGetBufferMemoryRequirements", reinterpret_cast<void*>(bufferNeeds)},
            {"vkGetImageMemoryRequirements", reinterpret_cast<void*>(imageNeeds)},
            {"vkAllocateMemory", reinterpret_cast<void*>(allocate)},
            {"vkFreeMemory", reinterpret_cast<void*>(freeMemory)},
            {"vkMapMemory", reinterpret_cast<void*>(map)},
            {"vkBindBufferMemory", reinterpret_cast<void*>(bind<VkBuffer>)},
            {"vkBindImageMemory", reinterpret_cast<void*>(bind<VkImage>)},
            {"vkAllocateDescriptorSets", reinterpret_cast<void*>(allocateSets)},
            {"vkUpdateDescriptorSets", reinterpret_cast<void*>(updateSets)},
#define UNMADE(Type)                                                                               \
    {"vkCreate" #Type, reinterpret_cast<void*>(create<Vk##Type##CreateInfo, Vk##Type>)},           \
        {"vkDestroy" #Type, reinterpret_cast<void*>(destroy<Vk##Type>)}
            UNMADE(BufferView),
            UNMADE(DescriptorPool),
            UNMADE(Image),
            UNMADE(ImageView),
            UNMADE(QueryPool),
            UNMADE(Sampler)
#undef UNMADE
        };
        for (const auto& [known, function] : all)
            if (std::strcmp(name, known) == 0)
                return reinterpret_cast<PFN_vkVoidFunction>(function);
        return nullptr;
    }
    static PFN_vkVoidFunction VKAPI_CALL deviceFunction(VkDevice device, const char* name)
    {
        const PFN_vkVoidFunction found = find(name);
        return found ? found : vkGetDeviceProcAddr(device, name);
    }
    static PFN_vkVoidFunction VKAPI_CALL instanceFunction(VkInstance instance, const char* name)
    {
        const PFN_vkVoidFunction found = find(name);
        return found ? found : vkGetInstanceProcAddr(instance, name);
    }
};

CompileOnlyDevice::CompileOnlyDevice(const std::string& device,
                                     std::function<bool(const PipelineRequest&)> wanted)
    : instance_(Validation::Off, Presentation::Headless),
      info_(chooseDevice(compilingDevices(instance_), device)),
      wanted_(std::move(wanted))
{
    createDevice();
    current = this;
    desc_ = {.structSize = sizeof desc_,
             .instance = instance_.get(),
             .physicalDevice = info_.handle,
             .device = device_,
             .getInstanceProcAddr = Functions::instanceFunction,
             .debugUtilsEnabled = VK_TRUE};
}

CompileOnlyDevice::~CompileOnlyDevice()
{
    current = nullptr;
    vkDestroyDevice(device_, nullptr);
}

void CompileOnlyDevice::createDevice()
{
    VkPhysicalDevicePipelineExecutablePropertiesFeaturesKHR statistics{
        .sType = VK_STRUCTURE_TYPE_PHYSICAL_DEVICE_PIPELINE_EXECUTABLE_PROPERTIES_FEATURES_KHR,
        .pipelineExecutableInfo = VK_TRUE};
    VkPhysicalDeviceVulkan13Features core13{
        .sType = VK_STRUCTURE_TYPE_PHYSICAL_DEVICE_VULKAN_1_3_FEATURES, .pNext = &statistics};
    VkPhysicalDeviceVulkan12Features core12{
        .sType = VK_STRUCTURE_TYPE_PHYSICAL_DEVICE_VULKAN_1_2_FEATURES, .pNext = &core13};
    VkPhysicalDeviceFeatures2 features{.sType = VK_STRUCTURE_TYPE_PHYSICAL_DEVICE_FEATURES_2,
                                       .pNext = &core12};
    gpu::requireFeatures(features, gpu::allModules | gpu::rasterPass);
    const float priority = 1.0f;
    const VkDeviceQueueCreateInfo queue{.sType = VK_STRUCTURE_TYPE_DEVICE_QUEUE_CREATE_INFO,
                                        .queueCount = 1,
                                        .pQueuePriorities = &priority};
    const VkDeviceCreateInfo info{.sType = VK_STRUCTURE_TYPE_DEVICE_CREATE_INFO,
                                  .pNext = &features,
                                  .queueCreateInfoCount = 1,
                                  .pQueueCreateInfos = &queue,
                                  .enabledExtensionCount = 1,
                                  .ppEnabledExtensionNames = &needed};
    check(vkCreateDevice(info_.handle, &info, nullptr, &device_),
          "creating a device on " + info_.name);
}

void CompileOnlyDevice::record(const PipelineRequest& request, VkPipeline pipeline)
{
    const auto getProperties = reinterpret_cast<PFN_vkGetPipelineExecutablePropertiesKHR>(
        vkGetDeviceProcAddr(device_, "vkGetPipelineExecutablePropertiesKHR"));
    const auto getStatistics = reinterpret_cast<PFN_vkGetPipelineExecutableStatisticsKHR>(
        vkGetDeviceProcAddr(device_, "vkGetPipelineExecutableStatisticsKHR"));
    const VkPipelineInfoKHR info{.sType = VK_STRUCTURE_TYPE_PIPELINE_INFO_KHR,
                                 .pipeline = pipeline};
    uint32_t count = 0;
    check(getProperties(device_, &info, &count, nullptr), "listing the code of " + request.kernel);
    std::vector<VkPipelineExecutablePropertiesKHR> executables(
        count, {.sType = VK_STRUCTURE_TYPE_PIPELINE_EXECUTABLE_PROPERTIES_KHR});
    check(getProperties(device_, &info, &count, executables.data()),
          "listing the code of " + request.kernel);
    for (uint32_t i = 0; i < count; ++i) {
        PipelineExecutable out{request, executables[i].name, executables[i].stages,
                               executables[i].subgroupSize};
        const VkPipelineExecutableInfoKHR which{.sType =
                                                    VK_STRUCTURE_TYPE_PIPELINE_EXECUTABLE_INFO_KHR,
                                                .pipeline = pipeline,
                                                .executableIndex = i};
        uint32_t n = 0;
        check(getStatistics(device_, &which, &n, nullptr), "measuring " + request.kernel);
        std::vector<VkPipelineExecutableStatisticKHR> statistics(
            n, {.sType = VK_STRUCTURE_TYPE_PIPELINE_EXECUTABLE_STATISTIC_KHR});
        check(getStatistics(device_, &which, &n, statistics.data()), "measuring " + request.kernel);
        for (const VkPipelineExecutableStatisticKHR& s : statistics)
            out.statistics.push_back({s.name, valueOf(s)});
        executables_.push_back(std::move(out));
    }
}

} // namespace candelabra::app
