// SPDX-License-Identifier: Apache-2.0
// The features that the engine needs of a device, and the parts that need them.
#pragma once

#include <string>

#include "candelabra/candelabra.h"
#include "gpu/functions.h"

namespace candelabra::gpu
{

// Parts of the engine: a mask of CndModuleBits and of rasterPass.
using Parts = uint32_t;
constexpr Parts lightingModule = CND_MODULE_LIGHTING_BIT,
                environmentModule = CND_MODULE_ENVIRONMENT_BIT,
                exposureModule = CND_MODULE_EXPOSURE_BIT;
constexpr Parts allModules = lightingModule | environmentModule | exposureModule;
// The default raster pass, and everything that the program does apart from calling the modules.
constexpr Parts rasterPass = 1u << 31;
// The kernels of CndLightingDesc::shadows, in addition to lightingModule.
constexpr Parts shadowKernels = 1u << 30;

// Returns how many storage buffers a kernel of the parts may have. A host's descriptor set adds its
// own.
uint32_t maxStorageBuffers(Parts parts);

// Returns the modules of a mask that a host has given: all of them if it is 0. Throws Failure if
// the mask has other bits; `function` names the function of the C ABI.
Parts modulesOf(const char* function, uint32_t mask);

// The functions of the instance, found through the host's vkGetInstanceProcAddr.
struct InstanceFunctions {
    // Throws Failure if `desc` is not valid or a function is missing.
    explicit InstanceFunctions(const CndDeviceDesc& desc);
#define X(name) PFN_vk##name name = nullptr;
    CND_INSTANCE_FUNCTIONS(X)
#undef X
};

// Returns the version of Vulkan that host and physical device both have. Throws Failure if the
// instance is of Vulkan 1.0.
uint32_t checkedVersion(const InstanceFunctions& functions, const CndDeviceDesc& desc);

// Returns in words what the parts need and the physical device lacks, separated by commas; empty if
// nothing is missing. Throws Failure if the instance is of Vulkan 1.0.
std::string missingNeeds(const InstanceFunctions& functions, const CndDeviceDesc& desc,
                         Parts parts);

// Throws Failure if something is missing.
void requireNeeds(const InstanceFunctions& functions, const CndDeviceDesc& desc, Parts parts);

// Sets every feature that the parts need to VK_TRUE, in whichever struct of the chain has it.
// Throws Failure if no struct has it.
void requireFeatures(VkPhysicalDeviceFeatures2& features, Parts parts);

} // namespace candelabra::gpu
