// SPDX-License-Identifier: Apache-2.0
// Embedded shader modules, and what the engine reads back out of them to check its own C++ side.
#pragma once

#include <cstdint>
#include <span>
#include <vector>

#include <vulkan/vulkan_core.h>

namespace candelabra::gpu
{

struct Spirv {
    const char* name; // file name, e.g. "shade_tiles.comp": also label and timer row
    std::span<const uint32_t> words;
};

struct ReflectedBinding {
    uint32_t binding;
    VkDescriptorType type;
    uint32_t count; // array size
    bool operator==(const ReflectedBinding&) const = default;
};

struct Reflection {
    std::vector<ReflectedBinding> bindings; // descriptor set 0, by binding number
    uint32_t pushConstantSize = 0;          // bytes, 0 without push constants
    bool usesHostSet = false;               // descriptor set 1, of whatever bindings
    bool operator==(const Reflection&) const = default;
};

// Reads bindings and the push constant block. Throws Failure on a module that uses a set above 1,
// or is none.
Reflection reflect(const Spirv& spirv);

} // namespace candelabra::gpu
