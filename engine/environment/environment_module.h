// SPDX-License-Identifier: Apache-2.0
// The environment module, which candelabra/environment.h declares: lights surfaces by an image
// of the far surroundings.
#pragma once

#include <vector>

#include "gpu/kernel.h"
#include "shared/environment_data.h"
#include "surfaces/frame_uniforms.h"
#include "surfaces/host_gbuffer.h"
#include "surfaces/host_kernels.h"
#include "tables/dfg_table.h"

namespace candelabra::environment
{

class Environment
{
public:
    Environment(const CndDeviceDesc& device, const CndEnvironmentDesc& desc);
    Environment(const Environment&) = delete; // not copied or moved: members point to device_
    Environment& operator=(const Environment&) = delete;

    // These throw gpu::Failure on arguments out of range; once recording starts nothing can fail.
    void recordMap(VkCommandBuffer cmd, const CndEnvironmentMap& map);
    void record(VkCommandBuffer cmd, const CndEnvironmentFrame& frame);
    CndResult stats(uint32_t slot, CndEnvironmentStats& stats) const noexcept;
    const gpu::Device& device() const { return device_; }

private:
    void validate(const CndEnvironmentFrame& frame) const;
    void recordLayouts(const gpu::Frame& f) const noexcept;
    void recordCube(const gpu::Frame& f, const CndEnvironmentMap& map) const noexcept;
    void recordPrefiltering(const gpu::Frame& f) const noexcept;
    void recordIrradiance(const gpu::Frame& f, const CndEnvironmentMap& map) const noexcept;
    // The timer's slot for recordMap, which follows those of the frames.
    uint32_t mapSlot() const { return uint32_t(recorded_.size()); }

    struct Sets {
        gpu::Bindings cube, mip, prefilter, cells, irradiance, shade;
    };

    gpu::Device device_;
    CndEnvironmentDesc desc_;
    surfaces::GBufferSource gbuffer_;
    surfaces::FrameUniforms uniforms_;
    gpu::Timer timer_;
    tables::DfgTable dfg_;
    gpu::Kernel<gpu::EnvironmentCubeParams> cube_;
    gpu::Kernel<gpu::EnvironmentMipParams> mip_;
    gpu::Kernel<gpu::EnvironmentPrefilterParams> prefilter_;
    gpu::Kernel<gpu::EnvironmentCellsParams> cellsKernel_;
    gpu::Kernel<gpu::NoParams> irradianceKernel_;
    surfaces::HostKernels hostKernels_;
    gpu::Kernel<gpu::ShadeEnvironmentParams> shade_;
    Sets sets_;
    gpu::CubeImage source_;      // the environment as a cube map, all mips
    gpu::CubeImage prefiltered_; // the environment convolved with the GGX lobe, one mip level per
                                 // alpha
    gpu::CubeImage irradiance_;
    gpu::Buffer lobeSamples_; // of each level of prefiltered_ but the first
    gpu::Buffer cells_;
    gpu::Handle<VkSampler> sampler_;
    std::vector<bool> recorded_; // per frame slot: a frame has been recorded in it
    bool mapped_ = false;
};

} // namespace candelabra::environment
