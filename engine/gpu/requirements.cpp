// SPDX-License-Identifier: Apache-2.0
#include "gpu/requirements.h"

#include <algorithm>
#include <cstring>
#include <vector>

#include "gpu/failure.h"

namespace candelabra::gpu
{
namespace
{

// The only list of the features that the engine uses: X(feature, the parts that need it, and the
// structs that have it with their types). Shader code needs no other feature, because all of it is
// SPIR-V 1.3 for Vulkan 1.1 (shaders/compile.cmake). Exposure needs none at all.
#define CND_FEATURE_NEEDS(X)                                                                       \
    X(scalarBlockLayout, lightingModule | environmentModule | rasterPass,                          \
      VkPhysicalDeviceVulkan12Features, VK_STRUCTURE_TYPE_PHYSICAL_DEVICE_VULKAN_1_2_FEATURES,     \
      VkPhysicalDeviceScalarBlockLayoutFeatures,                                                   \
      VK_STRUCTURE_TYPE_PHYSICAL_DEVICE_SCALAR_BLOCK_LAYOUT_FEATURES)                              \
    X(dynamicRendering, rasterPass, VkPhysicalDeviceVulkan13Features,                              \
      VK_STRUCTURE_TYPE_PHYSICAL_DEVICE_VULKAN_1_3_FEATURES,                                       \
      VkPhysicalDeviceDynamicRenderingFeatures,                                                    \
      VK_STRUCTURE_TYPE_PHYSICAL_DEVICE_DYNAMIC_RENDERING_FEATURES)                                \
    X(synchronization2, rasterPass, VkPhysicalDeviceVulkan13Features,                              \
      VK_STRUCTURE_TYPE_PHYSICAL_DEVICE_VULKAN_1_3_FEATURES,                                       \
      VkPhysicalDeviceSynchronization2Features,                                                    \
      VK_STRUCTURE_TYPE_PHYSICAL_DEVICE_SYNCHRONIZATION_2_FEATURES)

// The same for members of VkPhysicalDeviceFeatures: X(feature, parts).
#define CND_CORE_FEATURE_NEEDS(X)                                                                  \
    X(multiDrawIndirect, rasterPass)                                                               \
    X(drawIndirectFirstInstance, rasterPass)

// Limits that must exceed the minimum that Vulkan guarantees: X(limit, least value, parts).
// Exposure has a lane per bin of its histogram; cluster_lists has ten storage buffers,
// cull_triangles six, list_occluders thirteen.
#define CND_LIMIT_NEEDS(X)                                                                         \
    X(maxComputeWorkGroupInvocations, 256, exposureModule)                                         \
    X(maxComputeWorkGroupSize[0], 256, exposureModule)                                             \
    X(maxPerStageDescriptorStorageBuffers, mostStorageBuffers, lightingModule | rasterPass)        \
    X(maxPerStageDescriptorStorageBuffers, shadowStorageBuffers, shadowKernels)
constexpr uint32_t mostStorageBuffers = 10, shadowStorageBuffers = 13, guaranteedStorageBuffers = 4;

std::string versionText(uint32_t version)
{
    return std::to_string(VK_API_VERSION_MAJOR(version)) + "." +
           std::to_string(VK_API_VERSION_MINOR(version));
}

[[noreturn]] void failInstance()
{
    failUnsupported("the instance was created for Vulkan 1.0, Candelabra needs 1.1: set "
                    "VkApplicationInfo::apiVersion to VK_API_VERSION_1_1 or newer");
}

// Visits each struct of a chain that may hold features.
template <typename Visit>
void forEachStruct(VkPhysicalDeviceFeatures2& features, Visit&& visit)
{
    for (auto* s = static_cast<VkBaseOutStructure*>(features.pNext); s; s = s->pNext)
        visit(s);
}

// Calls `visit` with the name of each feature that the parts need, its value (null if no struct of
// the chain has it), and the structs that may hold it.
template <typename Visit>
void forEachFeature(VkPhysicalDeviceFeatures2& features, Parts parts, Visit&& visit)
{
#define X(feature, needed)                                                                         \
    if (parts & (needed))                                                                          \
        visit(#feature, &features.features.feature, "VkPhysicalDeviceFeatures");
    CND_CORE_FEATURE_NEEDS(X)
#undef X
#define X(feature, needed, Version, versionType, Single, singleType)                               \
    if (parts & (needed)) {                                                                        \
        VkBool32* value = nullptr;                                                                 \
        forEachStruct(features, [&](VkBaseOutStructure* s) {                                       \
            if (s->sType == (versionType))                                                         \
                value = &reinterpret_cast<Version*>(s)->feature;                                   \
            else if (s->sType == (singleType))                                                     \
                value = &reinterpret_cast<Single*>(s)->feature;                                    \
        });                                                                                        \
        visit(#feature, value, #Version " or " #Single);                                           \
    }
    CND_FEATURE_NEEDS(X)
#undef X
}

bool hasExtension(const InstanceFunctions& functions, VkPhysicalDevice device, const char* wanted)
{
    uint32_t count = 0;
    check(functions.EnumerateDeviceExtensionProperties(device, nullptr, &count, nullptr),
          "listing the extensions of the device");
    std::vector<VkExtensionProperties> extensions(count);
    check(functions.EnumerateDeviceExtensionProperties(device, nullptr, &count, extensions.data()),
          "listing the extensions of the device");
    return std::any_of(extensions.begin(), extensions.end(), [&](const VkExtensionProperties& e) {
        return std::strcmp(e.extensionName, wanted) == 0;
    });
}

void addMissingFeatures(std::vector<std::string>& missing, const InstanceFunctions& functions,
                        VkPhysicalDevice device, uint32_t version, Parts parts)
{
    VkPhysicalDeviceVulkan13Features core13{
        .sType = VK_STRUCTURE_TYPE_PHYSICAL_DEVICE_VULKAN_1_3_FEATURES};
    VkPhysicalDeviceScalarBlockLayoutFeatures scalar{
        .sType = VK_STRUCTURE_TYPE_PHYSICAL_DEVICE_SCALAR_BLOCK_LAYOUT_FEATURES,
        .pNext = version >= VK_API_VERSION_1_3 ? &core13 : nullptr};
    VkPhysicalDeviceFeatures2 features{.sType = VK_STRUCTURE_TYPE_PHYSICAL_DEVICE_FEATURES_2};
    if (version >= VK_API_VERSION_1_2 ||
        hasExtension(functions, device, VK_EXT_SCALAR_BLOCK_LAYOUT_EXTENSION_NAME))
        features.pNext = &scalar;
    functions.GetPhysicalDeviceFeatures2(device, &features);
    forEachFeature(features, parts,
                   [&](const std::string& feature, const VkBool32* value, const char*) {
                       if (!value)
                           missing.push_back("feature " + feature +
                                             " (VK_EXT_scalar_block_layout, or Vulkan 1.2)");
                       else if (!*value)
                           missing.push_back("feature " + feature);
                   });
}

void addMissingFormats(std::vector<std::string>& missing, const InstanceFunctions& functions,
                       VkPhysicalDevice device, Parts parts)
{
    // Vulkan guarantees what else is done with formats, except those that the host chooses, which
    // are checked where they are set.
    const auto has = [&](VkFormat format, VkFormatFeatureFlags features) {
        VkFormatProperties2 properties{.sType = VK_STRUCTURE_TYPE_FORMAT_PROPERTIES_2};
        functions.GetPhysicalDeviceFormatProperties2(device, format, &properties);
        return (properties.formatProperties.optimalTilingFeatures & features) == features;
    };
    // Cube maps are read with linear filtering. Half floats could not hold the sun's luminance.
    if (parts & environmentModule &&
        !has(VK_FORMAT_R32G32B32A32_SFLOAT, VK_FORMAT_FEATURE_SAMPLED_IMAGE_FILTER_LINEAR_BIT))
        missing.emplace_back("linear filtering of VK_FORMAT_R32G32B32A32_SFLOAT");
    if (parts & rasterPass &&
        !has(VK_FORMAT_D32_SFLOAT, VK_FORMAT_FEATURE_DEPTH_STENCIL_ATTACHMENT_BIT))
        missing.emplace_back("depth attachments of VK_FORMAT_D32_SFLOAT");
}

void addMissingMemory(std::vector<std::string>& missing, const InstanceFunctions& functions,
                      VkPhysicalDevice device)
{
    // Every GPU has such memory. Drivers that compile for a GPU which is not there have none.
    constexpr VkMemoryPropertyFlags mapped =
        VK_MEMORY_PROPERTY_HOST_VISIBLE_BIT | VK_MEMORY_PROPERTY_HOST_COHERENT_BIT;
    VkPhysicalDeviceMemoryProperties memory{};
    functions.GetPhysicalDeviceMemoryProperties(device, &memory);
    if (std::none_of(
            memory.memoryTypes, memory.memoryTypes + memory.memoryTypeCount,
            [](const VkMemoryType& type) { return (type.propertyFlags & mapped) == mapped; }))
        missing.emplace_back("memory that the CPU can write");
}

} // namespace

uint32_t maxStorageBuffers(Parts parts)
{
    if (parts & shadowKernels)
        return shadowStorageBuffers;
    return parts & (lightingModule | rasterPass) ? mostStorageBuffers : guaranteedStorageBuffers;
}

Parts modulesOf(const char* function, uint32_t mask)
{
    if (mask & ~allModules)
        failArgument(std::string(function) + ": modules must be a mask of CndModuleBits");
    return mask ? mask : allModules;
}

InstanceFunctions::InstanceFunctions(const CndDeviceDesc& desc)
{
    if (desc.structSize != sizeof desc)
        failArgument("CndDeviceDesc: structSize is " + std::to_string(desc.structSize) +
                     ", this library expects " + std::to_string(sizeof desc));
    if (!desc.instance || !desc.physicalDevice || !desc.getInstanceProcAddr)
        failArgument("CndDeviceDesc: instance, physicalDevice and getInstanceProcAddr must not be "
                     "null");
    if (desc.apiVersion && desc.apiVersion < VK_API_VERSION_1_1)
        failUnsupported("CndDeviceDesc: apiVersion is " + versionText(desc.apiVersion) +
                        ", Candelabra needs 1.1: set VkApplicationInfo::apiVersion, and apiVersion "
                        "here, to VK_API_VERSION_1_1 or newer");
#define X(f)                                                                                       \
    f = reinterpret_cast<PFN_vk##f>(desc.getInstanceProcAddr(desc.instance, "vk" #f));             \
    if (!f && std::strchr(#f, '2')) /* part of Vulkan 1.1, the others are of 1.0 */                \
        failInstance();                                                                            \
    if (!f)                                                                                        \
        failUnsupported("the host's vkGetInstanceProcAddr has no vk" #f);
    CND_INSTANCE_FUNCTIONS(X)
#undef X
}

uint32_t checkedVersion(const InstanceFunctions& functions, const CndDeviceDesc& desc)
{
    VkPhysicalDeviceSubgroupProperties subgroups{
        .sType = VK_STRUCTURE_TYPE_PHYSICAL_DEVICE_SUBGROUP_PROPERTIES};
    VkPhysicalDeviceProperties2 properties{.sType = VK_STRUCTURE_TYPE_PHYSICAL_DEVICE_PROPERTIES_2,
                                           .pNext = &subgroups};
    functions.GetPhysicalDeviceProperties2(desc.physicalDevice, &properties);
    const uint32_t device = properties.properties.apiVersion;
    // For an instance of Vulkan 1.0 the loader calls the function of Vulkan 1.0, which fills in
    // nothing of the chain. Every device has subgroups of at least one lane.
    if (device >= VK_API_VERSION_1_1 && subgroups.subgroupSize == 0)
        failInstance();
    return desc.apiVersion ? std::min(desc.apiVersion, device) : device;
}

std::string missingNeeds(const InstanceFunctions& functions, const CndDeviceDesc& desc, Parts parts)
{
    const VkPhysicalDevice device = desc.physicalDevice;
    const uint32_t version = checkedVersion(functions, desc);
    const uint32_t least = parts & rasterPass ? VK_API_VERSION_1_3 : VK_API_VERSION_1_1;
    if (version < least)
        return "Vulkan " + versionText(least) + " (the device has " + versionText(version) + ")";
    VkPhysicalDeviceSubgroupProperties subgroups{
        .sType = VK_STRUCTURE_TYPE_PHYSICAL_DEVICE_SUBGROUP_PROPERTIES};
    VkPhysicalDeviceProperties2 properties{.sType = VK_STRUCTURE_TYPE_PHYSICAL_DEVICE_PROPERTIES_2,
                                           .pNext = &subgroups};
    functions.GetPhysicalDeviceProperties2(device, &properties);
    const VkPhysicalDeviceLimits& limits = properties.properties.limits;

    std::vector<std::string> missing;
    addMissingFeatures(missing, functions, device, version, parts);
#define X(limit, least, needed)                                                                    \
    if (parts & (needed) && limits.limit < (least))                                                \
        missing.push_back(#limit " of at least " + std::to_string(least));
    CND_LIMIT_NEEDS(X)
#undef X
    constexpr VkSubgroupFeatureFlags subgroupNeeds = // of count_pairs, cluster_lists and others
        VK_SUBGROUP_FEATURE_BASIC_BIT | VK_SUBGROUP_FEATURE_VOTE_BIT |
        VK_SUBGROUP_FEATURE_ARITHMETIC_BIT | VK_SUBGROUP_FEATURE_BALLOT_BIT;
    if (parts & lightingModule &&
        ((subgroups.supportedOperations & subgroupNeeds) != subgroupNeeds ||
         !(subgroups.supportedStages & VK_SHADER_STAGE_COMPUTE_BIT)))
        missing.emplace_back("subgroup votes, ballots and arithmetic in compute shaders");
    addMissingFormats(missing, functions, device, parts);
    addMissingMemory(missing, functions, device);

    std::string all;
    for (const std::string& m : missing)
        all += (all.empty() ? "" : ", ") + m;
    return all;
}

void requireNeeds(const InstanceFunctions& functions, const CndDeviceDesc& desc, Parts parts)
{
    const std::string missing = missingNeeds(functions, desc, parts);
    if (!missing.empty())
        failUnsupported("the device lacks: " + missing);
}

void requireFeatures(VkPhysicalDeviceFeatures2& features, Parts parts)
{
    forEachFeature(
        features, parts, [](const std::string& feature, VkBool32* value, const char* structs) {
            if (!value)
                failArgument("cndRequireFeatures: no struct of the chain has the feature " +
                             feature + ": chain a " + structs);
            *value = VK_TRUE;
        });
}

} // namespace candelabra::gpu
