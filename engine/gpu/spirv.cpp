// SPDX-License-Identifier: Apache-2.0
#include "gpu/spirv.h"

#include <algorithm>
#include <map>
#include <stdexcept>
#include <string>

#include "gpu/failure.h"
#include "gpu/spirv_words.h"

namespace candelabra::gpu
{
namespace
{

struct Decorations {
    uint32_t binding = ~0u, set = 0, arrayStride = 0;
    std::map<uint32_t, uint32_t> memberOffset, memberMatrixStride;
};

class Module
{
public:
    explicit Module(const Spirv& spirv) : name_(spirv.name), words_(spirv.words)
    {
        constexpr uint32_t magic = 0x07230203;
        bool whole = words_.size() >= headerWords && words_[0] == magic;
        uint32_t last = 0;
        bool inFunctions = false; // reflection needs nothing after the first function
        for (size_t i = headerWords; whole && i < words_.size();) {
            const uint32_t* at = &words_[i];
            const size_t length = at[0] >> 16;
            whole = length > 0 && length <= words_.size() - i;
            last = opcode(at);
            inFunctions = inFunctions || last == OpFunction;
            whole = whole && length >= leastLength(last, at, length);
            if (whole && !inFunctions)
                read(last, at);
            i += length;
        }
        if (!whole || last != OpFunctionEnd) // every shader ends with a function
            failArgument(name_ + " is not SPIR-V, or is truncated");
    }

    Reflection reflection() const
    {
        Reflection result;
        for (const uint32_t* variable : variables_) {
            const uint32_t storage = variable[3];
            const auto found = decorations_.find(variable[2]);
            const bool isBound = found != decorations_.end() && found->second.binding != ~0u;
            if (isBound && found->second.set > 1)
                failUnsupported("shader " + name_ + " uses a descriptor set above 1");
            if (isBound && found->second.set == 1) {
                result.usesHostSet = true;
                continue;
            }
            const uint32_t* type = definition(definition(variable[1], OpTypePointer)[3]);
            if (storage == StoragePushConstant)
                result.pushConstantSize = structSize(type[1]);
            if (!isBound)
                continue;
            uint32_t count = 1;
            if (opcode(type) == OpTypeArray) {
                count = definition(type[3], OpConstant)[3];
                type = definition(type[2]);
            }
            result.bindings.push_back(
                {found->second.binding, descriptorType(storage, type), count});
        }
        std::sort(result.bindings.begin(), result.bindings.end(),
                  [](auto& a, auto& b) { return a.binding < b.binding; });
        return result;
    }

private:
    void read(uint32_t op, const uint32_t* at)
    {
        if (op >= OpTypeInt && op <= OpTypePointer)
            definitions_[at[1]] = at;
        else if (op == OpConstant)
            definitions_[at[2]] = at;
        else if (op == OpVariable && isInterface(at[3]))
            variables_.push_back(at);
        else if (op == OpDecorate && at[2] == DecorationBinding)
            decorations_[at[1]].binding = at[3];
        else if (op == OpDecorate && at[2] == DecorationDescriptorSet)
            decorations_[at[1]].set = at[3];
        else if (op == OpDecorate && at[2] == DecorationArrayStride)
            decorations_[at[1]].arrayStride = at[3];
        else if (op == OpMemberDecorate && at[3] == DecorationOffset)
            decorations_[at[1]].memberOffset[at[2]] = at[4];
        else if (op == OpMemberDecorate && at[3] == DecorationMatrixStride)
            decorations_[at[1]].memberMatrixStride[at[2]] = at[4];
    }

    // Returns the least number of words that an instruction must have for this class to read it.
    static size_t leastLength(uint32_t op, const uint32_t* at, size_t length)
    {
        switch (op) {
        case OpTypeImage:
            return 9;
        case OpTypeInt:
        case OpTypeVector:
        case OpTypeMatrix:
        case OpTypeArray:
        case OpTypePointer:
        case OpConstant:
        case OpVariable:
        case OpLoad: // FormattedSpirv reads it
            return 4;
        case OpTypeFloat:
            return 3;
        case OpDecorate: {
            const bool hasValue =
                length > 2 && (at[2] == DecorationBinding || at[2] == DecorationDescriptorSet ||
                               at[2] == DecorationArrayStride);
            return hasValue ? 4 : 3;
        }
        case OpMemberDecorate: {
            const bool hasValue =
                length > 3 && (at[3] == DecorationOffset || at[3] == DecorationMatrixStride);
            return hasValue ? 5 : 4;
        }
        default:
            return op >= OpTypeInt && op <= OpTypePointer ? 2 : 1;
        }
    }

