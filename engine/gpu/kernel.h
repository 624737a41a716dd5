// SPDX-License-Identifier: Apache-2.0
// Kernel: one compute pipeline with its parameter struct, checked against the SPIR-V at creation.
#pragma once

#include <algorithm>
#include <array>
#include <cassert>
#include <cstdint>
#include <initializer_list>
#include <span>
#include <type_traits>
#include <vector>

#include "gpu/memory.h"
#include "gpu/spirv.h"
#include "gpu/timer.h"

namespace candelabra::gpu
{

// Everything that a module needs to record commands of one frame.
struct Frame {
    const Device& device;
    VkCommandBuffer cmd;
    Timer& timer;
    uint32_t slot;                            // index of the frame in flight
    VkDescriptorSet hostSet = VK_NULL_HANDLE; // descriptor set 1, for kernels that use it

    // Makes what the stages `from` have written visible to what the stages `to` read.
    void memoryBarrier(VkPipelineStageFlags from, VkAccessFlags written, VkPipelineStageFlags to,
                       VkAccessFlags read) const noexcept;
    // Makes all shader and transfer writes so far visible to later compute shaders, indirect
    // commands and transfers.
    void barrier() const noexcept;
    // Moves a colour image whose contents are not needed any more to the layout `to`, in which
    // compute shaders read and write it after this.
    void layoutBarrier(VkImage image, VkImageLayout to) const noexcept;
    // Makes all transfer writes so far visible to the host, once it has waited for the frame.
    void hostBarrier() const noexcept;
};

// A frame for dispatches without timestamps of their own, which share a scope of `frame`.
class UntimedFrame
{
public:
    explicit UntimedFrame(const Frame& frame)
        : frame_{frame.device, frame.cmd, timer_, frame.slot, frame.hostSet}
    {
    }
    UntimedFrame(const UntimedFrame&) = delete; // frame_ refers to timer_
    UntimedFrame& operator=(const UntimedFrame&) = delete;
    operator const Frame&() const { return frame_; }

private:
    Timer timer_; // disabled
    Frame frame_;
};

struct SpecConstant {
    uint32_t id;
    uint32_t value;
};

// Tells whether hosts may name this layout for a colour image that shaders read.
// VK_IMAGE_LAYOUT_UNDEFINED stands for SHADER_READ_ONLY_OPTIMAL.
constexpr bool canBeRead(VkImageLayout layout)
{
    return layout == VK_IMAGE_LAYOUT_UNDEFINED || layout == VK_IMAGE_LAYOUT_GENERAL ||
           layout == VK_IMAGE_LAYOUT_SHADER_READ_ONLY_OPTIMAL ||
           layout == VK_IMAGE_LAYOUT_READ_ONLY_OPTIMAL;
}

// An image that shaders read without writing it, and the layout in which it is.
struct SampledImage {
    VkImageView view = VK_NULL_HANDLE;
    VkImageLayout layout = VK_IMAGE_LAYOUT_SHADER_READ_ONLY_OPTIMAL;

    // `named`: the layout as the host names it.
    static SampledImage of(VkImageView view, VkImageLayout named)
    {
        return named ? SampledImage{view, named} : SampledImage{view};
    }
};

// One descriptor of a set: the binding number and the resource bound to it.
struct Binding {
    uint32_t binding;
    VkBuffer buffer = VK_NULL_HANDLE;
    VkImageView image = VK_NULL_HANDLE;
    VkImageLayout layout = VK_IMAGE_LAYOUT_UNDEFINED;
    VkBufferView texels = VK_NULL_HANDLE;
    VkSampler sampler = VK_NULL_HANDLE;
    VkDeviceSize offset = 0, range = VK_WHOLE_SIZE; // byte range of `buffer`

    static Binding of(uint32_t b, const Buffer& x) { return {.binding = b, .buffer = x.get()}; }
    static Binding ofTexels(uint32_t b, const Buffer& x)
    {
        return {.binding = b, .texels = x.texels.get()};
    }
    static Binding sampled(uint32_t b, const SampledImage& x)
    {
        return {.binding = b, .image = x.view, .layout = x.layout};
    }
    static Binding sampled(uint32_t b, VkImageView view) { return sampled(b, SampledImage{view}); }
    static Binding storage(uint32_t b, VkImageView view)
    {
        return {.binding = b, .image = view, .layout = VK_IMAGE_LAYOUT_GENERAL};
    }
};

// Bindings that are put together while a frame is recorded, which allocates nothing.
class BindingList
{
public:
    void add(std::span<const Binding> bindings)
    {
        assert(count_ + bindings.size() <= all_.size());
        for (const Binding& b : bindings)
            all_[count_++] = b;
    }
    operator std::span<const Binding>() const { return std::span(all_).first(count_); }

private:
    std::array<Binding, 16> all_{};
    size_t count_ = 0;
};

// Descriptor set 0 of a shader: its layout, `setCount` sets of that layout, and a way to write
// them.
class Bindings
{
public:
    Bindings() = default;
    Bindings(const Device& device, const char* name, std::vector<ReflectedBinding> bindings,
             VkShaderStageFlags stages, uint32_t setCount);
    // For every kernel that has the bindings of `kernel`, and for its stage alone.
    Bindings(const Device& device, const Spirv& kernel, uint32_t setCount);

