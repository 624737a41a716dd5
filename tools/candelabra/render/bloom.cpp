// SPDX-License-Identifier: Apache-2.0
#include "render/bloom.h"

#include <algorithm>
#include <cmath>

#include "candelabra_program_shaders.h"
#include "render/image_barrier.h"

namespace candelabra::app
{
namespace
{

// The disability glare equation of the CIE for small angles (Vos and van den Berg 1999, CIE 135/1),
// for young eyes, is 10 / angle^3 + 5 / angle^2, with the angle in degrees. As a mixture of Gauss
// curves of all widths it has 1.6 / width + 1 of the light per factor e of the width. It is used
// between these two widths, in degrees. Light that is scattered less counts as not scattered.
constexpr double narrowest = 0.1, widest = 15;

// A picture is taken for one whose height the eye sees at this angle, in degrees. So a picture
// looks the same at every resolution.
constexpr double heightDegrees = 40;

// The light of widths up to `width`, but for a constant.
double lightUpTo(double width)
{
    return std::log(width) - 1.6 / width;
}

gpu::Image createLevel(const gpu::Device& device, const char* name, PixelSize size)
{
    return gpu::createImage(device, name, VK_FORMAT_R32G32B32A32_SFLOAT, size.width, size.height,
                            VK_IMAGE_USAGE_STORAGE_BIT | VK_IMAGE_USAGE_SAMPLED_BIT |
                                VK_IMAGE_USAGE_TRANSFER_SRC_BIT,
                            VK_IMAGE_ASPECT_COLOR_BIT);
}

uint32_t groupsFor(uint32_t texels)
{
    return gpu::divideUp(texels, gpu::BLOOM_GROUP);
}

// Discards what the image holds. Only compute shaders use it before and after.
constexpr ImageAccess usedBefore{VK_PIPELINE_STAGE_2_COMPUTE_SHADER_BIT,
                                 VK_ACCESS_2_SHADER_STORAGE_WRITE_BIT, VK_IMAGE_LAYOUT_UNDEFINED};

} // namespace

std::vector<double> bloomShares(PixelSize size)
{
    // The coarsest level has at most three texels along the shorter side.
    uint32_t count = 1;
    while (std::min(size.width, size.height) > 3u << count)
        ++count;
    const double pixel = heightDegrees / size.height;
    const double all = lightUpTo(widest) - lightUpTo(narrowest);
    std::vector<double> out;
    double before = lightUpTo(narrowest);
    for (uint32_t k = 1; k <= count; ++k) {
        // The variance of both kernels together is (4^k - 1) / 2. A level takes the widths that are
        // nearer to its own than to those of its neighbours, by their ratio.
        const double width = std::sqrt((std::exp2(2.0 * k) - 1) / 2) * pixel;
        const double limit =
            k == count ? widest : std::clamp(width * std::sqrt(2.0), narrowest, widest);
        out.push_back((lightUpTo(limit) - before) / all);
        before = lightUpTo(limit);
    }
    return out;
}

Bloom::Bloom(const gpu::Device& device, PixelSize size, uint32_t framesInFlight)
    : device_(&device),
      down_(device, spirv::bloom_down_comp),
      up_(device, spirv::bloom_up_comp),
      shares_(bloomShares(size)),
      downSets_(down_.createBindings(framesInFlight * uint32_t(shares_.size()))),
      upSets_(up_.createBindings(framesInFlight * uint32_t(shares_.size()))),
      timer_(device, "bloom", framesInFlight, true),
      result_(createLevel(device, "radiance with bloom", size))
{
    for (size_t k = 1; k <= shares_.size(); ++k) {
        size = {gpu::divideUp(size.width, 2), gpu::divideUp(size.height, 2)};
        levels_.push_back(createLevel(device, "level of the bloom", size));
    }
}

VkImageView Bloom::record(VkCommandBuffer cmd, uint32_t slot, VkImageView radiance, float share)
{
    using gpu::Binding;
    const gpu::Frame f{*device_, cmd, timer_, slot};
    timer_.begin(cmd, slot);
    for (size_t k = 0; k <= levels_.size(); ++k)
        transition(cmd, level(k).image.get(), usedBefore, computeWrite);
    const auto read = [&](uint32_t binding, size_t k) {
        return k ? Binding::sampled(binding, {level(k).view.get(), VK_IMAGE_LAYOUT_GENERAL})
                 : Binding::sampled(binding, radiance);
    };
    const auto sizeOf = [&](size_t k) { return glm::uvec2(level(k).width, level(k).height); };
    for (size_t k = 1; k <= levels_.size(); ++k) {
        const uint32_t set = setIndex(slot, k - 1);
        downSets_.write(set, {read(gpu::BLOOM_DOWN_FINE, k - 1),
                              Binding::storage(gpu::BLOOM_DOWN_COARSE, level(k).view.get())});
        down_.dispatch(f, downSets_.set(set), {sizeOf(k - 1), sizeOf(k)}, groupsFor(level(k).width),
                       groupsFor(level(k).height));
        f.barrier();
    }
    for (size_t k = levels_.size(); k >= 1; --k) {
        const uint32_t set = setIndex(slot, k - 1);
        upSets_.write(set, {read(gpu::BLOOM_UP_FINE, k - 1), read(gpu::BLOOM_UP_COARSE, k),
                            Binding::storage(gpu::BLOOM_UP_OUTPUT, level(k - 1).view.get())});
        const double fine = k > 1 ? share * shares_[k - 2] : 1 - double(share);
        const double coarse = k == levels_.size() ? share * shares_[k - 1] : 1;
        up_.dispatch(f, upSets_.set(set), {sizeOf(k - 1), sizeOf(k), float(fine), float(coarse)},
                     groupsFor(level(k - 1).width), groupsFor(level(k - 1).height));
        if (k > 1)
            f.barrier();
    }
    transition(cmd, result_.image.get(), computeWrite, computeRead);
    return result_.view.get();
}

} // namespace candelabra::app
