// SPDX-License-Identifier: Apache-2.0
#include "gbuffer/pipelines.h"

#include <span>
#include <string>

#include "candelabra_gbuffer_shaders.h"
#include "gbuffer/geometry_impl.h"
#include "gbuffer/targets.h"

namespace candelabra::gbuffer
{
namespace
{

constexpr VkShaderStageFlags bothStages = VK_SHADER_STAGE_VERTEX_BIT | VK_SHADER_STAGE_FRAGMENT_BIT;

struct PipelineDesc {
    const char* name;
    const gpu::Spirv& vertex;
    const gpu::Spirv& fragment;
    std::span<const gpu::SpecConstant> constants;
    std::span<const VkVertexInputBindingDescription> streams;
    std::span<const VkVertexInputAttributeDescription> attributes;
    VkPrimitiveTopology topology;
    VkPipelineLayout layout;
    bool emissive = true; // writes radiance
};

// Returns the colour formats by fragment output location.
std::vector<VkFormat> colorFormats(CndGBufferLayout layout, bool emissive)
{
    const TargetFormats f = targetFormats(layout);
    std::vector<VkFormat> formats{f.normalRoughness, f.albedo};
    if (f.specular != VK_FORMAT_UNDEFINED)
        formats.push_back(f.specular);
    if (emissive)
        formats.push_back(f.radiance);
    return formats;
}

class Specialization
{
public:
    explicit Specialization(std::span<const gpu::SpecConstant> constants)
    {
        for (const gpu::SpecConstant& c : constants) {
            entries_.push_back(
                {c.id, uint32_t(values_.size() * sizeof(uint32_t)), sizeof(uint32_t)});
            values_.push_back(c.value);
        }
        info = {uint32_t(entries_.size()), entries_.data(), values_.size() * sizeof(uint32_t),
                values_.data()};
    }
    Specialization(const Specialization&) = delete;
    Specialization& operator=(const Specialization&) = delete;
    VkSpecializationInfo info;

private:
    std::vector<VkSpecializationMapEntry> entries_;
    std::vector<uint32_t> values_;
};

// Fixed-function state that all pipelines share.
constexpr VkPipelineViewportStateCreateInfo viewportState{
    .sType = VK_STRUCTURE_TYPE_PIPELINE_VIEWPORT_STATE_CREATE_INFO,
    .viewportCount = 1,
    .scissorCount = 1};
constexpr VkPipelineRasterizationStateCreateInfo rasterizationState{
    .sType = VK_STRUCTURE_TYPE_PIPELINE_RASTERIZATION_STATE_CREATE_INFO, .lineWidth = 1};
constexpr VkPipelineMultisampleStateCreateInfo multisampleState{
    .sType = VK_STRUCTURE_TYPE_PIPELINE_MULTISAMPLE_STATE_CREATE_INFO,
    .rasterizationSamples = VK_SAMPLE_COUNT_1_BIT};
constexpr VkPipelineDepthStencilStateCreateInfo depthState{
    .sType = VK_STRUCTURE_TYPE_PIPELINE_DEPTH_STENCIL_STATE_CREATE_INFO,
    .depthTestEnable = VK_TRUE,
    .depthWriteEnable = VK_TRUE};
constexpr VkDynamicState dynamicStates[] = {VK_DYNAMIC_STATE_VIEWPORT, VK_DYNAMIC_STATE_SCISSOR,
                                            VK_DYNAMIC_STATE_CULL_MODE, VK_DYNAMIC_STATE_FRONT_FACE,
                                            VK_DYNAMIC_STATE_DEPTH_COMPARE_OP};
constexpr VkPipelineDynamicStateCreateInfo dynamicState{
    .sType = VK_STRUCTURE_TYPE_PIPELINE_DYNAMIC_STATE_CREATE_INFO,
    .dynamicStateCount = std::size(dynamicStates),
    .pDynamicStates = dynamicStates};
constexpr VkPipelineColorBlendAttachmentState writeAll{
    .colorWriteMask = VK_COLOR_COMPONENT_R_BIT | VK_COLOR_COMPONENT_G_BIT |
                      VK_COLOR_COMPONENT_B_BIT | VK_COLOR_COMPONENT_A_BIT};
constexpr VkPipelineColorBlendAttachmentState writes[4] = {writeAll, writeAll, writeAll, writeAll};

VkPipelineShaderStageCreateInfo shaderStage(VkShaderStageFlagBits stage,
                                            const gpu::Handle<VkShaderModule>& module,
                                            const Specialization& constants)
{
    return {.sType = VK_STRUCTURE_TYPE_PIPELINE_SHADER_STAGE_CREATE_INFO,
            .stage = stage,
            .module = module.get(),
            .pName = "main",
            .pSpecializationInfo = &constants.info};
}

gpu::Handle<VkPipeline> createPipeline(const gpu::Device& device, CndGBufferLayout layout,
                                       const PipelineDesc& desc)
{
    const gpu::Handle<VkShaderModule> vertex = gpu::createShaderModule(device, desc.vertex);
    const gpu::Handle<VkShaderModule> fragment = gpu::createShaderModule(device, desc.fragment);
    const Specialization constants(desc.constants);
    const std::array stages{shaderStage(VK_SHADER_STAGE_VERTEX_BIT, vertex, constants),
                            shaderStage(VK_SHADER_STAGE_FRAGMENT_BIT, fragment, constants)};
    const VkPipelineVertexInputStateCreateInfo vertexInput{
        .sType = VK_STRUCTURE_TYPE_PIPELINE_VERTEX_INPUT_STATE_CREATE_INFO,
        .vertexBindingDescriptionCount = uint32_t(desc.streams.size()),
        .pVertexBindingDescriptions = desc.streams.data(),
        .vertexAttributeDescriptionCount = uint32_t(desc.attributes.size()),
        .pVertexAttributeDescriptions = desc.attributes.data()};
    const VkPipelineInputAssemblyStateCreateInfo assembly{
        .sType = VK_STRUCTURE_TYPE_PIPELINE_INPUT_ASSEMBLY_STATE_CREATE_INFO,
        .topology = desc.topology};
    const std::vector<VkFormat> formats = colorFormats(layout, desc.emissive);
    const uint32_t colors = uint32_t(formats.size());
    const VkPipelineColorBlendStateCreateInfo blend{
        .sType = VK_STRUCTURE_TYPE_PIPELINE_COLOR_BLEND_STATE_CREATE_INFO,
        .attachmentCount = colors,
        .pAttachments = writes};
    const VkPipelineRenderingCreateInfo rendering{
        .sType = VK_STRUCTURE_TYPE_PIPELINE_RENDERING_CREATE_INFO,
        .colorAttachmentCount = colors,
        .pColorAttachmentFormats = formats.data(),
        .depthAttachmentFormat = targetFormats(layout).depth};
    const VkGraphicsPipelineCreateInfo info{.sType =
                                                VK_STRUCTURE_TYPE_GRAPHICS_PIPELINE_CREATE_INFO,
                                            .pNext = &rendering,
                                            .stageCount = uint32_t(stages.size()),
                                            .pStages = stages.data(),
                                            .pVertexInputState = &vertexInput,
                                            .pInputAssemblyState = &assembly,
                                            .pViewportState = &viewportState,
                                            .pRasterizationState = &rasterizationState,
                                            .pMultisampleState = &multisampleState,
                                            .pDepthStencilState = &depthState,
                                            .pColorBlendState = &blend,
                                            .pDynamicState = &dynamicState,
                                            .layout = desc.layout};
    VkPipeline pipeline{};
    gpu::check(device.CreateGraphicsPipelines(device.handle, device.pipelineCache, 1, &info,
                                              device.allocationCallbacks, &pipeline),
               "creating pipeline ", desc.name);
    device.name(VK_OBJECT_TYPE_PIPELINE, pipeline, desc.name);
    return {device, pipeline};
}

constexpr VkVertexInputBindingDescription meshStreams[] = {
    {StreamCore, sizeof(VertexCore), VK_VERTEX_INPUT_RATE_VERTEX},
    {StreamDetail, sizeof(VertexDetail), VK_VERTEX_INPUT_RATE_VERTEX},
    {StreamInstance, sizeof(uint32_t), VK_VERTEX_INPUT_RATE_INSTANCE}};
// All meshes read the first three, those with vertex colours the first four, sampled ones all.
constexpr VkVertexInputAttributeDescription meshAttributes[] = {
    {gpu::MESH_POSITION, StreamCore, VK_FORMAT_R32G32B32_SFLOAT, offsetof(VertexCore, position)},
    {gpu::MESH_NORMAL_IN, StreamCore, VK_FORMAT_R32G32B32_SFLOAT, offsetof(VertexCore, normal)},
    {gpu::MESH_INSTANCE, StreamInstance, VK_FORMAT_R32_UINT, 0},
    {gpu::MESH_COLOR, StreamDetail, VK_FORMAT_R32G32B32A32_SFLOAT, offsetof(VertexDetail, color)},
    {gpu::MESH_TANGENT, StreamDetail, VK_FORMAT_R32G32B32A32_SFLOAT,
     offsetof(VertexDetail, tangent)},
    {gpu::MESH_UV, StreamDetail, VK_FORMAT_R32G32B32A32_SFLOAT, offsetof(VertexDetail, uv)}};

// The pipelines of spheres have the first four attributes. All others need those of corners too,
// which only polygons have; the rest read the same 64 bytes for all emitters and ignore them.
constexpr VkVertexInputBindingDescription emitterStreams[] = {
    {StreamEmitter, sizeof(gpu::EmitterRecord), VK_VERTEX_INPUT_RATE_INSTANCE},
    {StreamCorners, 0, VK_VERTEX_INPUT_RATE_INSTANCE}};
constexpr VkVertexInputBindingDescription polygonStreams[] = {
    {StreamEmitter, sizeof(gpu::EmitterRecord), VK_VERTEX_INPUT_RATE_INSTANCE},
    {StreamCorners, sizeof(gpu::EmitterCorners), VK_VERTEX_INPUT_RATE_INSTANCE}};
constexpr VkVertexInputAttributeDescription emitterAttributes[] = {
    {gpu::EMITTER_POSITION, StreamEmitter, VK_FORMAT_R32G32B32A32_SFLOAT,
     offsetof(gpu::EmitterRecord, position)}, // and radius, which follows it
    {gpu::EMITTER_LUMINANCE, StreamEmitter, VK_FORMAT_R32G32B32_SFLOAT,
     offsetof(gpu::EmitterRecord, luminance)},
    {gpu::EMITTER_AXIS_U, StreamEmitter, VK_FORMAT_R32G32B32_SFLOAT,
     offsetof(gpu::EmitterRecord, axisU)},
    {gpu::EMITTER_AXIS_V, StreamEmitter, VK_FORMAT_R32G32B32A32_SFLOAT,
     offsetof(gpu::EmitterRecord, axisV)}, // and twoSided, which follows it
    {gpu::EMITTER_CORNERS, StreamCorners, VK_FORMAT_R32G32B32A32_SFLOAT, 0},
    {gpu::EMITTER_CORNERS + 1, StreamCorners, VK_FORMAT_R32G32B32A32_SFLOAT, 16},
    {gpu::EMITTER_CORNERS + 2, StreamCorners, VK_FORMAT_R32G32B32A32_SFLOAT, 32},
    {gpu::EMITTER_CORNERS + 3, StreamCorners, VK_FORMAT_R32G32B32A32_SFLOAT, 48}};
static_assert(gpu::EMITTER_CORNER_PAIRS == 4);

struct MeshShaders {
    const char* kind;
    const gpu::Spirv& vertex;
    const gpu::Spirv& fragment;
    uint32_t attributes; // how many of meshAttributes it reads
};

MeshShaders meshShaders(CndGBufferLayout layout, const MeshVariant& v)
{
    using namespace spirv;
    if (layout == CND_GBUFFER_COMPACT)
        return {"sampled", mesh_vert_sampled,
                v.emissive ? mesh_frag_compact_sampled_emissive : mesh_frag_compact_sampled, 6};
    if (v.isSampled())
        return {"sampled", mesh_vert_sampled,
                v.emissive ? mesh_frag_full_sampled_emissive : mesh_frag_full_sampled, 6};
    if (v.colored)
        return {"colored", mesh_vert_colored,
                v.emissive ? mesh_frag_full_colored_emissive : mesh_frag_full_colored, 4};
    return {"constant", mesh_vert_constant,
            v.emissive ? mesh_frag_full_constant_emissive : mesh_frag_full_constant, 3};
}

struct EmitterShaders {
    const gpu::Spirv& vertex;
    const gpu::Spirv& fragment;
    uint32_t attributes; // how many of emitterAttributes it reads
};

EmitterShaders emitterShaders(CndGBufferLayout layout, uint32_t shape)
{
    using namespace spirv;
    const bool full = layout == CND_GBUFFER_FULL;
    if (shape == gpu::LIGHT_SPHERE || shape == gpu::LIGHT_DISTANT_SPHERE)
        return {emitter_vert_ball,
                full ? emitter_frag_full_emissive_ball : emitter_frag_compact_emissive_ball, 4};
    return {emitter_vert, full ? emitter_frag_full_emissive : emitter_frag_compact_emissive,
            uint32_t(std::size(emitterAttributes))};
}

} // namespace

std::vector<gpu::ReflectedBinding> rayBindings()
{
    return gpu::reflect(spirv::analytic_frag_full_emissive).bindings;
}

Pipelines::Pipelines(const gpu::Device& device, CndGBufferLayout layout)
    : meshSet(gpu::createSetLayout(device, "mesh", meshBindings(), bothStages)),
      raySet(gpu::createSetLayout(device, "rays", rayBindings(), bothStages)),
      device_(&device),
      layout_(layout)
{
    const VkDescriptorSetLayout raySets[] = {raySet.get()};
    meshLayout = createMeshLayout("mesh");
    analyticLayout = gpu::createPipelineLayout(
        device, "analytic", raySets, VK_SHADER_STAGE_FRAGMENT_BIT, sizeof(gpu::AnalyticParams));
    backgroundLayout = gpu::createPipelineLayout(
        device, "background", raySets, VK_SHADER_STAGE_FRAGMENT_BIT, sizeof(gpu::BackgroundParams));
    emitterLayout = gpu::createPipelineLayout(device, "emitter", raySets, bothStages, 0);

    using namespace spirv;
    const bool full = layout == CND_GBUFFER_FULL;
    const auto screenWide = [&](const char* name, const gpu::Spirv& fragment,
                                std::span<const gpu::SpecConstant> constants,
                                VkPipelineLayout pipelineLayout) {
        return createPipeline(device, layout,
                              {name,
                               analytic_vert,
                               fragment,
                               constants,
                               {},
                               {},
                               VK_PRIMITIVE_TOPOLOGY_TRIANGLE_LIST,
                               pipelineLayout});
    };
    for (const uint32_t shape : {gpu::ANALYTIC_PLANE, gpu::ANALYTIC_BALL}) {
        const std::array constants{gpu::SpecConstant{gpu::RASTER_SHAPE, shape}};
        analytic[shape] =
            screenWide(shape == gpu::ANALYTIC_PLANE ? "analytic plane" : "analytic ball",
                       full ? analytic_frag_full_emissive : analytic_frag_compact_emissive,
                       constants, analyticLayout.get());
    }
    background = screenWide("background",
                            full ? background_frag_full_emissive : background_frag_compact_emissive,
                            {}, backgroundLayout.get());
    for (size_t i = 0; i < emitters.size(); ++i) {
        const uint32_t shape = Emitters::shapes[i];
        const std::array constants{gpu::SpecConstant{gpu::RASTER_SHAPE, shape}};
        const EmitterShaders shaders = emitterShaders(layout, shape);
        const bool polygon = shape == gpu::LIGHT_POLYGON;
        emitters[i] = createPipeline(device, layout,
                                     {"emitter", shaders.vertex, shaders.fragment, constants,
                                      polygon ? polygonStreams : emitterStreams,
                                      std::span(emitterAttributes).first(shaders.attributes),
                                      VK_PRIMITIVE_TOPOLOGY_TRIANGLE_STRIP, emitterLayout.get()});
    }
}

gpu::Handle<VkPipelineLayout> Pipelines::createMeshLayout(const std::string& name) const
{
    const VkDescriptorSetLayout sets[] = {meshSet.get()};
    return gpu::createPipelineLayout(*device_, name.c_str(), sets, VK_SHADER_STAGE_VERTEX_BIT,
                                     sizeof(gpu::MeshParams));
}

void Pipelines::prepareMesh(const MeshVariant& variant)
{
    if (meshes_.contains(variant))
        return;
    const MeshShaders shaders = meshShaders(layout_, variant);
    const std::string name =
        std::string("mesh ") + shaders.kind + (variant.emissive ? " emissive" : "");
    Mesh mesh{.layout = createMeshLayout(name), .pipeline = {}};
    const std::array constants{gpu::SpecConstant{gpu::RASTER_TEXTURES, variant.textures},
                               gpu::SpecConstant{gpu::RASTER_COVERAGE, uint32_t(variant.coverage)},
                               gpu::SpecConstant{gpu::RASTER_UNLIT, variant.unlit}};
    const std::span<const VkVertexInputAttributeDescription> attributes = meshAttributes;
    mesh.pipeline =
        createPipeline(*device_, layout_,
                       {name.c_str(), shaders.vertex, shaders.fragment, constants, meshStreams,
                        attributes.first(shaders.attributes), VK_PRIMITIVE_TOPOLOGY_TRIANGLE_LIST,
                        mesh.layout.get(), variant.emissive});
    meshes_.emplace(variant, std::move(mesh));
}

} // namespace candelabra::gbuffer
