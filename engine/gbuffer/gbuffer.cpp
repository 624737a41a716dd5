// SPDX-License-Identifier: Apache-2.0
#include "gbuffer/gbuffer.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <cstring>
#include <string>
#include <vector>

#include <glm/geometric.hpp>
#include <glm/gtc/type_ptr.hpp>

#include "candelabra_gbuffer_shaders.h"
#include "gbuffer/camera_terms.h"
#include "gbuffer/emitters.h"
#include "gbuffer/geometry_impl.h"
#include "gbuffer/pass_barriers.h"
#include "gbuffer/pipelines.h"
#include "gpu/double_single.h"
#include "gpu/kernel.h"

namespace candelabra::gbuffer
{
namespace
{

using GeometryImpl = Geometry::Impl;

constexpr uint32_t maxFramesInFlight = 8; // the limit of the C ABI

// Returns the comparison of depths that lets nearer surfaces through.
VkCompareOp nearer(const FrameInputs& in)
{
    return in.clearDepth == 0 ? VK_COMPARE_OP_GREATER : VK_COMPARE_OP_LESS;
}

// Calls part(first, count) for consecutive parts of a range, none of which is longer than `most`.
template <typename Part>
void forEachPart(uint32_t first, uint32_t count, uint32_t most, const Part& part)
{
    for (uint32_t done = 0; done < count; done += std::min(most, count - done))
        part(first + done, std::min(most, count - done));
}

gpu::RasterFrame rasterFrame(const CameraTerms& camera, const FrameInputs& in,
                             const std::array<double, 3>& emitterOrigin)
{
    gpu::RasterFrame f{};
    f.clipFromView = camera.clipFromView;
    f.viewFromWorld = glm::mat3(camera.viewFromWorld);
    f.emitterOrigin = glm::vec3(camera.viewFrom(glm::make_vec3(emitterOrigin.data())));
    for (size_t i = 0; i < 3; ++i) {
        f.rayOrigin[i] = glm::vec3(camera.rayOrigin[i]);
        f.rayDirection[i] = glm::vec3(camera.rayDirection[i]);
    }
    f.size = {float(in.width), float(in.height)};
    f.inverseSize = {float(1.0 / in.width), float(1.0 / in.height)};
    f.perspective = camera.perspective ? 1.f : 0.f;
    f.nearDepth = camera.reversedDepth ? 1.f : 0.f;
    f.forward = glm::vec3(camera.forward);
    return f;
}

gpu::CullInstancesFrame cullFrame(const CameraTerms& camera, const FrameInputs& in, uint32_t chunks)
{
    gpu::CullInstancesFrame f{};
    for (size_t i = 0; i < camera.planes.size(); ++i)
        f.planes[i] = in.cullInstances ? glm::vec4(camera.planes[i]) : glm::vec4(0, 0, 0, 1);
    const gpu::DoubleSingle position(camera.position);
    const glm::dmat3 worldFromView = glm::transpose(camera.viewFromWorld);
    f.cameraHi = position.hi;
    f.cameraLo = position.lo;
    f.eye = glm::vec3(worldFromView * camera.rayOrigin[0]);
    f.forward = glm::vec3(worldFromView * camera.forward);
    f.perspective = camera.perspective ? 1.f : 0.f;
    f.pixelScale = float(camera.pixelScale(in.width, in.height));
    f.maxLevelError = in.maxLevelError;
    f.chunkCount = chunks;
    return f;
}

gpu::CullTrianglesFrame trianglesFrame(const CameraTerms& camera, const FrameInputs& in,
                                       uint32_t subPixelBits, uint32_t pieces)
{
    const gpu::DoubleSingle position(camera.position);
    return {.viewFromWorld = glm::mat3(camera.viewFromWorld),
            .clipFromView = camera.clipFromView,
            .cameraHi = position.hi,
            .cameraLo = position.lo,
            .size = {float(in.width), float(in.height)},
            .snap = float(std::exp2(-double(subPixelBits))),
            .winding = camera.mirrored ? -1.f : 1.f,
            .pieceCount = pieces};
}

gpu::AnalyticParams analyticParams(const AnalyticObject& object, const Material& material,
                                   const CameraTerms& camera)
{
    gpu::AnalyticParams p{};
    const glm::dvec3 point = camera.viewFrom(glm::make_vec3(object.point));
    if (object.type == AnalyticObject::Type::Plane) {
        const glm::dvec3 normal = camera.viewFromWorld * glm::make_vec3(object.normal);
        p.normalOrCenter = glm::vec3(normal);
        for (int i = 0; i < 3; ++i) {
            const glm::dvec3 origin = camera.rayOrigin[i] - (i == 0 ? point : glm::dvec3(0));
            p.height[i] = float(glm::dot(normal, origin));
            p.slope[i] = float(glm::dot(normal, camera.rayDirection[i]));
        }
    } else {
        const glm::dvec3 toCenter = point - camera.rayOrigin[0];
        p.normalOrCenter = glm::vec3(point);
        p.radius = float(object.radius);
        p.power = float(glm::dot(toCenter, toCenter) - object.radius * object.radius);
    }
    p.baseColor = glm::make_vec3(material.baseColor);
    p.metalness = material.metalness;
    p.perceptualRoughness = material.perceptualRoughness;
    p.dielectricF0 = glm::make_vec3(material.dielectricF0);
    p.diffuseWeight = material.diffuseWeight;
    p.specularWeight = material.specularWeight;
    p.emission = glm::make_vec3(material.emission);
    return p;
}

} // namespace

struct GBuffer::Impl {
    const gpu::Device& device;
    GBufferDesc desc;
    gpu::Timer timer;
    gpu::Kernel<gpu::NoParams> cullInstances;
    gpu::Kernel<gpu::CompactInstancesParams> compactInstances;
    gpu::Kernel<gpu::NoParams> cullTriangles;
    Pipelines pipelines;
    std::vector<gpu::Buffer> rasterFrames; // one RasterFrame per slot
    gpu::Bindings raySets;                 // one per slot
    Emitters emitters;

