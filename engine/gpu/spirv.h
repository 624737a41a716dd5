// SPDX-License-Identifier: Apache-2.0
// Embedded shader modules, and reflection of their interface to check the engine's C++ side
// against.
#pragma once

#include <cstdint>
#include <span>
#include <vector>

#include <vulkan/vulkan_core.h>

namespace candelabra::gpu
{

struct Spirv {
    const char* name; // file name, such as "shade_tiles.comp"; also the label and timer row
    std::span<const uint32_t> words;
};

struct ReflectedBinding {
    uint32_t binding;
    VkDescriptorType type;
    uint32_t count; // array size
    bool operator==(const ReflectedBinding&) const = default;
};

struct Reflection {
    std::vector<ReflectedBinding> bindings; // descriptor set 0, sorted by binding number
    uint32_t pushConstantSize = 0;          // bytes; 0 without push constants
    bool usesHostSet = false;               // descriptor set 1 is used, with whatever bindings
    bool operator==(const Reflection&) const = default;
};

// Reads the bindings and the push constant block of a shader. Throws Failure if it uses a
// descriptor set above 1 or is not valid SPIR-V.
Reflection reflect(const Spirv& spirv);

} // namespace candelabra::gpu
