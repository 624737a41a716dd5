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

// What memory is for.
typedef enum CndMemoryKind {
    CND_MEMORY_BUFFER = 0, // buffers of the GPU alone
    // The same, but no recording reads what an earlier one left there, except for what the host
    // asks to be kept: by CndLightingFrame::surfacesUnchanged, and a forward set until it was used.
    // May lie over other memory of the host's that is not in use meanwhile; the host then orders
    // both uses (stages COMPUTE_SHADER, DRAW_INDIRECT and ALL_TRANSFER, all their accesses).
    CND_MEMORY_SCRATCH = 1,
    CND_MEMORY_UPLOAD = 2,   // buffers that the host writes, in order, and the GPU reads
    CND_MEMORY_READBACK = 3, // buffers that the GPU writes and the host reads: statistics
    CND_MEMORY_IMAGE = 4,    // images of optimal tiling, of the GPU alone
    CND_MEMORY_KIND_COUNT = 5,
    CND_MEMORY_KIND_MAX_ENUM = 0x7FFFFFFF
} CndMemoryKind;

// Memory for one object, which exists; the module binds it.
typedef struct CndMemoryRequest {
    VkMemoryRequirements requirements;
    VkMemoryPropertyFlags required;  // the memory type has all of these
    VkMemoryPropertyFlags preferred; // and these too where there is such a type
    CndMemoryKind kind;
    VkBuffer buffer;  // for a dedicated allocation; VK_NULL_HANDLE for an image
    VkImage image;    // the same; VK_NULL_HANDLE for a buffer
    const char* name; // of the object; only until the call returns
} CndMemoryRequest;

// Where the object goes.
typedef struct CndMemory {
    VkDeviceMemory memory;
    VkDeviceSize offset; // bytes, a multiple of requirements.alignment
    void* mapped;        // at offset; not NULL where `required` has HOST_VISIBLE
    void* allocation;    // the host's own: what `free` is given
} CndMemory;

// All device memory comes from the host, and goes back to it. Neither function may throw. They are
// called in cndCreate..., in calls that set or edit lights, and in cndDestroy..., by the thread
// that makes the call; never while recording.
typedef struct CndAllocator {
    // VK_SUCCESS and `memory` filled in, or an error, which the call that needed it then reports.
    VkResult (*allocate)(void* user, const CndMemoryRequest* request, CndMemory* memory);
    // The GPU has finished with it and the object is gone.
    void (*free)(void* user, void* allocation);
    void* user;
} CndAllocator;

// Memory by CndMemoryKind; scratch memory is transient, all other persists. One block of
// bytes + allocations * alignment, of a type in memoryTypeBits, holds all of a kind, each behind
// the one before it at the next multiple of its alignment.
typedef struct CndMemoryUsage {
    uint32_t structSize;
    uint32_t allocations[CND_MEMORY_KIND_COUNT];
    VkDeviceSize bytes[CND_MEMORY_KIND_COUNT];      // sum of VkMemoryRequirements::size
    VkDeviceSize alignment[CND_MEMORY_KIND_COUNT];  // the largest there was; 0: none
    uint32_t memoryTypeBits[CND_MEMORY_KIND_COUNT]; // types that take every one there was
} CndMemoryUsage;

typedef enum CndMessageSeverity {
    CND_MESSAGE_INFO = 0,    // what a call did besides: memory that grew, pipelines that were made
    CND_MESSAGE_WARNING = 1, // works, but slower or less than was asked for
    CND_MESSAGE_SEVERITY_MAX_ENUM = 0x7FFFFFFF
} CndMessageSeverity;

// What is no error and worth a line in the host's log: one sentence, only until the callback
// returns. Called in cndCreate..., in calls that set or edit lights and in cndGet...Stats, by the
// thread that makes the call; never while recording, and not every frame. May not throw, nor call
// the object that it is about. Errors are results and no messages.
typedef void (*CndMessageCallback)(void* user, CndMessageSeverity severity, const char* sentence);

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
        debugUtilsEnabled;  // VK_EXT_debug_utils is enabled on the instance: name and label objects
    CndAllocator allocator; // copied; all zero: the modules call vkAllocateMemory for every object
    CndMessageCallback message; // may be NULL
    void* messageUser;          // given to it
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
