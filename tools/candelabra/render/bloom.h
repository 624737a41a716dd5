// SPDX-License-Identifier: Apache-2.0
// Bloom spreads a share of the light of every pixel over the picture, as an eye scatters it, so
// that lamps look bright (decision 66).
#pragma once

#include <vector>

#include "gpu/kernel.h"
#include "io/parse.h"
#include "shared/bloom.h"

namespace candelabra::app
{

// Returns the share of the scattered light that each coarser level of a picture spreads. The level
// k spreads it nearly as a Gauss curve of 0.7 * 2^k pixels. The shares add up to 1.
std::vector<double> bloomShares(PixelSize size);

class Bloom
{
public:
    // `device` must outlive the bloom.
    Bloom(const gpu::Device& device, PixelSize size, uint32_t framesInFlight);

    // Makes an image in which `share` (0..1) of the light of `radiance` is spread. Both are
    // R32G32B32A32_SFLOAT in SHADER_READ_ONLY_OPTIMAL and visible to compute shaders, `radiance`
    // before and the image returned after the recording. The sum of the image is that of
    // `radiance` if all its values are light. Values that are no light (NaN, infinity, negative
    // ones) are not spread: they are only multiplied by 1 - `share`, and with a `share` of 1 they
    // disappear.
    VkImageView record(VkCommandBuffer cmd, uint32_t slot, VkImageView radiance, float share);

    // The result of the last recording.
    const gpu::Image& result() const { return result_; }
    // The times of the last frame in `slot`.
    const gpu::Timer& timer() const { return timer_; }

private:
    // Levels are numbered from 0, which has the size of the picture.
    const gpu::Image& level(size_t k) const { return k ? levels_[k - 1] : result_; }
    uint32_t setIndex(uint32_t slot, size_t k) const { return uint32_t(slot * levels_.size() + k); }

    const gpu::Device* device_;
    gpu::Kernel<gpu::BloomDownParams> down_;
    gpu::Kernel<gpu::BloomUpParams> up_;
    std::vector<double> shares_; // of the levels from 1 on
    gpu::Bindings downSets_, upSets_;
    gpu::Timer timer_;
    gpu::Image result_;
    std::vector<gpu::Image> levels_; // from level 1 on, always in GENERAL
};

} // namespace candelabra::app
