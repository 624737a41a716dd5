// SPDX-License-Identifier: Apache-2.0
// Removes lights from the lists of blocks that occluders hide from all samples of a block
// (prove_dark.comp).
#pragma once

#include "clusters/clusters.h"
#include "view/frame_plan.h"
#include "view/shadows.h"

namespace candelabra::lighting
{

class DarkProofs
{
public:
    // All arguments must outlive this object.
    DarkProofs(const Module& module, const Clusters& clusters, const Shadows& shadows,
               uint32_t slots);
    DarkProofs(const DarkProofs&) = delete;
    DarkProofs& operator=(const DarkProofs&) = delete;

    struct Inputs {
        const surfaces::FrameUniforms& uniforms;
        const gpu::Buffer &core, &shapes, &counters;
    };
    void writeBindings(const FramePlan& plan, const Inputs& inputs) const;
    // Tests the lists of blocks of all types. The caller puts barriers before and after.
    void record(const gpu::Frame& frame, const FramePlan& plan) const noexcept;

private:
    const Module& module_;
    const Clusters& clusters_;
    const Shadows& shadows_;
    uint32_t capacity_; // of records
    gpu::Buffer records_;
    gpu::Bindings askSets_;   // per slot and type
    gpu::Bindings proveSets_; // per slot
};

} // namespace candelabra::lighting
