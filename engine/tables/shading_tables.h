// SPDX-License-Identifier: Apache-2.0
// The tables that shading with lights reads, on the device: directional albedos (shared/dfg.h),
// which the device computes, and linearly transformed cosines (shared/ltc.h), which are copied.
#pragma once

#include "tables/dfg_table.h"

namespace candelabra::tables
{

class ShadingTables
{
public:
    // `device` must outlive it.
    explicit ShadingTables(const gpu::Device& device);

    // Fills each table in the first recording that asks for it: the transformed cosines always, the
    // directional albedos on demand. The caller's next barrier makes them visible.
    void record(const gpu::Frame& frame, bool directionalAlbedo) noexcept;
    bool directionalAlbedoFilled() const { return dfg_.filled(); }

    // For Binding::ofTexels.
    const gpu::Buffer& directionalAlbedo() const { return dfg_.buffer(); }
    const gpu::Buffer& transformedCosines() const { return ltc_; }

private:
    DfgTable dfg_;
    gpu::Buffer ltc_;
    bool ltcFilled_ = false;
};

} // namespace candelabra::tables
