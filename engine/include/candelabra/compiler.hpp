// SPDX-License-Identifier: Apache-2.0
// C++20 face of compiler.h; link candelabra::compiler.
#pragma once

#include "candelabra/candelabra.hpp"
#include "candelabra/compiler.h"

namespace candelabra
{

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
    // For CndLightingDesc and CndEnvironmentDesc; must outlive the call that takes it.
    CndHostKernels hostKernels(VkDescriptorSetLayout setLayout = VK_NULL_HANDLE) const noexcept
    {
        CndHostKernels out{};
        out.kernels = cndGetKernelCode(handle_, &out.count);
        out.setLayout = setLayout;
        return out;
    }
};

} // namespace candelabra
