// SPDX-License-Identifier: Apache-2.0
// The numbers of SPIR-V that the engine needs to read and change modules, and how their words are
// divided: SPIR-V specification 1.6, sections 2.3 and 3.
#pragma once

#include <cstddef>
#include <cstdint>

namespace candelabra::gpu
{

// Opcodes, decorations, storage classes, dimensions, capabilities and image formats.
enum : uint32_t {
    OpCapability = 17,
    OpTypeInt = 21,
    OpTypeFloat = 22,
    OpTypeVector = 23,
    OpTypeMatrix = 24,
    OpTypeImage = 25,
    OpTypeSampler = 26,
    OpTypeSampledImage = 27,
    OpTypeArray = 28,
    OpTypeStruct = 30,
    OpTypePointer = 32,
    OpConstant = 43,
    OpFunction = 54,
    OpFunctionEnd = 56,
    OpVariable = 59,
    OpLoad = 61,
    OpDecorate = 71,
    OpMemberDecorate = 72,
    DecorationArrayStride = 6,
    DecorationMatrixStride = 7,
    DecorationBinding = 33,
    DecorationDescriptorSet = 34,
    DecorationOffset = 35,
    StorageUniformConstant = 0,
    StorageUniform = 2,
    StoragePushConstant = 9,
    StorageStorageBuffer = 12,
    DimBuffer = 5,
    CapabilityStorageImageReadWithoutFormat = 55,
    CapabilityStorageImageWriteWithoutFormat = 56,
    FormatUnknown = 0,
    FormatRgba32f = 1,
    FormatRgba16f = 2,
    FormatRgba8 = 4,
};

constexpr size_t headerWords = 5; // before the first instruction

// Returns the opcode of the instruction whose first word this is. Its length is in the upper half.
inline uint32_t opcode(const uint32_t* at)
{
    return at[0] & 0xFFFFu;
}

} // namespace candelabra::gpu
