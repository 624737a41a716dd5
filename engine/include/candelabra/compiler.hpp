// SPDX-License-Identifier: Apache-2.0
// The C++ interface of candelabra/compiler.h. Link candelabra::compiler to use it.
#pragma once

#include "candelabra/candelabra.hpp"
#include "candelabra/compiler.h"

namespace candelabra
{

// Owner of the kernels compiled by cndCompileKernels.
class CompiledKernels : public detail::Owner<CndCompiledKernels, cndDestroyCompiledKernels>
{
public:
    using Owner::Owner;

    static Result<CompiledKernels> create(CndCompileDesc desc) noexcept
    {
        desc.structSize = sizeof desc;
        CndCompiledKernels kernels = nullptr;
        CndError error{};
        if (cndCompileKernels(&desc, &kernels, &error) != CND_SUCCESS)
            return error;
        return CompiledKernels(kernels);
    }
    // Returns the kernels, for CndLightingDesc or CndEnvironmentDesc. `setLayout` is the layout of
    // their descriptor set 1. This object must outlive the call that creates the module.
    CndHostKernels hostKernels(VkDescriptorSetLayout setLayout = VK_NULL_HANDLE) const noexcept
    {
        CndHostKernels out{};
        out.kernels = cndGetKernelCode(handle_, &out.count);
        out.setLayout = setLayout;
        return out;
    }
};

} // namespace candelabra
