// SPDX-License-Identifier: Apache-2.0
// The parts that all modules share: version, results, the Vulkan device and what it must support,
// memory, kernel times, pass plans.
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

#if !defined(VK_API_VERSION_1_3)
#error "Candelabra needs the headers of Vulkan 1.3 or newer."
#endif

// On Windows, CND_SHARED says that the functions are in a DLL; the CMake target of the shared
// library defines it. CND_EXPORTS is defined while the library is compiled.
#if defined(_WIN32) && defined(CND_EXPORTS)
#define CND_API __declspec(dllexport)
#elif defined(_WIN32) && defined(CND_SHARED)
#define CND_API __declspec(dllimport)
#elif defined(_WIN32)
#define CND_API
#elif defined(__GNUC__)
#define CND_API __attribute__((visibility("default")))
#else
#define CND_API
#endif

#ifdef __cplusplus
extern "C" {
#endif

typedef enum CndResult {
    CND_SUCCESS = 0,
    CND_NOT_READY = 1,               // statistics only: the GPU has not finished that frame yet
    CND_ERROR_INVALID_ARGUMENT = -1, // a value outside its documented range, or a null pointer
    CND_ERROR_UNSUPPORTED = -2,      // the device lacks a feature, a format or a limit
    CND_ERROR_OUT_OF_MEMORY = -3,
    CND_ERROR_DEVICE = -4, // a Vulkan call failed; vkResult says how
    CND_RESULT_MAX_ENUM = 0x7FFFFFFF
} CndResult;

// What went wrong in a call. A successful call writes CND_SUCCESS and an empty message.
typedef struct CndError {
    CndResult code;
    VkResult vkResult; // result of the Vulkan call that failed; VK_SUCCESS when none failed
    char message[512]; // one sentence, zero terminated, truncated to fit
} CndError;

// Version of the linked library, encoded like CND_MAKE_VERSION.
CND_API uint32_t cndGetVersion(void);

// What a block of device memory is used for.
typedef enum CndMemoryKind {
    CND_MEMORY_BUFFER = 0, // buffers that only the GPU accesses
    // Buffers that only the GPU accesses. Between two recordings the host may use their memory for
    // something else and overwrite the contents, except in two cases. First, a frame with
    // CndLightingFrame::surfacesUnchanged reuses what the previous frame of the view has written.
    // Second, the host's own shaders that use a forward set (cndGetForwardSet) read what the frame
    // of that set has written. A host that uses the memory in between must order both uses with
    // barriers (stages COMPUTE_SHADER, DRAW_INDIRECT and ALL_TRANSFER, with all their accesses).
    CND_MEMORY_SCRATCH = 1,
    CND_MEMORY_UPLOAD = 2,   // buffers that the host writes sequentially and the GPU reads
    CND_MEMORY_READBACK = 3, // buffers that the GPU writes and the host reads: statistics
    CND_MEMORY_IMAGE = 4,    // images with optimal tiling that only the GPU accesses
    CND_MEMORY_KIND_COUNT = 5,
    CND_MEMORY_KIND_MAX_ENUM = 0x7FFFFFFF
} CndMemoryKind;

// A request for the memory of one buffer or image. The object already exists, and the module binds
// the memory to it.
typedef struct CndMemoryRequest {
    VkMemoryRequirements requirements;
    VkMemoryPropertyFlags required;  // the memory type must have all of these
    VkMemoryPropertyFlags preferred; // and should have these too, if there is such a type
    CndMemoryKind kind;
    VkBuffer buffer;  // for a dedicated allocation; VK_NULL_HANDLE when the object is an image
    VkImage image;    // for a dedicated allocation; VK_NULL_HANDLE when the object is a buffer
    const char* name; // debug name of the object; valid only until the call returns
} CndMemoryRequest;

// The host's answer to a CndMemoryRequest: where the object's memory is.
typedef struct CndMemory {
    VkDeviceMemory memory;
    VkDeviceSize offset; // bytes, a multiple of requirements.alignment
    void* mapped;        // address of `offset` in host memory; not NULL if `required` contains
                         // HOST_VISIBLE
    void* allocation;    // the host's own handle, passed to CndAllocator::free
} CndMemory;

// The host's allocator for all device memory of a module. Neither function may throw. They are
// called on the calling thread, in cndCreate..., in cndDestroy... and in calls that set or edit
// lights or occluders; never while recording.
typedef struct CndAllocator {
    // Fills in `memory` and returns VK_SUCCESS, or returns an error. The ABI function that needed
    // the memory then fails with that error.
    VkResult (*allocate)(void* user, const CndMemoryRequest* request, CndMemory* memory);
    // Frees an allocation. The GPU has finished using it, and its object has been destroyed.
    void (*free)(void* user, void* allocation);
    // Passed to both functions as their first argument.
    void* user;
} CndAllocator;

// Device memory of a module, per CndMemoryKind. A host that suballocates can put all objects of a
// kind into one block of `bytes + allocations * alignment` bytes, of a memory type in
// memoryTypeBits. Each object starts after the previous one, at the next multiple of its alignment.
typedef struct CndMemoryUsage {
    uint32_t structSize;
    // Number of separate allocations.
    uint32_t allocations[CND_MEMORY_KIND_COUNT];
    VkDeviceSize bytes[CND_MEMORY_KIND_COUNT];      // sum of VkMemoryRequirements::size
    VkDeviceSize alignment[CND_MEMORY_KIND_COUNT];  // largest VkMemoryRequirements::alignment; 0
                                                    // without allocations
    uint32_t memoryTypeBits[CND_MEMORY_KIND_COUNT]; // memory types that every allocation allows
} CndMemoryUsage;

typedef enum CndMessageSeverity {
    CND_MESSAGE_INFO = 0,    // what a call also did: memory that grew, pipelines that were created
    CND_MESSAGE_WARNING = 1, // the call works, but slower or with less than was asked for
    CND_MESSAGE_SEVERITY_MAX_ENUM = 0x7FFFFFFF
} CndMessageSeverity;

// Receives one sentence for the host's log about something that is worth knowing but is not an
// error. (Errors are returned as results and never sent here.) The sentence is valid only until the
// callback returns. The callback is called on the calling thread, in cndCreate..., in
// cndGet...Stats and in calls that set or edit lights or occluders; never while recording, and not
// every frame. The callback must not throw and must not call the object that reports.
typedef void (*CndMessageCallback)(void* user, CndMessageSeverity severity, const char* sentence);

// The Vulkan device that a module uses. All handles are borrowed and must outlive every object
// created from them.
typedef struct CndDeviceDesc {
    uint32_t structSize;
    VkInstance instance;
    VkPhysicalDevice physicalDevice;
    VkDevice device;
    PFN_vkGetInstanceProcAddr getInstanceProcAddr;
    VkPipelineCache pipelineCache;                    // may be VK_NULL_HANDLE
    const VkAllocationCallbacks* allocationCallbacks; // may be NULL
    // VK_TRUE if the instance has VK_EXT_debug_utils enabled: objects and passes then get names.
    VkBool32 debugUtilsEnabled;
    // The struct is copied. All zero: the modules call vkAllocateMemory for every object
    // themselves.
    CndAllocator allocator;
    CndMessageCallback message; // may be NULL
    void* messageUser;          // passed to `message` as its first argument
    // VkApplicationInfo::apiVersion of the instance, at least VK_API_VERSION_1_1; a lower version
    // fails with CND_ERROR_UNSUPPORTED. 0 means the version of the physical device. If this version
    // is lower than that of the physical device, nothing newer is used.
    uint32_t apiVersion;
} CndDeviceDesc;

// The modules, as a mask; a mask of 0 means all of them.
typedef enum CndModuleBits {
    CND_MODULE_LIGHTING_BIT = 1,
    CND_MODULE_ENVIRONMENT_BIT = 2,
    CND_MODULE_EXPOSURE_BIT = 4,
    CND_MODULE_BITS_MAX_ENUM = 0x7FFFFFFF
} CndModuleBits;

// Checks whether a physical device has everything that the modules (a mask of CndModuleBits) need:
// Vulkan 1.1, features, limits, linear filtering of R32G32B32A32_SFLOAT (environment), subgroup
// operations (lighting), and memory that the CPU can write. CndDeviceDesc::device is not used and
// may be VK_NULL_HANDLE. If something is missing, returns CND_ERROR_UNSUPPORTED and names all of it
// in `error`, which may be NULL. Creation of a module makes the same check.
CND_API CndResult cndCheckDevice(const CndDeviceDesc* device, uint32_t modules, CndError* error);

// Sets to VK_TRUE every feature that the modules (a mask of CndModuleBits) need, in the structs
// that the host chains into VkDeviceCreateInfo. Other members are left alone. If the chain lacks
// the struct of a feature, returns CND_ERROR_INVALID_ARGUMENT and names the struct in `error`,
// which may be NULL. Lighting and environment need scalarBlockLayout, a member of
// VkPhysicalDeviceVulkan12Features and of VkPhysicalDeviceScalarBlockLayoutFeatures. Exposure needs
// no feature.
CND_API CndResult cndRequireFeatures(uint32_t modules, VkPhysicalDeviceFeatures2* features,
                                     CndError* error);

// GPU time of one pass in one frame, summed over its dispatches.
typedef struct CndKernelTime {
    const char* name; // as in CndPassPlan; in modules without pass plans the name of the kernel;
                      // static storage
    double ms;
} CndKernelTime;

#define CND_MAX_KERNEL_TIMES 24

// One pass of a module and whether it ran in one frame. A pass that has nothing to do is skipped.
// Usually this is known when the frame is recorded, and the skipped pass has no CndKernelTime.
// Sometimes only the GPU can find out. Then the pass has been recorded, `skipped` gives the reason,
// and there is a CndKernelTime too.
typedef struct CndPassPlan {
    const char* name;    // static storage
    const char* skipped; // NULL if the pass ran; otherwise the reason why it did not, static
                         // storage
} CndPassPlan;

#define CND_MAX_PASSES 24

#ifdef __cplusplus
}
#endif
#endif
