// SPDX-License-Identifier: Apache-2.0
// Formats of storage images that the host may choose: what the device must be able to do with them,
// and the format in the code of the shaders.
#pragma once

#include <vector>

#include "gpu/device.h"
#include "gpu/spirv.h"

namespace candelabra::gpu
{

// The access of shaders to a storage image.
enum class StorageUse { Write, ReadAndWrite };

// Throws Failure if kernels cannot use storage images of `format` so. Formats that SPIR-V has no
// name for here are accessed without a format in the shader, which the device must support for
// them. `member` names what the host has set, such as "CndLightingDesc: radianceFormat".
void requireStorage(const Device& device, const char* member, VkFormat format, StorageUse use);

// The code of a shader whose storage image has the format that the host has chosen. It is used
// while a pipeline is created, and then no longer needed.
class FormattedSpirv
{
public:
    // `binding`: number of the image in descriptor set 0. `use`: what the shader does with it.
    // `original` must outlive this object. Code without that binding stays as it is.
    FormattedSpirv(const Spirv& original, uint32_t binding, VkFormat format, StorageUse use);
    const Spirv& get() const { return spirv_; }
    operator const Spirv&() const { return spirv_; }

    FormattedSpirv(const FormattedSpirv&) = delete; // spirv_ refers to words_
    FormattedSpirv& operator=(const FormattedSpirv&) = delete;

private:
    std::vector<uint32_t> words_;
    Spirv spirv_;
};

} // namespace candelabra::gpu
