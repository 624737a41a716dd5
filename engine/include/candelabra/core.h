// SPDX-License-Identifier: Apache-2.0
// What every module shares: version, results, the device contract, kernel times, plans of passes.
#ifndef CANDELABRA_CORE_H
#define CANDELABRA_CORE_H

#include <stddef.h>
#include <stdint.h>

#include <vulkan/vulkan_core.h>

#define CND_VERSION_MAJOR 0
#define CND_VERSION_MINOR 1
#define CND_VERSION_PATCH 0
#define CND_MAKE_VERSION(major, minor, patch) (((major) << 22) | ((minor) << 12) | (patch))
#define CND_VERSION CND_MAKE_VERSION(CND_VERSION_MAJOR, CND_VERSION_MINOR, CND_VERSION_PATCH)

#if defined(__GNUC__)
#define CND_API __attribute__((visibility("default")))
#else
#define CND_API
#endif

#ifdef __cplusplus
extern "C" {
#endif

typedef enum CndResult {
    CND_SUCCESS = 0,
    CND_NOT_READY = 1,               // statistics: the GPU has not finished that frame yet
    CND_ERROR_INVALID_ARGUMENT = -1, // a value outside its documented range
    CND_ERROR_UNSUPPORTED = -2,      // the device lacks a feature, format or limit
    CND_ERROR_OUT_OF_MEMORY = -3,
    CND_ERROR_DEVICE = -4, // a Vulkan call failed; vkResult tells which way
    CND_RESULT_MAX_ENUM = 0x7FFFFFFF
} CndResult;

typedef struct CndError {
    CndResult code;
    VkResult vkResult; // VK_SUCCESS when no Vulkan call was at fault
    char message[512]; // one sentence, zero terminated
} CndError;

// Version of the library that was linked, as CND_MAKE_VERSION.
CND_API uint32_t cndGetVersion(void);

// Borrowed handles; they must outlive every object created from them.
typedef struct CndDeviceDesc {
    uint32_t structSize;
    VkInstance instance;
    VkPhysicalDevice physicalDevice;
    VkDevice device;
    PFN_vkGetInstanceProcAddr getInstanceProcAddr;
    VkPipelineCache pipelineCache;                    // may be VK_NULL_HANDLE
    const VkAllocationCallbacks* allocationCallbacks; // may be NULL
    VkBool32
        debugUtilsEnabled; // VK_EXT_debug_utils is enabled on the instance: name and label objects
} CndDeviceDesc;

// Writes into `missing` (comma separated, zero terminated, truncated at missingSize) what the
// device lacks; CND_SUCCESS when it lacks nothing, CND_ERROR_UNSUPPORTED otherwise.
CND_API CndResult cndCheckDevice(VkInstance instance, VkPhysicalDevice physicalDevice,
                                 PFN_vkGetInstanceProcAddr getInstanceProcAddr, char* missing,
                                 size_t missingSize);

// Sets to VK_TRUE, in feature structs the host chains into VkDeviceCreateInfo, every feature that
// the modules need. Other members are left alone. Pointers may not be NULL.
CND_API void cndRequireFeatures(VkPhysicalDeviceFeatures* core10,
                                VkPhysicalDeviceVulkan12Features* core12,
                                VkPhysicalDeviceVulkan13Features* core13);

typedef struct CndKernelTime {
    const char* name; // static storage
    double ms;
} CndKernelTime;

#define CND_MAX_KERNEL_TIMES 16

// A pass of a module and what became of it in one frame: the content decides. Rows of kernel times
// have the same names; a pass whose work the GPU itself found to be empty has a row as well.
typedef struct CndPassPlan {
    const char* name;    // static storage
    const char* skipped; // NULL: it ran; else why it did not, static storage
} CndPassPlan;

#define CND_MAX_PASSES 16

#ifdef __cplusplus
}
#endif
#endif
