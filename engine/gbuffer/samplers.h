// SPDX-License-Identifier: Apache-2.0
// Creates one sampler for each combination of modes that is used.
#pragma once

#include <map>
#include <tuple>
#include <vector>

#include "gbuffer/geometry.h"
#include "gpu/handle.h"

namespace candelabra::gbuffer
{

class SamplerCache
{
public:
    explicit SamplerCache(const gpu::Device& device) : device_(device) {}
    // Throws gpu::Failure.
    VkSampler get(Wrap wrapU, Wrap wrapV, bool nearest);
    std::vector<gpu::Handle<VkSampler>> take() { return std::move(samplers_); }

private:
    const gpu::Device& device_;
    std::map<std::tuple<Wrap, Wrap, bool>, VkSampler> known_;
    std::vector<gpu::Handle<VkSampler>> samplers_;
};

} // namespace candelabra::gbuffer