    const char* name() const { return name_; }
    VkDescriptorSetLayout layout() const { return layout_.get(); }
    VkDescriptorSet set(uint32_t index) const { return sets_[index]; }
    // Writes set `index`, which the GPU must not be using. Every binding of the layout must be
    // given, in `bindings` or in `more` (a driver crashed on bindings that were never written).
    void write(uint32_t index, std::initializer_list<Binding> bindings,
               std::span<const Binding> more = {}) const;

private:
    const Device* device_ = nullptr;
    const char* name_ = "";
    std::vector<ReflectedBinding> bindings_;
    Handle<VkDescriptorSetLayout> layout_;
    Handle<VkDescriptorPool> pool_;
    std::vector<VkDescriptorSet> sets_;
};

class KernelBase
{
public:
    KernelBase() = default;
    KernelBase(const Device& device, const Spirv& spirv, uint32_t paramsSize,
               std::initializer_list<SpecConstant> constants, VkDescriptorSetLayout hostLayout);
    const char* name() const { return name_; }
    // Creates `setCount` descriptor sets (one per frame slot, mostly) for one user of the kernel,
    // such as a view.
    Bindings createBindings(uint32_t setCount) const;

protected:
    void dispatchRaw(const Frame& frame, VkDescriptorSet set, const void* params, uint32_t size,
                     uint32_t x, uint32_t y, uint32_t z) const noexcept;
    void dispatchIndirectRaw(const Frame& frame, VkDescriptorSet set, const void* params,
                             uint32_t size, VkBuffer arguments, VkDeviceSize at) const noexcept;

private:
    void bind(const Frame& frame, VkDescriptorSet set, const void* params,
              uint32_t size) const noexcept;

    const Device* device_ = nullptr;
    const char* name_ = "";
    Reflection reflection_;
    Handle<VkDescriptorSetLayout> setLayout_;
    Handle<VkPipelineLayout> layout_;
    Handle<VkPipeline> pipeline_;
};

// The parameter struct of kernels without push constants.
struct NoParams {
};

// A kernel with a typed parameter struct. Params is the shader's push constant struct, from
// shaders/shared.
template <typename Params>
class Kernel : public KernelBase
{
    static constexpr uint32_t paramsSize = std::is_empty_v<Params> ? 0 : sizeof(Params);

public:
    Kernel() = default;
    // `hostLayout`: layout of descriptor set 1, for kernels that use it.
    Kernel(const Device& device, const Spirv& spirv,
           std::initializer_list<SpecConstant> constants = {},
           VkDescriptorSetLayout hostLayout = VK_NULL_HANDLE)
        : KernelBase(device, spirv, paramsSize, constants, hostLayout)
    {
    }
    // Records a dispatch of x * y * z work groups. With a count of 0 only the timer row is
    // recorded.
    void dispatch(const Frame& frame, VkDescriptorSet set, const Params& params, uint32_t x,
                  uint32_t y = 1, uint32_t z = 1) const noexcept
    {
        dispatchRaw(frame, set, &params, paramsSize, x, y, z);
    }
    // Records a dispatch of at least `groups` work groups in rows, because devices limit how many
    // there may be in one dimension. The kernel counts its groups row by row.
    void dispatchInRows(const Frame& frame, VkDescriptorSet set, const Params& params,
                        uint32_t groups) const noexcept
    {
        constexpr uint32_t row = 65535; // what every device takes
        dispatch(frame, set, params, std::min(groups, row), groups / row + (groups % row != 0));
    }
    // Records a dispatch whose group counts (VkDispatchIndirectCommand) are read from `arguments`,
    // at byte `at`.
    void dispatchIndirect(const Frame& frame, VkDescriptorSet set, const Params& params,
                          const Buffer& arguments, VkDeviceSize at = 0) const noexcept
    {
        dispatchIndirectRaw(frame, set, &params, paramsSize, arguments.get(), at);
    }
};

// Creators shared with pipelines that are not kernels (raster passes).
Handle<VkShaderModule> createShaderModule(const Device& device, const Spirv& spirv);
Handle<VkDescriptorSetLayout> createSetLayout(const Device& device, const char* name,
                                              std::span<const ReflectedBinding> bindings,
                                              VkShaderStageFlags stages);
Handle<VkPipelineLayout> createPipelineLayout(const Device& device, const char* name,
                                              std::span<const VkDescriptorSetLayout> sets,
                                              VkShaderStageFlags stages, uint32_t pushConstantSize);

constexpr uint32_t divideUp(uint32_t n, uint32_t d)
{
    return n / d + (n % d != 0);
}

} // namespace candelabra::gpu
