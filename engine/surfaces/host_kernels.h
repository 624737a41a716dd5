// SPDX-License-Identifier: Apache-2.0
// Kernels with functions of the host's in them, in place of the built-in ones.
#pragma once

#include <string>
#include <vector>

#include "candelabra/surfaces.h"
#include "gpu/spirv.h"

namespace candelabra::surfaces
{

class HostKernels
{
public:
    // Throws gpu::Failure, with a sentence, on what is no kernel, or none of this version.
    // `layout`: CND_GBUFFER_CUSTOM needs all that read the G-buffer.
    HostKernels(const CndHostKernels& given, CndGBufferLayout layout);

    bool empty() const { return kernels_.empty(); }
    // The host's in place of `builtIn`, or that. Throws gpu::Failure when the host's is needed and
    // was not given.
    const gpu::Spirv& of(const gpu::Spirv& builtIn) const;
    VkDescriptorSetLayout setLayout() const { return setLayout_; }
    // Throws gpu::Failure when a kernel that was taken reads the set of a frame, and it is missing.
    // `frame`: its type, for the message.
    void requireSet(const char* frame, VkDescriptorSet set) const;

private:
    struct Code {
        const gpu::Spirv* builtIn;
        std::vector<uint32_t> words;
        gpu::Spirv spirv;
        bool usesSet;
    };

    std::vector<Code> kernels_;
    VkDescriptorSetLayout setLayout_;
    mutable bool needsSet_ = false; // a kernel that of() gave away uses the set
    bool readSurfaces_;             // every kernel that reads the G-buffer is the host's
};

} // namespace candelabra::surfaces
