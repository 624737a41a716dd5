// SPDX-License-Identifier: Apache-2.0
#include "gbuffer/samplers.h"

namespace candelabra::gbuffer
{
namespace
{

VkSamplerAddressMode addressMode(Wrap wrap)
{
    switch (wrap) {
    case Wrap::Repeat:
        return VK_SAMPLER_ADDRESS_MODE_REPEAT;
    case Wrap::Mirror:
        return VK_SAMPLER_ADDRESS_MODE_MIRRORED_REPEAT;
    case Wrap::Clamp:
        break;
    }
    return VK_SAMPLER_ADDRESS_MODE_CLAMP_TO_EDGE;
}

} // namespace

VkSampler SamplerCache::get(Wrap wrapU, Wrap wrapV, bool nearest)
{
    const auto key = std::tuple(wrapU, wrapV, nearest);
    if (const auto found = known_.find(key); found != known_.end())
        return found->second;
    const VkFilter filter = nearest ? VK_FILTER_NEAREST : VK_FILTER_LINEAR;
    const VkSamplerCreateInfo info{.sType = VK_STRUCTURE_TYPE_SAMPLER_CREATE_INFO,
                                   .magFilter = filter,
                                   .minFilter = filter,
                                   .mipmapMode = nearest ? VK_SAMPLER_MIPMAP_MODE_NEAREST
                                                         : VK_SAMPLER_MIPMAP_MODE_LINEAR,
                                   .addressModeU = addressMode(wrapU),
                                   .addressModeV = addressMode(wrapV),
                                   .addressModeW = VK_SAMPLER_ADDRESS_MODE_REPEAT,
                                   .maxLod = VK_LOD_CLAMP_NONE};
    VkSampler sampler{};
    gpu::check(device_.CreateSampler(device_.handle, &info, device_.allocationCallbacks, &sampler),
               "creating a texture sampler");
    samplers_.push_back(gpu::Handle(device_, sampler)); // owned before the vector may need memory
    device_.name(VK_OBJECT_TYPE_SAMPLER, sampler, "material sampler");
    known_.emplace(key, sampler);
    return sampler;
}

} // namespace candelabra::gbuffer
