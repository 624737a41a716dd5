// SPDX-License-Identifier: Apache-2.0
// The specular lobe's directional albedo over alpha and NoV (shaders/shared/dfg.h), computed on the
// device; lighting and environment own one each.
#pragma once

#include "gpu/kernel.h"
#include "shared/dfg.h"

namespace candelabra::tables
{

class DfgTable
{
public:
    // `device` must outlive it.
    explicit DfgTable(const gpu::Device& device);
    DfgTable(const DfgTable&) = delete;
    DfgTable& operator=(const DfgTable&) = delete;

    // The first call records the kernel that fills the table (one scope of the frame's timer, 28
    // million evaluations); later ones nothing. The caller's next barrier makes it visible. That
    // first recording must be submitted before any that reads the table.
    void recordFill(const gpu::Frame& frame) noexcept;

    bool filled() const { return recorded_; }

    // For Binding::ofTexels, at the DFG_BINDING of lib/dfg.glsl. 147 KB.
    const gpu::Buffer& buffer() const { return entries_; }

private:
    gpu::Kernel<gpu::DfgTableParams> kernel_;
    gpu::Bindings bindings_;
    gpu::Buffer entries_;
    bool recorded_ = false;
};

} // namespace candelabra::tables
