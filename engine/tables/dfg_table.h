// SPDX-License-Identifier: Apache-2.0
// The directional albedo of the specular lobe over alpha and NoV (shaders/shared/dfg.h), computed
// on the device. The lighting and environment modules own one table each.
#pragma once

#include "gpu/kernel.h"
#include "shared/dfg.h"

namespace candelabra::tables
{

class DfgTable
{
public:
    // `device` must outlive the table.
    explicit DfgTable(const gpu::Device& device);
    DfgTable(const DfgTable&) = delete;
    DfgTable& operator=(const DfgTable&) = delete;

    // The first call records the kernel that fills the table (one scope of the frame's timer, 28
    // million evaluations); later calls record nothing. The caller's next barrier makes the table
    // visible. The first recording must be submitted before any recording that reads the table.
    void recordFill(const gpu::Frame& frame) noexcept;

    bool filled() const { return recorded_; }

    // The table, 147 KB, to be bound with Binding::ofTexels at DFG_BINDING (lib/dfg.glsl).
    const gpu::Buffer& buffer() const { return entries_; }

private:
    gpu::Kernel<gpu::DfgTableParams> kernel_;
    gpu::Bindings bindings_;
    gpu::Buffer entries_;
    bool recorded_ = false;
};

} // namespace candelabra::tables
