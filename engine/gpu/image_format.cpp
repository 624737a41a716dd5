// SPDX-License-Identifier: Apache-2.0
#include "gpu/image_format.h"

#include <algorithm>
#include <initializer_list>
#include <span>
#include <string>

#include "gpu/format_name.h"
#include "gpu/spirv_words.h"

namespace candelabra::gpu
{
namespace
{

constexpr size_t boundWord = 3;       // of the header: one more than the largest id
constexpr size_t imageFormatWord = 8; // of OpTypeImage

// Returns the format as shaders name it. Formats whose names need a capability, and a feature of
// the device, stay unknown.
uint32_t spirvFormat(VkFormat format)
{
    switch (format) {
    case VK_FORMAT_R32G32B32A32_SFLOAT:
        return FormatRgba32f;
    case VK_FORMAT_R16G16B16A16_SFLOAT:
        return FormatRgba16f;
    case VK_FORMAT_R8G8B8A8_UNORM:
        return FormatRgba8;
    default:
        return FormatUnknown;
    }
}

uint32_t instruction(uint32_t op, uint32_t words)
{
    return words << 16 | op;
}

// Calls `visit` with each instruction of a module that reflect() has read.
template <typename Visit>
void forEach(std::span<const uint32_t> words, Visit&& visit)
{
    for (size_t i = headerWords; i < words.size(); i += words[i] >> 16)
        visit(words.subspan(i, words[i] >> 16));
}

// Returns the module up to its first function: types, constants and the variables of its interface.
std::span<const uint32_t> declarationsOf(std::span<const uint32_t> words)
{
    size_t i = headerWords;
    while (i < words.size() && opcode(&words[i]) != OpFunction)
        i += words[i] >> 16;
    return words.first(i);
}

// The ids that declare one binding of descriptor set 0.
struct Declaration {
    uint32_t variable = 0;           // 0: the shader has no such binding
    const uint32_t* image = nullptr; // the OpTypeImage
};

Declaration declarationOf(std::span<const uint32_t> words, uint32_t binding)
{
    std::vector<uint32_t> hasBinding, isHosts;
    std::vector<std::span<const uint32_t>> types, variables;
    forEach(declarationsOf(words), [&](std::span<const uint32_t> at) {
        const uint32_t op = opcode(at.data());
        if (op == OpDecorate && at[2] == DecorationBinding && at[3] == binding)
            hasBinding.push_back(at[1]);
        else if (op == OpDecorate && at[2] == DecorationDescriptorSet && at[3] != 0)
            isHosts.push_back(at[1]);
        else if (op == OpTypeImage || op == OpTypePointer)
            types.push_back(at);
        else if (op == OpVariable)
            variables.push_back(at);
    });
    const auto holds = [](const std::vector<uint32_t>& ids, uint32_t id) {
        return std::find(ids.begin(), ids.end(), id) != ids.end();
    };
    const auto typeOf = [&](uint32_t id) {
        const auto found = std::find_if(types.begin(), types.end(),
                                        [&](const auto& type) { return type[1] == id; });
        return found == types.end() ? nullptr : found->data();
    };
    for (const auto& variable : variables) {
        if (!holds(hasBinding, variable[2]) || holds(isHosts, variable[2]))
            continue;
        const uint32_t* pointer = typeOf(variable[1]);
        const uint32_t* image = pointer ? typeOf(pointer[3]) : nullptr;
        if (image && opcode(image) == OpTypeImage)
            return {variable[2], image};
    }
    return {};
}

void append(std::vector<uint32_t>& out, std::span<const uint32_t> words)
{
    out.insert(out.end(), words.begin(), words.end());
}

void append(std::vector<uint32_t>& out, std::initializer_list<uint32_t> words)
{
    out.insert(out.end(), words.begin(), words.end());
}

// Returns the module with a type of its own for one image, because images of the host may have the
// same type.
std::vector<uint32_t> withFormat(std::span<const uint32_t> words, const Declaration& declared,
                                 uint32_t format, StorageUse use)
{
    std::vector<uint32_t> out(words.begin(), words.begin() + headerWords);
    const uint32_t image = out[boundWord]++, pointer = out[boundWord]++;
    if (format == FormatUnknown) {
        append(out, {instruction(OpCapability, 2), CapabilityStorageImageWriteWithoutFormat});
        if (use == StorageUse::ReadAndWrite)
            append(out, {instruction(OpCapability, 2), CapabilityStorageImageReadWithoutFormat});
    }
    forEach(words, [&](std::span<const uint32_t> at) {
        const uint32_t op = opcode(at.data());
        const size_t copy = out.size();
        if (op == OpVariable && at[2] == declared.variable) {
            const size_t type = out.size();
            append(out, std::span(declared.image, declared.image[0] >> 16));
            out[type + 1] = image;
            out[type + imageFormatWord] = format;
            append(out, {instruction(OpTypePointer, 4), pointer, at[3], image});
            append(out, at);
            out[out.size() - at.size() + 1] = pointer;
            return;
        }
        append(out, at);
        if (op == OpLoad && at[3] == declared.variable)
            out[copy + 1] = image;
    });
    return out;
}

} // namespace

void requireStorage(const Device& device, const char* member, VkFormat format, StorageUse use)
{
    const bool named = spirvFormat(format) != FormatUnknown;
    if (!named && device.apiVersion < VK_API_VERSION_1_3)
        failUnsupported(std::string(member) + ": storage images of " + formatName(format) +
                        " need Vulkan 1.3, of VkApplicationInfo::apiVersion and of the device");
    VkFormatProperties3 more{.sType = VK_STRUCTURE_TYPE_FORMAT_PROPERTIES_3};
    VkFormatProperties2 properties{.sType = VK_STRUCTURE_TYPE_FORMAT_PROPERTIES_2,
                                   .pNext = named ? nullptr : &more};
    device.GetPhysicalDeviceFormatProperties2(device.physicalDevice, format, &properties);
    VkFormatFeatureFlags2 needs = VK_FORMAT_FEATURE_2_STORAGE_IMAGE_BIT;
    if (!named)
        needs |= VK_FORMAT_FEATURE_2_STORAGE_WRITE_WITHOUT_FORMAT_BIT;
    if (!named && use == StorageUse::ReadAndWrite)
        needs |= VK_FORMAT_FEATURE_2_STORAGE_READ_WITHOUT_FORMAT_BIT;
    const VkFormatFeatureFlags2 has =
        more.optimalTilingFeatures | properties.formatProperties.optimalTilingFeatures;
    if ((has & needs) != needs)
        failUnsupported(std::string(member) + ": the device has no storage images of " +
                        formatName(format) +
                        (named ? "" : " that shaders access without naming it"));
}

FormattedSpirv::FormattedSpirv(const Spirv& original, uint32_t binding, VkFormat format,
                               StorageUse use)
    : spirv_(original)
{
    const Declaration declared = declarationOf(original.words, binding);
    if (!declared.variable || declared.image[imageFormatWord] == spirvFormat(format))
        return;
    words_ = withFormat(original.words, declared, spirvFormat(format), use);
    spirv_.words = words_;
}

} // namespace candelabra::gpu
