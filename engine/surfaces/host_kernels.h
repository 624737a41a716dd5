// SPDX-License-Identifier: Apache-2.0
// Kernels that contain functions of the host and replace built-in ones (CndHostKernels).
#pragma once

#include <atomic>
#include <vector>

#include "candelabra/surfaces.h"
#include "gpu/spirv.h"

namespace candelabra::surfaces
{

class HostKernels
{
public:
    // Throws gpu::Failure, with a sentence, if `given` has a kernel that cannot be replaced, or
    // whose bindings or parameters are not those of this version. With the layout
    // CND_GBUFFER_CUSTOM, of() requires every kernel that reads the G-buffer to be the host's.
    HostKernels(const CndHostKernels& given, CndGBufferLayout layout);

    // Tells whether the host finds the visible points of lights (CND_HOST_VISIBLE_POINTS_BIT).
    bool findsPoints() const { return findsPoints_; }
    // These two may be called on several threads at the same time. They throw gpu::Failure if the
    // host's kernel is required and was not given.
    //
    // Returns the host's kernel that replaces `builtIn`, or `builtIn` if there is none.
    const gpu::Spirv& of(const gpu::Spirv& builtIn) const;
    // The same for a kernel that frames may use from now on: they need a set if it uses the host's.
    const gpu::Spirv& used(const gpu::Spirv& builtIn) const;
    VkDescriptorSetLayout setLayout() const { return setLayout_; }
    // Throws gpu::Failure if `set`, the host's descriptor set in a frame, is null although a kernel
    // that used() returned uses it. `frame`: name of the frame's type, for the message.
    void requireSet(const char* frame, VkDescriptorSet set) const;

private:
    struct Code {
        const gpu::Spirv* builtIn;
        std::vector<uint32_t> words;
        gpu::Spirv spirv;
        bool usesSet, findsPoints;
    };
    const Code* find(const gpu::Spirv& builtIn) const; // null: the built-in one is used

    std::vector<Code> kernels_;
    VkDescriptorSetLayout setLayout_;
    mutable std::atomic<bool> needsSet_{false}; // a kernel of used() uses the host's set
    bool readSurfaces_;          // CND_GBUFFER_CUSTOM: every kernel that reads it is the host's
    bool hasShadowTerm_ = false; // kernels that evaluate lights are the host's
    bool findsPoints_ = false;
};

} // namespace candelabra::surfaces