    Impl(const gpu::Device& d, const GBufferDesc& g);

    bool cullsEmitters(const FrameInputs& in) const
    {
        return in.drawEmitters && in.cullTriangles && emitters.canCull();
    }
    void recordCulling(const gpu::Frame& frame, const GeometryImpl& geometry,
                       const CameraTerms& camera, const FrameInputs& in) const noexcept;
    void setState(VkCommandBuffer cmd, const FrameInputs& in) const noexcept;
    void beginRendering(VkCommandBuffer cmd, const FrameInputs& in, bool emissive) const noexcept;
    void drawMeshes(VkCommandBuffer cmd, const GeometryImpl& geometry, const CameraTerms& camera,
                    const FrameInputs& in, bool emissive) const noexcept;
    void drawRun(VkCommandBuffer cmd, const GeometryImpl& geometry, const Run& run,
                 bool culledTriangles) const noexcept;
    void drawAnalytic(VkCommandBuffer cmd, const GeometryImpl& geometry, const CameraTerms& camera,
                      const FrameInputs& in) const noexcept;
    void drawBackground(VkCommandBuffer cmd, const FrameInputs& in) const noexcept;
    void drawEmitters(VkCommandBuffer cmd, uint32_t slot, bool culled) const noexcept;
    void bindRays(VkCommandBuffer cmd, VkPipelineLayout layout, uint32_t slot) const noexcept
    {
        const VkDescriptorSet set = raySets.set(slot);
        device.CmdBindDescriptorSets(cmd, VK_PIPELINE_BIND_POINT_GRAPHICS, layout, 0, 1, &set, 0,
                                     nullptr);
    }
};

GBuffer::Impl::Impl(const gpu::Device& d, const GBufferDesc& g)
    : device(d),
      desc(g),
      timer(d, "gbuffer", g.framesInFlight, g.timestamps),
      cullInstances(d, spirv::cull_instances_comp),
      compactInstances(d, spirv::compact_instances_comp),
      pipelines(d, g.layout),
      raySets(d, "rays", rayBindings(), VK_SHADER_STAGE_VERTEX_BIT | VK_SHADER_STAGE_FRAGMENT_BIT,
              g.framesInFlight),
      emitters(d, g.framesInFlight)
{
    if (cullsTriangles(d))
        cullTriangles = {d, spirv::cull_triangles_comp};
    for (uint32_t slot = 0; slot < g.framesInFlight; ++slot) {
        rasterFrames.push_back(gpu::createBuffer(d, "raster frame", sizeof(gpu::RasterFrame),
                                                 VK_BUFFER_USAGE_UNIFORM_BUFFER_BIT,
                                                 gpu::MemoryUse::Upload));
        raySets.write(slot, {gpu::Binding::of(gpu::RAY_FRAME, rasterFrames.back())});
    }
}

void GBuffer::Impl::recordCulling(const gpu::Frame& frame, const GeometryImpl& geometry,
                                  const CameraTerms& camera, const FrameInputs& in) const noexcept
{
    const uint32_t chunks = in.drawInstances ? geometry.chunkCount : 0;
    const gpu::CullInstancesFrame cull = cullFrame(camera, in, chunks);
    device.CmdUpdateBuffer(frame.cmd, geometry.cullFrame.get(), 0, sizeof cull, &cull);
    const TriangleTest& triangles = geometry.triangles;
    const uint32_t pieces = in.drawInstances && in.cullTriangles ? triangles.pieceCount : 0;
    if (pieces) {
        const gpu::CullTrianglesFrame test =
            trianglesFrame(camera, in, device.limits.subPixelPrecisionBits, pieces);
        device.CmdUpdateBuffer(frame.cmd, triangles.frame.get(), 0, sizeof test, &test);
    }
    frame.barrier();
    cullInstances.dispatch(frame, geometry.cullSet.set(0), {},
                           gpu::divideUp(chunks, gpu::CULL_INSTANCES_GROUP));
    frame.barrier();
    compactInstances.dispatch(
        frame, geometry.compactSet.set(0), {chunks},
        gpu::divideUp(chunks * gpu::MESH_LEVELS, gpu::COMPACT_INSTANCES_GROUP));
    if (cullsEmitters(in)) {
        frame.barrier(); // so that the time of the kernels before is not told as part of this one's
        emitters.recordCulling(frame);
    }
    if (!pieces)
        return;
    frame.barrier();
    cullTriangles.dispatch(frame, triangles.set.set(0), {},
                           gpu::divideUp(pieces, gpu::CULL_TRIANGLES_GROUP));
}

// Begins to draw the meshes that emit nothing, or everything else, after them.
void GBuffer::Impl::beginRendering(VkCommandBuffer cmd, const FrameInputs& in,
                                   bool emissive) const noexcept
{
    const auto attachment = [](const Attachment& a, VkImageLayout layout, bool clears,
                               VkClearValue value) {
        return VkRenderingAttachmentInfo{.sType = VK_STRUCTURE_TYPE_RENDERING_ATTACHMENT_INFO,
                                         .imageView = a.view,
                                         .imageLayout = layout,
                                         .loadOp = clears ? VK_ATTACHMENT_LOAD_OP_CLEAR
                                                          : VK_ATTACHMENT_LOAD_OP_LOAD,
                                         .storeOp = VK_ATTACHMENT_STORE_OP_STORE,
                                         .clearValue = value};
    };
    constexpr VkImageLayout color = VK_IMAGE_LAYOUT_COLOR_ATTACHMENT_OPTIMAL;
    const VkClearValue zero{}, dark{.color = {.float32 = {0, 0, 0, 1}}};
    const Attachments& a = in.attachments;
    // In the order of fragment output locations (shaders/gbuffer/output.glsl).
    std::array<VkRenderingAttachmentInfo, 4> colors{
        attachment(a.normalRoughness, color, !emissive, zero),
        attachment(a.albedo, color, !emissive, zero)};
    uint32_t count = 2;
    if (desc.layout == CND_GBUFFER_FULL)
        colors[count++] = attachment(a.specular, color, !emissive, zero);
    if (emissive)
        colors[count++] = attachment(a.radiance, color, true, dark);
    const VkRenderingAttachmentInfo depth =
        attachment(a.depth, VK_IMAGE_LAYOUT_DEPTH_ATTACHMENT_OPTIMAL, !emissive,
                   {.depthStencil = {.depth = in.clearDepth}});
    const VkRenderingInfo info{.sType = VK_STRUCTURE_TYPE_RENDERING_INFO,
                               .renderArea = {{0, 0}, {in.width, in.height}},
                               .layerCount = 1,
                               .colorAttachmentCount = count,
                               .pColorAttachments = colors.data(),
                               .pDepthAttachment = &depth};
    device.CmdBeginRendering(cmd, &info);
}

void GBuffer::Impl::setState(VkCommandBuffer cmd, const FrameInputs& in) const noexcept
{
    const VkRect2D area{{0, 0}, {in.width, in.height}};
    const VkViewport viewport{0, 0, float(in.width), float(in.height), 0, 1};
    device.CmdSetViewport(cmd, 0, 1, &viewport);
    device.CmdSetScissor(cmd, 0, 1, &area);
    device.CmdSetDepthCompareOp(cmd, nearer(in));
    device.CmdSetCullMode(cmd, VK_CULL_MODE_NONE);
    device.CmdSetFrontFace(cmd, VK_FRONT_FACE_COUNTER_CLOCKWISE);
}

// `culledTriangles`: cull_triangles has tested the triangles of the runs that it tests.
void GBuffer::Impl::drawRun(VkCommandBuffer cmd, const GeometryImpl& g, const Run& run,
                            bool culledTriangles) const noexcept
{
    const gpu::Buffer& indices = run.tested && culledTriangles ? g.triangles.kept : g.indices;
    device.CmdBindIndexBuffer(cmd, indices.get(), 0, VK_INDEX_TYPE_UINT32);
    const DrawRange draws = g.drawsOf(run, culledTriangles);
    forEachPart(draws.first, draws.count, device.limits.maxDrawIndirectCount,
                [&](uint32_t first, uint32_t count) {
                    constexpr uint32_t stride = sizeof(gpu::DrawCommand);
                    device.CmdDrawIndexedIndirect(cmd, draws.commands, first * stride, count,
                                                  stride);
                });
}

// Draws the meshes whose material emits light, or the others.
void GBuffer::Impl::drawMeshes(VkCommandBuffer cmd, const GeometryImpl& g,
                               const CameraTerms& camera, const FrameInputs& in,
                               bool emissive) const noexcept
{
    const gpu::DoubleSingle position(camera.position);
    const gpu::MeshParams params{glm::mat3(camera.viewFromWorld), camera.clipFromView, position.hi,
                                 position.lo, in.coverageFrame};
    const VkPipelineLayout layout = pipelines.meshLayout.get();
    device.CmdPushConstants(cmd, layout, VK_SHADER_STAGE_VERTEX_BIT, 0, sizeof params, &params);
    const VkBuffer streams[StreamCount] = {g.vertices.get(), g.vertices.get(), g.visible.get()};
    const VkDeviceSize offsets[StreamCount] = {0, g.detailOffset, 0};
    device.CmdBindVertexBuffers(cmd, 0, StreamCount, streams, offsets);
    for (const Run& run : g.runs) {
        if (run.variant.emissive != emissive)
            continue;
        device.CmdBindPipeline(cmd, VK_PIPELINE_BIND_POINT_GRAPHICS, pipelines.mesh(run.variant));
        const VkDescriptorSet set = g.meshSets.set(run.textureSet);
        device.CmdBindDescriptorSets(cmd, VK_PIPELINE_BIND_POINT_GRAPHICS, layout, 0, 1, &set, 0,
                                     nullptr);
        device.CmdSetCullMode(cmd, run.doubleSided ? VK_CULL_MODE_NONE : VK_CULL_MODE_BACK_BIT);
        device.CmdSetFrontFace(cmd, run.mirrored != camera.mirrored
                                        ? VK_FRONT_FACE_CLOCKWISE
                                        : VK_FRONT_FACE_COUNTER_CLOCKWISE);
        drawRun(cmd, g, run, in.cullTriangles);
    }
    device.CmdSetCullMode(cmd, VK_CULL_MODE_NONE);
}

void GBuffer::Impl::drawAnalytic(VkCommandBuffer cmd, const GeometryImpl& g,
                                 const CameraTerms& camera, const FrameInputs& in) const noexcept
{
    bindRays(cmd, pipelines.analyticLayout.get(), in.slot);
    const VkRect2D everywhere{{0, 0}, {in.width, in.height}};
    for (const AnalyticObject& object : g.analyticObjects) {
        const bool isBall = object.type == AnalyticObject::Type::Ball;
        const VkRect2D area =
            isBall ? camera.pixelsOfBall(camera.viewFrom(glm::make_vec3(object.point)),
                                         object.radius, in.width, in.height)
                   : everywhere;
        if (area.extent.width == 0 || area.extent.height == 0)
            continue;
        const gpu::AnalyticParams params =
            analyticParams(object, g.materialFactors[object.material], camera);
        device.CmdSetScissor(cmd, 0, 1, &area);
        device.CmdBindPipeline(
            cmd, VK_PIPELINE_BIND_POINT_GRAPHICS,
            pipelines.analytic[isBall ? gpu::ANALYTIC_BALL : gpu::ANALYTIC_PLANE].get());
        device.CmdPushConstants(cmd, pipelines.analyticLayout.get(), VK_SHADER_STAGE_FRAGMENT_BIT,
                                0, sizeof params, &params);
        device.CmdDraw(cmd, 3, 1, 0, 0);
    }
    device.CmdSetScissor(cmd, 0, 1, &everywhere);
}

// Draws it where the depth is still clear.
void GBuffer::Impl::drawBackground(VkCommandBuffer cmd, const FrameInputs& in) const noexcept
{
    const auto& b = in.background;
    if (b[0] == 0 && b[1] == 0 && b[2] == 0)
        return;
    const VkPipelineLayout layout = pipelines.backgroundLayout.get();
    const gpu::BackgroundParams params{{b[0], b[1], b[2]}};
    bindRays(cmd, layout, in.slot);
    device.CmdSetDepthCompareOp(cmd, VK_COMPARE_OP_EQUAL);
    device.CmdBindPipeline(cmd, VK_PIPELINE_BIND_POINT_GRAPHICS, pipelines.background.get());
    device.CmdPushConstants(cmd, layout, VK_SHADER_STAGE_FRAGMENT_BIT, 0, sizeof params, &params);
    device.CmdDraw(cmd, 3, 1, 0, 0);
    device.CmdSetDepthCompareOp(cmd, nearer(in));
}

// Draws the visible lights: one quad for each, as a triangle strip. `culled`: cull_emitters has
// left out those that cover no sample.
void GBuffer::Impl::drawEmitters(VkCommandBuffer cmd, uint32_t slot, bool culled) const noexcept
{
    bindRays(cmd, pipelines.emitterLayout.get(), slot);
    const VkBuffer records = emitters.buffer(slot, culled);
    const VkBuffer buffers[] = {records, records};
    for (size_t i = 0; i < Emitters::shapes.size(); ++i) {
        const Emitters::Group& group = emitters.groups()[i];
        if (!group.count)
            continue;
        if (Emitters::isDistant(Emitters::shapes[i]))
            device.CmdSetDepthCompareOp(cmd, VK_COMPARE_OP_EQUAL); // only where the depth is still
                                                                   // clear
        device.CmdBindPipeline(cmd, VK_PIPELINE_BIND_POINT_GRAPHICS, pipelines.emitters[i].get());
        const VkDeviceSize offsets[] = {group.first * sizeof(gpu::EmitterRecord),
                                        emitters.cornersOffset()};
        device.CmdBindVertexBuffers(cmd, 0, 2, buffers, offsets);
        if (culled)
            forEachPart(group.firstPiece, group.pieceCount, device.limits.maxDrawIndirectCount,
                        [&](uint32_t first, uint32_t count) {
                            constexpr uint32_t stride = sizeof(gpu::EmitterDraw);
                            device.CmdDrawIndirect(cmd, emitters.draws(slot), first * stride, count,
                                                   stride);
                        });
        else
            device.CmdDraw(cmd, 4, group.count, 0, 0);
    }
}

GBuffer::GBuffer(const gpu::Device& device, const GBufferDesc& desc)
{
    if (desc.framesInFlight < 1 || desc.framesInFlight > maxFramesInFlight)
        gpu::failArgument("GBufferDesc: framesInFlight is " + std::to_string(desc.framesInFlight) +
                          ", not 1 to " + std::to_string(maxFramesInFlight));
    impl_ = std::make_unique<Impl>(device, desc);
}

GBuffer::~GBuffer() = default;
GBuffer::GBuffer(GBuffer&&) noexcept = default;
GBuffer& GBuffer::operator=(GBuffer&&) noexcept = default;

void GBuffer::prepare(const Geometry& geometry)
{
    std::vector<MeshVariant> variants;
    for (const Run& run : geometry.impl().runs)
        variants.push_back(run.variant);
    prepare(variants);
}

void GBuffer::prepare(std::span<const MeshVariant> variants)
{
    for (const MeshVariant& variant : variants)
        impl_->pipelines.prepareMesh(variant);
}

void GBuffer::setEmitters(std::span<const CndLight> lights, const double origin[3])
{
    impl_->emitters.set(lights, origin);
}

bool GBuffer::cullsEmitters() const
{
    return impl_->emitters.canCull();
}

std::vector<DrawRange> GBuffer::emitterDraws(uint32_t slot) const
{
    std::vector<DrawRange> draws;
    for (const Emitters::Group& group : impl_->emitters.groups())
        if (group.pieceCount)
            draws.push_back({impl_->emitters.draws(slot), group.firstPiece, group.pieceCount});
    return draws;
}

void GBuffer::record(VkCommandBuffer cmd, const Geometry& geometry, const FrameInputs& in) noexcept
{
    Impl& s = *impl_;
    const GeometryImpl& g = geometry.impl();
    const CameraTerms camera(in.camera, in.clearDepth);
    const gpu::RasterFrame rays = rasterFrame(camera, in, s.emitters.origin());
    std::memcpy(s.rasterFrames[in.slot].mapped, &rays, sizeof rays);
    s.emitters.update(in.slot, s.rasterFrames[in.slot]);

    s.timer.begin(cmd, in.slot);
    waitForEarlierDraws(s.device, cmd); // earlier draws read what culling will write
    s.recordCulling({s.device, cmd, s.timer, in.slot}, g, camera, in);

    s.device.beginLabel(cmd, "gbuffer_raster");
    prepareAttachments(s.device, cmd, in.attachments);
    // Meshes that emit nothing are drawn without the attachment for radiance: that is 16 bytes per
    // pixel less. Everything else comes after them, so that they have no radiance to cover with 0.
    const bool meshes = in.drawInstances && g.chunkCount;
    s.setState(cmd, in);
    s.beginRendering(cmd, in, false);
    if (meshes)
        s.drawMeshes(cmd, g, camera, in, false);
    s.device.CmdEndRendering(cmd);
    betweenDraws(s.device, cmd);
    s.beginRendering(cmd, in, true);
    s.drawBackground(cmd, in);
    if (meshes)
        s.drawMeshes(cmd, g, camera, in, true);
    if (in.drawAnalytic && !g.analyticObjects.empty())
        s.drawAnalytic(cmd, g, camera, in);
    if (in.drawEmitters && !s.emitters.empty())
        s.drawEmitters(cmd, in.slot, s.cullsEmitters(in));
    s.device.CmdEndRendering(cmd);
    handToCompute(s.device, cmd, in.attachments);
    s.device.endLabel(cmd);
    s.timer.stamp(cmd, "gbuffer_raster");
}

bool GBuffer::times(uint32_t slot, CndKernelTime* times, uint32_t& count) const noexcept
{
    return impl_->timer.read(slot, times, count) == CND_SUCCESS;
}

} // namespace candelabra::gbuffer
