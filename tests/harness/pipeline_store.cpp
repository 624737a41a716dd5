// SPDX-License-Identifier: Apache-2.0
#include "harness/pipeline_store.h"

#include <cstring>
#include <map>
#include <mutex>
#include <string>

namespace candelabra::test
{
namespace
{

VkDevice sharedDevice = VK_NULL_HANDLE; // null: there is no store
std::mutex mutex;

// The bytes of a description. Descriptions are equal if their keys are.
class Key
{
public:
    // Adds the members of a struct from `first` to `last`, none of which may be a pointer.
    template <typename A, typename B>
    void add(const A& first, const B& last)
    {
        bytes_.append(reinterpret_cast<const char*>(&first),
                      reinterpret_cast<const char*>(&last + 1));
    }
    template <typename T>
    void add(const T& value)
    {
        add(value, value);
    }
    template <typename T>
    void addArray(const T* values, size_t count)
    {
        add(count);
        add(values != nullptr);
        if (values && count)
            add(values[0], values[count - 1]);
    }
    void addBytes(const void* data, size_t size) { addArray(static_cast<const char*>(data), size); }
    void refuseUnless(bool comparable) { comparable_ = comparable_ && comparable; }
    bool comparable() const { return comparable_; }
    const std::string& bytes() const { return bytes_; }

private:
    std::string bytes_;
    bool comparable_ = true;
};

// The objects of a type that were created from descriptions that can be compared.
template <typename H>
struct Known {
    static inline std::map<std::string, H> byContent; // of shaders and pipelines, which are shared
    static inline std::map<H, int> users;
    static inline std::map<H, std::string> contents; // of layouts, which are not
};
template <typename H>
constexpr bool isShared = std::is_same_v<H, VkShaderModule> || std::is_same_v<H, VkPipeline>;

template <typename H, typename CreateReal>
VkResult create(const Key& key, H* out, const CreateReal& createReal)
{
    if (!key.comparable())
        return createReal(out);
    const auto known = Known<H>::byContent.find(key.bytes());
    if (known != Known<H>::byContent.end()) {
        *out = known->second;
        ++Known<H>::users[*out];
        return VK_SUCCESS;
    }
    const VkResult result = createReal(out);
    if (result == VK_SUCCESS) {
        if constexpr (isShared<H>) {
            Known<H>::byContent[key.bytes()] = *out;
            Known<H>::users[*out] = 1;
        } else {
            Known<H>::contents[*out] = key.bytes();
        }
    }
    return result;
}

void describe(Key& key, const VkShaderModuleCreateInfo& info)
{
    key.add(info.flags);
    key.addArray(info.pCode, info.codeSize / sizeof *info.pCode);
}

void describe(Key& key, const VkDescriptorSetLayoutCreateInfo& info)
{
    key.add(info.flags, info.bindingCount);
    for (uint32_t i = 0; i < info.bindingCount; ++i) {
        key.refuseUnless(!info.pBindings[i].pImmutableSamplers);
        key.add(info.pBindings[i].binding, info.pBindings[i].stageFlags);
    }
}

// Adds what a layout was created from.
template <typename H>
void addLayout(Key& key, H layout)
{
    const auto known = Known<H>::contents.find(layout);
    key.refuseUnless(known != Known<H>::contents.end());
    if (key.comparable())
        key.addArray(known->second.data(), known->second.size());
}

void describe(Key& key, const VkPipelineLayoutCreateInfo& info)
{
    key.add(info.flags);
    for (uint32_t i = 0; i < info.setLayoutCount; ++i)
        addLayout(key, info.pSetLayouts[i]);
    key.addArray(info.pPushConstantRanges, info.pushConstantRangeCount);
}

// Shaders are compared by their handles, which live as long as the store.
void addStage(Key& key, const VkPipelineShaderStageCreateInfo& stage)
{
    key.refuseUnless(!stage.pNext && Known<VkShaderModule>::users.contains(stage.module));
    key.add(stage.flags, stage.module);
    key.addArray(stage.pName, std::strlen(stage.pName));
    static constexpr VkSpecializationInfo none{};
    const VkSpecializationInfo& constants =
        stage.pSpecializationInfo ? *stage.pSpecializationInfo : none;
    key.addArray(constants.pMapEntries, constants.mapEntryCount);
    key.addBytes(constants.pData, constants.dataSize);
}

void describe(Key& key, const VkComputePipelineCreateInfo& info)
{
    key.refuseUnless(!info.pNext && !info.basePipelineHandle);
    key.add(info.flags);
    addStage(key, info.stage);
    addLayout(key, info.layout);
}

// Returns the state at `pointer`; nothing may be chained to it.
template <typename State>
const State& stateAt(Key& key, const State* pointer)
{
    static constexpr State none{};
    key.add(pointer != nullptr);
    key.refuseUnless(!pointer || !pointer->pNext);
    return pointer ? *pointer : none;
}

// Only pipelines that need no render pass.
void describe(Key& key, const VkGraphicsPipelineCreateInfo& info)
{
    const auto* chained = static_cast<const VkPipelineRenderingCreateInfo*>(info.pNext);
    key.refuseUnless(chained && chained->sType == VK_STRUCTURE_TYPE_PIPELINE_RENDERING_CREATE_INFO);
    key.refuseUnless(!info.basePipelineHandle && !info.pTessellationState && !info.renderPass);
    if (!key.comparable())
        return;
    key.add(info.flags);
    for (uint32_t i = 0; i < info.stageCount; ++i)
        addStage(key, info.pStages[i]);
    addLayout(key, info.layout);
    const auto& rendering = stateAt(key, chained);
    key.add(rendering.viewMask);
    key.addArray(rendering.pColorAttachmentFormats, rendering.colorAttachmentCount);
    key.add(rendering.depthAttachmentFormat, rendering.stencilAttachmentFormat);
    const auto& vertices = stateAt(key, info.pVertexInputState);
    key.addArray(vertices.pVertexBindingDescriptions, vertices.vertexBindingDescriptionCount);
    key.addArray(vertices.pVertexAttributeDescriptions, vertices.vertexAttributeDescriptionCount);
    const auto& assembly = stateAt(key, info.pInputAssemblyState);
    key.add(assembly.topology, assembly.primitiveRestartEnable);
    const auto& viewports = stateAt(key, info.pViewportState);
    key.addArray(viewports.pViewports, viewports.viewportCount);
    key.addArray(viewports.pScissors, viewports.scissorCount);
    const auto& raster = stateAt(key, info.pRasterizationState);
    key.add(raster.depthClampEnable, raster.lineWidth);
    const auto& samples = stateAt(key, info.pMultisampleState);
    key.refuseUnless(!samples.pSampleMask);
    key.add(samples.rasterizationSamples, samples.minSampleShading);
    key.add(samples.alphaToCoverageEnable, samples.alphaToOneEnable);
    const auto& depth = stateAt(key, info.pDepthStencilState);
    key.add(depth.flags, depth.maxDepthBounds);
    const auto& blend = stateAt(key, info.pColorBlendState);
    key.add(blend.flags, blend.logicOp);
    key.addArray(blend.pAttachments, blend.attachmentCount);
    key.add(blend.blendConstants);
    const auto& dynamic = stateAt(key, info.pDynamicState);
    key.addArray(dynamic.pDynamicStates, dynamic.dynamicStateCount);
}

// Replace<F>::call takes the place of Vulkan's function F.
template <auto F>
struct Replace;

template <typename Info, typename H,
          VkResult(VKAPI_PTR* F)(VkDevice, const Info*, const VkAllocationCallbacks*, H*)>
struct Replace<F> {
    static VkResult VKAPI_CALL call(VkDevice device, const Info* info,
                                    const VkAllocationCallbacks* callbacks, H* out)
    {
        const std::lock_guard lock(mutex);
        Key key;
        key.refuseUnless(device == sharedDevice && !callbacks && !info->pNext);
        describe(key, *info);
        return create(key, out, [&](H* real) { return F(device, info, callbacks, real); });
    }
};

template <typename Info, VkResult(VKAPI_PTR* F)(VkDevice, VkPipelineCache, uint32_t, const Info*,
                                                const VkAllocationCallbacks*, VkPipeline*)>
struct Replace<F> {
    static VkResult VKAPI_CALL call(VkDevice device, VkPipelineCache cache, uint32_t count,
                                    const Info* info, const VkAllocationCallbacks* callbacks,
                                    VkPipeline* out)
    {
        const std::lock_guard lock(mutex);
        Key key;
        key.refuseUnless(device == sharedDevice && !callbacks && count == 1);
        describe(key, *info);
        return create(key, out, [&](VkPipeline* real) {
            return F(device, cache, count, info, callbacks, real);
        });
    }
};

template <typename H, void(VKAPI_PTR* F)(VkDevice, H, const VkAllocationCallbacks*)>
struct Replace<F> {
    static void VKAPI_CALL call(VkDevice device, H handle, const VkAllocationCallbacks* callbacks)
    {
        const std::lock_guard lock(mutex);
        if (sharedDevice && device != sharedDevice) {
            F(device, handle, callbacks);
            return;
        }
        Known<H>::contents.erase(handle);
        const auto found = Known<H>::users.find(handle);
        if (found != Known<H>::users.end() && (--found->second > 0 || sharedDevice))
            return;
        F(device, handle, callbacks);
    }
    static void callForUnused()
    {
        for (const auto& [handle, users] : Known<H>::users)
            if (users == 0)
                F(sharedDevice, handle, nullptr);
        std::erase_if(Known<H>::users, [](const auto& known) { return known.second == 0; });
        Known<H>::byContent.clear();
    }
};

PFN_vkVoidFunction VKAPI_CALL deviceFunctions(VkDevice device, const char* name)
{
#define X(f)                                                                                       \
    if (std::strcmp(name, #f) == 0)                                                                \
        return reinterpret_cast<PFN_vkVoidFunction>(Replace<f>::call);
    X(vkCreateShaderModule)
    X(vkCreateDescriptorSetLayout)
    X(vkCreatePipelineLayout)
    X(vkCreateComputePipelines)
    X(vkCreateGraphicsPipelines)
    X(vkDestroyShaderModule)
    X(vkDestroyDescriptorSetLayout)
    X(vkDestroyPipelineLayout)
    X(vkDestroyPipeline)
#undef X
    return vkGetDeviceProcAddr(device, name);
}

} // namespace

PFN_vkVoidFunction VKAPI_CALL PipelineStore::functions(VkInstance instance, const char* name)
{
    if (std::strcmp(name, "vkGetDeviceProcAddr") == 0)
        return reinterpret_cast<PFN_vkVoidFunction>(deviceFunctions);
    return vkGetInstanceProcAddr(instance, name);
}

PipelineStore::PipelineStore(VkDevice device)
{
    sharedDevice = device;
}

PipelineStore::~PipelineStore()
{
    const std::lock_guard lock(mutex);
    Replace<vkDestroyPipeline>::callForUnused();
    Replace<vkDestroyShaderModule>::callForUnused();
    sharedDevice = VK_NULL_HANDLE;
}

} // namespace candelabra::test
