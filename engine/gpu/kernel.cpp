// SPDX-License-Identifier: Apache-2.0
#include "gpu/kernel.h"

#include <algorithm>
#include <array>

namespace candelabra::gpu
{

void Frame::memoryBarrier(VkPipelineStageFlags from, VkAccessFlags written, VkPipelineStageFlags to,
                          VkAccessFlags read) const noexcept
{
    const VkMemoryBarrier barrier{
        .sType = VK_STRUCTURE_TYPE_MEMORY_BARRIER, .srcAccessMask = written, .dstAccessMask = read};
    device.CmdPipelineBarrier(cmd, from, to, 0, 1, &barrier, 0, nullptr, 0, nullptr);
}

void Frame::barrier() const noexcept
{
    constexpr VkPipelineStageFlags stages = VK_PIPELINE_STAGE_COMPUTE_SHADER_BIT |
                                            VK_PIPELINE_STAGE_DRAW_INDIRECT_BIT |
                                            VK_PIPELINE_STAGE_TRANSFER_BIT;
    constexpr VkAccessFlags accesses = VK_ACCESS_SHADER_READ_BIT | VK_ACCESS_SHADER_WRITE_BIT |
                                       VK_ACCESS_INDIRECT_COMMAND_READ_BIT |
                                       VK_ACCESS_TRANSFER_READ_BIT | VK_ACCESS_TRANSFER_WRITE_BIT;
    memoryBarrier(stages, accesses, stages, accesses | VK_ACCESS_UNIFORM_READ_BIT);
}

void Frame::layoutBarrier(VkImage image, VkImageLayout to) const noexcept
{
    const VkImageMemoryBarrier barrier{
        .sType = VK_STRUCTURE_TYPE_IMAGE_MEMORY_BARRIER,
        .srcAccessMask = VK_ACCESS_SHADER_WRITE_BIT,
        .dstAccessMask = VK_ACCESS_SHADER_WRITE_BIT | VK_ACCESS_SHADER_READ_BIT,
        .oldLayout = VK_IMAGE_LAYOUT_UNDEFINED,
        .newLayout = to,
        .srcQueueFamilyIndex = VK_QUEUE_FAMILY_IGNORED,
        .dstQueueFamilyIndex = VK_QUEUE_FAMILY_IGNORED,
        .image = image,
        .subresourceRange = {VK_IMAGE_ASPECT_COLOR_BIT, 0, VK_REMAINING_MIP_LEVELS, 0,
                             VK_REMAINING_ARRAY_LAYERS}};
    constexpr VkPipelineStageFlags stage = VK_PIPELINE_STAGE_COMPUTE_SHADER_BIT;
    device.CmdPipelineBarrier(cmd, stage, stage, 0, 0, nullptr, 0, nullptr, 1, &barrier);
}

void Frame::hostBarrier() const noexcept
{
    memoryBarrier(VK_PIPELINE_STAGE_TRANSFER_BIT, VK_ACCESS_TRANSFER_WRITE_BIT,
                  VK_PIPELINE_STAGE_HOST_BIT, VK_ACCESS_HOST_READ_BIT);
}

Handle<VkShaderModule> createShaderModule(const Device& device, const Spirv& spirv)
{
    const VkShaderModuleCreateInfo info{.sType = VK_STRUCTURE_TYPE_SHADER_MODULE_CREATE_INFO,
                                        .codeSize = spirv.words.size_bytes(),
                                        .pCode = spirv.words.data()};
    VkShaderModule shader{};
    check(device.CreateShaderModule(device.handle, &info, device.allocationCallbacks, &shader),
          "creating shader ", spirv.name);
    Handle<VkShaderModule> owner(device, shader);
    device.name(VK_OBJECT_TYPE_SHADER_MODULE, shader, spirv.name);
    return owner;
}

Handle<VkDescriptorSetLayout> createSetLayout(const Device& device, const char* name,
                                              std::span<const ReflectedBinding> bindings,
                                              VkShaderStageFlags stages)
{
    std::vector<VkDescriptorSetLayoutBinding> entries;
    for (const ReflectedBinding& b : bindings)
        entries.push_back({b.binding, b.type, b.count, stages, nullptr});
    const VkDescriptorSetLayoutCreateInfo info{
        .sType = VK_STRUCTURE_TYPE_DESCRIPTOR_SET_LAYOUT_CREATE_INFO,
        .bindingCount = uint32_t(entries.size()),
        .pBindings = entries.data()};
    VkDescriptorSetLayout layout{};
    check(
        device.CreateDescriptorSetLayout(device.handle, &info, device.allocationCallbacks, &layout),
        "creating the set layout of ", name);
    Handle<VkDescriptorSetLayout> owner(device, layout);
    device.name(VK_OBJECT_TYPE_DESCRIPTOR_SET_LAYOUT, layout, name);
    return owner;
}

Handle<VkPipelineLayout> createPipelineLayout(const Device& device, const char* name,
                                              std::span<const VkDescriptorSetLayout> sets,
                                              VkShaderStageFlags stages, uint32_t pushConstantSize)
{
    const VkPushConstantRange range{stages, 0, pushConstantSize};
    const VkPipelineLayoutCreateInfo info{.sType = VK_STRUCTURE_TYPE_PIPELINE_LAYOUT_CREATE_INFO,
                                          .setLayoutCount = uint32_t(sets.size()),
                                          .pSetLayouts = sets.data(),
                                          .pushConstantRangeCount = pushConstantSize ? 1u : 0u,
                                          .pPushConstantRanges = &range};
    VkPipelineLayout layout{};
    check(device.CreatePipelineLayout(device.handle, &info, device.allocationCallbacks, &layout),
          "creating the pipeline layout of ", name);
    Handle<VkPipelineLayout> owner(device, layout);
    device.name(VK_OBJECT_TYPE_PIPELINE_LAYOUT, layout, name);
    return owner;
}

Bindings::Bindings(const Device& device, const char* name, std::vector<ReflectedBinding> bindings,
                   VkShaderStageFlags stages, uint32_t setCount)
    : device_(&device),
      name_(name),
      bindings_(std::move(bindings)),
      layout_(createSetLayout(device, name, bindings_, stages)),
      sets_(setCount)
{
    std::vector<VkDescriptorPoolSize> sizes;
    for (const ReflectedBinding& b : bindings_)
        sizes.push_back({b.type, b.count * setCount});
    const VkDescriptorPoolCreateInfo info{.sType = VK_STRUCTURE_TYPE_DESCRIPTOR_POOL_CREATE_INFO,
                                          .maxSets = setCount,
                                          .poolSizeCount = uint32_t(sizes.size()),
                                          .pPoolSizes = sizes.data()};
    VkDescriptorPool pool{};
    check(device.CreateDescriptorPool(device.handle, &info, device.allocationCallbacks, &pool),
          "creating the descriptor pool of ", name);
    pool_ = Handle(device, pool);
    const std::vector<VkDescriptorSetLayout> layouts(setCount, layout_.get());
    const VkDescriptorSetAllocateInfo allocation{.sType =
                                                     VK_STRUCTURE_TYPE_DESCRIPTOR_SET_ALLOCATE_INFO,
                                                 .descriptorPool = pool,
                                                 .descriptorSetCount = setCount,
                                                 .pSetLayouts = layouts.data()};
    check(device.AllocateDescriptorSets(device.handle, &allocation, sets_.data()),
          "allocating descriptor sets of ", name);
    for (VkDescriptorSet set : sets_)
        device.name(VK_OBJECT_TYPE_DESCRIPTOR_SET, set, name);
}

Bindings::Bindings(const Device& device, const Spirv& kernel, uint32_t setCount)
    : Bindings(device, kernel.name, reflect(kernel).bindings, VK_SHADER_STAGE_COMPUTE_BIT, setCount)
{
}

void Bindings::write(uint32_t index, std::initializer_list<Binding> bindings,
                     std::span<const Binding> more) const
{
    constexpr size_t maxBindings = 32;
    const size_t count = bindings.size() + more.size();
    if (count != bindings_.size() || count > maxBindings)
        failArgument(std::string("internal: ") + name_ + " needs " +
                     std::to_string(bindings_.size()) + " bindings, " + std::to_string(count) +
                     " were given");
    std::array<VkDescriptorBufferInfo, maxBindings> buffers;
    std::array<VkDescriptorImageInfo, maxBindings> images;
    std::array<VkBufferView, maxBindings> texels;
    std::array<VkWriteDescriptorSet, maxBindings> writes;
    uint32_t n = 0;
    const auto add = [&](const Binding& b) {
        const auto reflected =
            std::find_if(bindings_.begin(), bindings_.end(),
                         [&](const ReflectedBinding& r) { return r.binding == b.binding; });
        if (reflected == bindings_.end())
            failArgument(std::string("internal: ") + name_ + " has no binding " +
                         std::to_string(b.binding));
        buffers[n] = {b.buffer, b.offset, b.range};
        images[n] = {b.sampler, b.image, b.layout};
        texels[n] = b.texels;
        writes[n] = {.sType = VK_STRUCTURE_TYPE_WRITE_DESCRIPTOR_SET,
                     .dstSet = sets_[index],
                     .dstBinding = b.binding,
                     .descriptorCount = 1,
                     .descriptorType = reflected->type,
                     .pImageInfo = &images[n],
                     .pBufferInfo = &buffers[n],
                     .pTexelBufferView = &texels[n]};
        ++n;
    };
    std::for_each(bindings.begin(), bindings.end(), add);
    std::for_each(more.begin(), more.end(), add);
    device_->UpdateDescriptorSets(device_->handle, n, writes.data(), 0, nullptr);
}

KernelBase::KernelBase(const Device& device, const Spirv& spirv, uint32_t paramsSize,
                       std::initializer_list<SpecConstant> constants,
                       VkDescriptorSetLayout hostLayout)
    : device_(&device), name_(spirv.name), reflection_(reflect(spirv))
{
    if (reflection_.pushConstantSize != paramsSize)
        failUnsupported(std::string("internal: parameters of ") + name_ + " are " +
                        std::to_string(paramsSize) + " bytes in C++ and " +
                        std::to_string(reflection_.pushConstantSize) + " in SPIR-V");
    const auto storageBuffers = std::count_if(
        reflection_.bindings.begin(), reflection_.bindings.end(),
        [](const ReflectedBinding& b) { return b.type == VK_DESCRIPTOR_TYPE_STORAGE_BUFFER; });
    if (storageBuffers > ptrdiff_t(maxStorageBuffers(device.parts)))
        failUnsupported(std::string("internal: ") + name_ + " has " +
                        std::to_string(storageBuffers) +
                        " storage buffers, cndCheckDevice requires only " +
                        std::to_string(maxStorageBuffers(device.parts)));
    constexpr VkShaderStageFlags stage = VK_SHADER_STAGE_COMPUTE_BIT;
    setLayout_ = createSetLayout(device, name_, reflection_.bindings, stage);
    if (reflection_.usesHostSet && !hostLayout)
        failArgument(std::string("kernel ") + name_ +
                     " uses descriptor set 1, and CndHostKernels::setLayout is null");
    const VkDescriptorSetLayout sets[] = {setLayout_.get(), hostLayout};
    layout_ = createPipelineLayout(device, name_, {sets, reflection_.usesHostSet ? 2u : 1u}, stage,
                                   paramsSize);

    std::vector<VkSpecializationMapEntry> entries;
    std::vector<uint32_t> values;
    for (const SpecConstant& c : constants) {
        entries.push_back({c.id, uint32_t(values.size() * sizeof(uint32_t)), sizeof(uint32_t)});
        values.push_back(c.value);
    }
    const VkSpecializationInfo specialization{uint32_t(entries.size()), entries.data(),
                                              values.size() * sizeof(uint32_t), values.data()};
    const Handle<VkShaderModule> shader = createShaderModule(device, spirv);
    const VkComputePipelineCreateInfo info{
        .sType = VK_STRUCTURE_TYPE_COMPUTE_PIPELINE_CREATE_INFO,
        .stage = {.sType = VK_STRUCTURE_TYPE_PIPELINE_SHADER_STAGE_CREATE_INFO,
                  .stage = VK_SHADER_STAGE_COMPUTE_BIT,
                  .module = shader.get(),
                  .pName = "main",
                  .pSpecializationInfo = &specialization},
        .layout = layout_.get()};
    VkPipeline pipeline{};
    check(device.CreateComputePipelines(device.handle, device.pipelineCache, 1, &info,
                                        device.allocationCallbacks, &pipeline),
          "creating pipeline ", name_);
    pipeline_ = Handle(device, pipeline);
    device.name(VK_OBJECT_TYPE_PIPELINE, pipeline, name_);
}

Bindings KernelBase::createBindings(uint32_t setCount) const
{
    return Bindings(*device_, name_, reflection_.bindings, VK_SHADER_STAGE_COMPUTE_BIT, setCount);
}

void KernelBase::dispatchRaw(const Frame& frame, VkDescriptorSet set, const void* params,
                             uint32_t size, uint32_t x, uint32_t y, uint32_t z) const noexcept
{
    const Device& d = frame.device;
    d.beginLabel(frame.cmd, name_);
    if (x && y && z) {
        bind(frame, set, params, size);
        d.CmdDispatch(frame.cmd, x, y, z);
    }
    d.endLabel(frame.cmd);
    frame.timer.stamp(frame.cmd, name_);
}

void KernelBase::dispatchIndirectRaw(const Frame& frame, VkDescriptorSet set, const void* params,
                                     uint32_t size, VkBuffer arguments,
                                     VkDeviceSize at) const noexcept
{
    const Device& d = frame.device;
    d.beginLabel(frame.cmd, name_);
    bind(frame, set, params, size);
    d.CmdDispatchIndirect(frame.cmd, arguments, at);
    d.endLabel(frame.cmd);
    frame.timer.stamp(frame.cmd, name_);
}

void KernelBase::bind(const Frame& frame, VkDescriptorSet set, const void* params,
                      uint32_t size) const noexcept
{
    const Device& d = frame.device;
    d.CmdBindPipeline(frame.cmd, VK_PIPELINE_BIND_POINT_COMPUTE, pipeline_.get());
    const VkDescriptorSet sets[] = {set, frame.hostSet};
    d.CmdBindDescriptorSets(frame.cmd, VK_PIPELINE_BIND_POINT_COMPUTE, layout_.get(), 0,
                            reflection_.usesHostSet ? 2 : 1, sets, 0, nullptr);
    if (size)
        d.CmdPushConstants(frame.cmd, layout_.get(), VK_SHADER_STAGE_COMPUTE_BIT, 0, size, params);
}

} // namespace candelabra::gpu