    static bool isInterface(uint32_t storage)
    {
        return storage == StorageUniformConstant || storage == StorageUniform ||
               storage == StoragePushConstant || storage == StorageStorageBuffer;
    }

    const uint32_t* definition(uint32_t id) const { return definitions_.at(id); }
    // Returns a definition that must have opcode `op`, which guarantees how many words can be read.
    const uint32_t* definition(uint32_t id, uint32_t op) const
    {
        const uint32_t* at = definition(id);
        if (opcode(at) != op)
            throw std::out_of_range("another opcode");
        return at;
    }

    uint32_t structSize(uint32_t id) const
    {
        const uint32_t* type = definition(id);
        const uint32_t members = (type[0] >> 16) - 2;
        const Decorations& layout = decorations_.at(id);
        uint32_t size = 0;
        for (uint32_t m = 0; m < members; ++m) {
            const auto stride = layout.memberMatrixStride.find(m);
            const uint32_t matrixStride =
                stride == layout.memberMatrixStride.end() ? 0 : stride->second;
            size = std::max(size, layout.memberOffset.at(m) +
                                      typeSize(member(type[2 + m], id), matrixStride));
        }
        return size;
    }

    // Checks that a member type is defined before the type `of` that contains it: no cycles.
    uint32_t member(uint32_t id, uint32_t of) const
    {
        if (definition(id) >= definition(of))
            failArgument(name_ +
                         " is SPIR-V with a type that contains itself or a type defined later");
        return id;
    }

    uint32_t typeSize(uint32_t id, uint32_t matrixStride) const
    {
        const uint32_t* type = definition(id);
        switch (opcode(type)) {
        case OpTypeInt:
        case OpTypeFloat:
            return type[2] / 8;
        case OpTypeVector:
            return typeSize(member(type[2], id), 0) * type[3];
        case OpTypeMatrix:
            return (type[3] - 1) * matrixStride + typeSize(member(type[2], id), 0);
        case OpTypeArray:
            return definition(type[3], OpConstant)[3] * decorations_.at(id).arrayStride;
        default:
            return structSize(id);
        }
    }

    static VkDescriptorType descriptorType(uint32_t storage, const uint32_t* type)
    {
        if (storage == StorageStorageBuffer)
            return VK_DESCRIPTOR_TYPE_STORAGE_BUFFER;
        if (storage == StorageUniform)
            return VK_DESCRIPTOR_TYPE_UNIFORM_BUFFER;
        switch (opcode(type)) {
        case OpTypeSampler:
            return VK_DESCRIPTOR_TYPE_SAMPLER;
        case OpTypeSampledImage:
            return VK_DESCRIPTOR_TYPE_COMBINED_IMAGE_SAMPLER;
        case OpTypeImage: {
            const bool sampled = type[7] == 1; // operand "Sampled"
            if (type[3] == DimBuffer)
                return sampled ? VK_DESCRIPTOR_TYPE_UNIFORM_TEXEL_BUFFER
                               : VK_DESCRIPTOR_TYPE_STORAGE_TEXEL_BUFFER;
            return sampled ? VK_DESCRIPTOR_TYPE_SAMPLED_IMAGE : VK_DESCRIPTOR_TYPE_STORAGE_IMAGE;
        }
        default:
            throw std::out_of_range("no resource");
        }
    }

    std::string name_;
    std::span<const uint32_t> words_;
    std::map<uint32_t, const uint32_t*> definitions_; // result id -> first word of the instruction
    std::map<uint32_t, Decorations> decorations_;
    std::vector<const uint32_t*> variables_;
};

} // namespace

Reflection reflect(const Spirv& spirv)
{
    try {
        return Module(spirv).reflection();
    } catch (const std::out_of_range&) {
        failArgument(std::string(spirv.name) +
                     " is SPIR-V that refers to an id that it does not define");
    }
}

} // namespace candelabra::gpu
