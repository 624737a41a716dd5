// SPDX-License-Identifier: Apache-2.0
// Every Vulkan function that the engine calls. The engine does not load Vulkan: the table is filled
// through the host's vkGetInstanceProcAddr.
#pragma once

// Functions that query the physical device, before and after there is a device.
#define CND_INSTANCE_FUNCTIONS(X)                                                                  \
    X(EnumerateDeviceExtensionProperties)                                                          \
    X(GetDeviceProcAddr)                                                                           \
    X(GetPhysicalDeviceFeatures2)                                                                  \
    X(GetPhysicalDeviceFormatProperties2)                                                          \
    X(GetPhysicalDeviceMemoryProperties)                                                           \
    X(GetPhysicalDeviceProperties2)                                                                \
    X(GetPhysicalDeviceQueueFamilyProperties)

// All modules together call these. Every one of them is part of Vulkan 1.0.
#define CND_DEVICE_FUNCTIONS(X)                                                                    \
    X(AllocateDescriptorSets)                                                                      \
    X(AllocateMemory)                                                                              \
    X(BindBufferMemory)                                                                            \
    X(BindImageMemory)                                                                             \
    X(CmdBindDescriptorSets)                                                                       \
    X(CmdBindPipeline)                                                                             \
    X(CmdCopyBuffer)                                                                               \
    X(CmdCopyBufferToImage)                                                                        \
    X(CmdCopyImageToBuffer)                                                                        \
    X(CmdDispatch)                                                                                 \
    X(CmdDispatchIndirect)                                                                         \
    X(CmdFillBuffer)                                                                               \
    X(CmdPipelineBarrier)                                                                          \
    X(CmdPushConstants)                                                                            \
    X(CmdResetQueryPool)                                                                           \
    X(CmdUpdateBuffer)                                                                             \
    X(CmdWriteTimestamp)                                                                           \
    X(CreateBuffer)                                                                                \
    X(CreateBufferView)                                                                            \
    X(CreateComputePipelines)                                                                      \
    X(CreateDescriptorPool)                                                                        \
    X(CreateDescriptorSetLayout)                                                                   \
    X(CreateImage)                                                                                 \
    X(CreateImageView)                                                                             \
    X(CreatePipelineLayout)                                                                        \
    X(CreateQueryPool)                                                                             \
    X(CreateSampler)                                                                               \
    X(CreateShaderModule)                                                                          \
    X(DestroyBuffer)                                                                               \
    X(DestroyBufferView)                                                                           \
    X(DestroyDescriptorPool)                                                                       \
    X(DestroyDescriptorSetLayout)                                                                  \
    X(DestroyImage)                                                                                \
    X(DestroyImageView)                                                                            \
    X(DestroyPipeline)                                                                             \
    X(DestroyPipelineLayout)                                                                       \
    X(DestroyQueryPool)                                                                            \
    X(DestroySampler)                                                                              \
    X(DestroyShaderModule)                                                                         \
    X(FreeMemory)                                                                                  \
    X(GetBufferMemoryRequirements)                                                                 \
    X(GetImageMemoryRequirements)                                                                  \
    X(GetQueryPoolResults)                                                                         \
    X(MapMemory)                                                                                   \
    X(UpdateDescriptorSets)

// Functions that only the raster pass and the program call; some are part of Vulkan 1.3. The
// pointers are null in devices of modules.
#define CND_RASTER_FUNCTIONS(X)                                                                    \
    X(CmdBeginRendering)                                                                           \
    X(CmdBindIndexBuffer)                                                                          \
    X(CmdBindVertexBuffers)                                                                        \
    X(CmdDraw)                                                                                     \
    X(CmdDrawIndexedIndirect)                                                                      \
    X(CmdDrawIndirect)                                                                             \
    X(CmdEndRendering)                                                                             \
    X(CmdPipelineBarrier2)                                                                         \
    X(CmdSetCullMode)                                                                              \
    X(CmdSetDepthCompareOp)                                                                        \
    X(CmdSetFrontFace)                                                                             \
    X(CmdSetScissor)                                                                               \
    X(CmdSetViewport)                                                                              \
    X(CreateGraphicsPipelines)

// VK_EXT_debug_utils; the pointers are null if the host did not enable it.
#define CND_DEBUG_FUNCTIONS(X)                                                                     \
    X(CmdBeginDebugUtilsLabelEXT)                                                                  \
    X(CmdEndDebugUtilsLabelEXT)                                                                    \
    X(SetDebugUtilsObjectNameEXT)
