// SPDX-License-Identifier: Apache-2.0
#include "gbuffer/geometry.h"

#include <algorithm>
#include <cstring>
#include <string>

#include "candelabra_gbuffer_shaders.h"
#include "gbuffer/geometry_impl.h"
#include "gbuffer/meshes.h"
#include "gbuffer/mipmaps.h"
#include "gbuffer/samplers.h"

namespace candelabra::gbuffer
{
namespace
{

using gpu::Binding;
using gpu::MemoryUse;

// Alignment in the staging buffer: at least an RGBA8 texel, and convenient for memcpy.
constexpr VkDeviceSize stagingAlignment = 16;
// Mip levels of a texture of 2^15 texels per side, the largest that any device allows today.
constexpr uint32_t maxMipLevels = 16;

template <typename T>
std::span<const std::byte> bytesOf(const std::vector<T>& data)
{
    return std::as_bytes(std::span(data));
}

// Collects all uploads first, so that one staging buffer of the right size can be created.
class Uploads
{
public:
    explicit Uploads(Geometry::Impl& g) : g_(g) {}

    // The data must stay valid until write().
    gpu::Buffer buffer(const char* name, std::span<const std::byte> data, VkBufferUsageFlags usage)
    {
        gpu::Buffer b =
            gpu::createBuffer(*g_.device, name, data.size(),
                              usage | VK_BUFFER_USAGE_TRANSFER_DST_BIT, MemoryUse::Device);
        g_.counts.bytes += b.size;
        add(b, 0, data);
        return b;
    }

    // The data must stay valid until write().
    void add(const gpu::Buffer& target, VkDeviceSize offset, std::span<const std::byte> data)
    {
        if (data.empty())
            return;
        g_.copies.push_back({target.get(), {size_, offset, data.size()}});
        sources_.push_back(data);
        size_ = alignUp(size_ + data.size());
    }

    void add(uint32_t texture, std::vector<MipLevel> levels, const Texture& source)
    {
        const VkDeviceSize bytes = chainBytes(levels);
        g_.textureCopies.push_back({texture, size_});
        chains_.push_back({source, std::move(levels), bytes});
        size_ = alignUp(size_ + bytes);
    }

    void write()
    {
        g_.staging = gpu::createBuffer(*g_.device, "geometry staging", size_,
                                       VK_BUFFER_USAGE_TRANSFER_SRC_BIT, MemoryUse::Upload);
        std::byte* const to = g_.staging.mapped;
        for (size_t i = 0; i < sources_.size(); ++i)
            std::memcpy(to + g_.copies[i].region.srcOffset, sources_[i].data(), sources_[i].size());
        for (size_t i = 0; i < chains_.size(); ++i)
            writeMips(chains_[i].source, chains_[i].levels,
                      {to + g_.textureCopies[i].offset, chains_[i].bytes});
    }

private:
    struct Chain {
        Texture source;
        std::vector<MipLevel> levels;
        size_t bytes;
    };
    static VkDeviceSize alignUp(VkDeviceSize size)
    {
        return (size + stagingAlignment - 1) / stagingAlignment * stagingAlignment;
    }

    Geometry::Impl& g_;
    std::vector<std::span<const std::byte>> sources_; // one per g_.copies
    std::vector<Chain> chains_;                       // one per g_.textureCopies
    VkDeviceSize size_ = 0;
};

void createTexture(Geometry::Impl& g, Uploads& uploads, const Texture& source,
                   const std::string& name)
{
    const uint32_t limit = g.device->limits.maxImageDimension2D;
    if (!source.width || !source.height || source.width > limit || source.height > limit)
        gpu::failUnsupported(name + " is " + std::to_string(source.width) + "x" +
                             std::to_string(source.height) + " texels; the device allows 1 to " +
                             std::to_string(limit) + " per side");
    if (source.rgba.size() != size_t(source.width) * source.height * 4)
        gpu::failArgument(name + " has " + std::to_string(source.rgba.size()) +
                          " bytes, not four per texel");
    std::vector<MipLevel> levels = mipLayout(source.width, source.height);
    if (source.nearest || levels.size() > maxMipLevels)
        levels.resize(source.nearest ? 1 : maxMipLevels);
    g.textures.push_back(gpu::createImage(
        *g.device, name, source.srgb ? VK_FORMAT_R8G8B8A8_SRGB : VK_FORMAT_R8G8B8A8_UNORM,
        source.width, source.height, VK_IMAGE_USAGE_SAMPLED_BIT | VK_IMAGE_USAGE_TRANSFER_DST_BIT,
        VK_IMAGE_ASPECT_COLOR_BIT, uint32_t(levels.size())));
    g.counts.bytes += chainBytes(levels);
    uploads.add(uint32_t(g.textures.size() - 1), std::move(levels), source);
}

void createTexels(const Geometry::Impl& g, gpu::Buffer& buffer, const char* what)
{
    constexpr VkDeviceSize texelBytes = 16;
    if (buffer.size / texelBytes > g.device->limits.maxTexelBufferElements)
        gpu::failUnsupported("the scene has more " + std::string(what) +
                             " than the device's texel buffers hold (" +
                             std::to_string(g.device->limits.maxTexelBufferElements) + " texels)");
    gpu::createTexelView(*g.device, buffer);
}

void createCulling(Geometry::Impl& g, VkDeviceSize visibleCount)
{
    const gpu::Device& d = *g.device;
    constexpr VkBufferUsageFlags storage = VK_BUFFER_USAGE_STORAGE_BUFFER_BIT;
    const auto create = [&](const char* name, VkDeviceSize size, VkBufferUsageFlags usage) {
        g.counts.bytes += size;
        return gpu::createBuffer(d, name, size, usage, MemoryUse::Device);
    };
    const VkDeviceSize chunkLevels = VkDeviceSize(g.chunkCount) * gpu::MESH_LEVELS;
    g.bits = create("chunk visibility", chunkLevels * sizeof(glm::uvec2), storage);
    g.chunkCounts = create("chunk counts", chunkLevels * sizeof(uint32_t), storage);
    g.visible = create("visible instances", visibleCount * sizeof(uint32_t),
                       storage | VK_BUFFER_USAGE_VERTEX_BUFFER_BIT |
                           VK_BUFFER_USAGE_TRANSFER_SRC_BIT); // lets tests copy it
    g.cullFrame = create("culling frame", sizeof(gpu::CullInstancesFrame),
                         VK_BUFFER_USAGE_UNIFORM_BUFFER_BIT | VK_BUFFER_USAGE_TRANSFER_DST_BIT);

    const auto bindings = [&](const gpu::Spirv& spirv) {
        return gpu::Bindings(d, spirv.name, gpu::reflect(spirv).bindings,
                             VK_SHADER_STAGE_COMPUTE_BIT, 1);
    };
    g.cullSet = bindings(spirv::cull_instances_comp);
    g.cullSet.write(0, {Binding::of(gpu::CULL_INSTANCES_CHUNKS, g.chunks),
                        Binding::of(gpu::CULL_INSTANCES_BOUNDS, g.bounds),
                        Binding::of(gpu::CULL_INSTANCES_BITS, g.bits),
                        Binding::of(gpu::CULL_INSTANCES_COUNTS, g.chunkCounts),
                        Binding::of(gpu::CULL_INSTANCES_FRAME, g.cullFrame)});
    g.compactSet = bindings(spirv::compact_instances_comp);
    g.compactSet.write(0, {Binding::of(gpu::COMPACT_INSTANCES_CHUNKS, g.chunks),
                           Binding::of(gpu::COMPACT_INSTANCES_BITS, g.bits),
                           Binding::of(gpu::COMPACT_INSTANCES_COUNTS, g.chunkCounts),
                           Binding::of(gpu::COMPACT_INSTANCES_VISIBLE, g.visible),
                           Binding::of(gpu::COMPACT_INSTANCES_COMMANDS, g.commands)});
}

// The buffers must have been created that culling instances needs.
void createTriangleTest(Geometry::Impl& g, Uploads& uploads, const TrianglePieces& pieces,
                        std::span<const gpu::TriangleCorner> corners)
{
    TriangleTest& t = g.triangles;
    const gpu::Device& d = *g.device;
    t.pieceCount = uint32_t(pieces.batchOfPiece().size());
    if (!t.pieceCount)
        return;
    constexpr VkBufferUsageFlags storage = VK_BUFFER_USAGE_STORAGE_BUFFER_BIT;
    const auto create = [&](const char* name, VkDeviceSize size, VkBufferUsageFlags usage) {
        g.counts.bytes += size;
        return gpu::createBuffer(d, name, size, usage, MemoryUse::Device);
    };
    t.corners = uploads.buffer("triangle corners", std::as_bytes(corners),
                               VK_BUFFER_USAGE_UNIFORM_TEXEL_BUFFER_BIT);
    gpu::createTexelView(d, t.corners);
    t.batches = uploads.buffer("piece batches", bytesOf(pieces.batches()), storage);
    t.batchOfPiece = uploads.buffer("batches of pieces", bytesOf(pieces.batchOfPiece()), storage);
    t.kept = create("kept indices", pieces.keptCount() * sizeof(uint32_t),
                    storage | VK_BUFFER_USAGE_INDEX_BUFFER_BIT);
    t.draws =
        create("piece draws", t.pieceCount * sizeof(gpu::DrawCommand),
               storage | VK_BUFFER_USAGE_INDIRECT_BUFFER_BIT | VK_BUFFER_USAGE_TRANSFER_SRC_BIT);
    t.frame = create("triangle frame", sizeof(gpu::CullTrianglesFrame),
                     VK_BUFFER_USAGE_UNIFORM_BUFFER_BIT | VK_BUFFER_USAGE_TRANSFER_DST_BIT);
    t.set = gpu::Bindings(d, "cull_triangles", gpu::reflect(spirv::cull_triangles_comp).bindings,
                          VK_SHADER_STAGE_COMPUTE_BIT, 1);
    t.set.write(0, {Binding::of(gpu::CULL_TRIANGLES_FRAME, t.frame),
                    Binding::ofTexels(gpu::CULL_TRIANGLES_INSTANCES, g.instances),
                    Binding::ofTexels(gpu::CULL_TRIANGLES_CORNERS, t.corners),
                    Binding::of(gpu::CULL_TRIANGLES_BATCHES, t.batches),
                    Binding::of(gpu::CULL_TRIANGLES_PIECE_BATCHES, t.batchOfPiece),
                    Binding::of(gpu::CULL_TRIANGLES_VISIBLE, g.visible),
                    Binding::of(gpu::CULL_TRIANGLES_COMMANDS, g.commands),
                    Binding::of(gpu::CULL_TRIANGLES_KEPT, t.kept),
                    Binding::of(gpu::CULL_TRIANGLES_DRAWS, t.draws)});
}

void createMeshSets(Geometry::Impl& g, const std::vector<TextureSet>& sets,
                    const GeometryDesc& desc)
{
    SamplerCache samplers(*g.device);
    const uint32_t white = uint32_t(g.textures.size() - 1);
    g.meshSets = gpu::Bindings(*g.device, "mesh", meshBindings(),
                               VK_SHADER_STAGE_VERTEX_BIT | VK_SHADER_STAGE_FRAGMENT_BIT,
                               uint32_t(sets.size()));
    for (uint32_t s = 0; s < sets.size(); ++s) {
        const auto texture = [&](uint32_t slot) {
            const int32_t index = sets[s][slot];
            const Texture mode = index < 0 ? Texture{} : desc.textures[size_t(index)];
            Binding b = Binding::sampled(gpu::MESH_TEXTURES + slot,
                                         g.textures[index < 0 ? white : index].view.get());
            b.sampler = samplers.get(mode.wrapU, mode.wrapV, mode.nearest);
            return b;
        };
        g.meshSets.write(s, {Binding::ofTexels(gpu::MESH_INSTANCES, g.instances),
                             Binding::ofTexels(gpu::MESH_MATERIALS, g.materials), texture(0),
                             texture(1), texture(2), texture(3)});
    }
    g.samplers = samplers.take();
}

void createTextures(Geometry::Impl& g, Uploads& uploads, std::span<const Texture> textures)
{
    for (size_t i = 0; i < textures.size(); ++i)
        createTexture(g, uploads, textures[i], "texture " + std::to_string(i));
    static constexpr uint8_t white[4] = {255, 255, 255, 255};
    createTexture(g, uploads, {.width = 1, .height = 1, .rgba = white}, "white texture");
}

GeometryCounts countsOf(const PackedMeshes& meshes, const Batches& batches)
{
    GeometryCounts counts{.meshes = uint32_t(meshes.meshes.size()),
                          .instances = uint32_t(batches.instances.size()),
                          .draws = uint32_t(batches.commands.size()),
                          .textureSets = uint32_t(batches.textureSets.size())};
    for (const gpu::Chunk& chunk : batches.chunks)
        counts.triangles +=
            uint64_t(batches.commands[chunk.firstCommand].indexCount / 3) * chunk.count;
    return counts;
}

void createVertices(Geometry::Impl& g, Uploads& uploads, const PackedMeshes& meshes)
{
    const auto core = std::as_bytes(std::span(meshes.core));
    const auto detail = std::as_bytes(std::span(meshes.detail));
    g.detailOffset = core.size();
    g.vertices = gpu::createBuffer(
        *g.device, "vertices", core.size() + detail.size(),
        VK_BUFFER_USAGE_VERTEX_BUFFER_BIT | VK_BUFFER_USAGE_TRANSFER_DST_BIT, MemoryUse::Device);
    g.counts.bytes += g.vertices.size;
    uploads.add(g.vertices, 0, core);
    uploads.add(g.vertices, g.detailOffset, detail);
}

} // namespace

std::vector<gpu::ReflectedBinding> meshBindings()
{
    // The variants of these shaders that have the most bindings.
    std::vector<gpu::ReflectedBinding> all = gpu::reflect(spirv::mesh_vert_constant).bindings;
    for (const gpu::ReflectedBinding& b : gpu::reflect(spirv::mesh_frag_full_sampled).bindings)
        if (std::none_of(all.begin(), all.end(), [&](auto& a) { return a.binding == b.binding; }))
            all.push_back(b);
    return all;
}

Geometry::Geometry(const gpu::Device& device, const GeometryDesc& desc)
    : impl_(std::make_unique<Impl>(Impl{.device = &device}))
{
    const PackedMeshes meshes = packMeshes(desc.meshes, texturedMeshes(desc));
    Batches batches =
        buildBatches(desc, meshes.meshes, device.limits.maxDrawIndirectCount,
                     cullsTriangles(device) ? device.limits.maxTexelBufferElements : 0);
    std::vector<gpu::MaterialRecord> materials;
    for (const Material& material : desc.materials)
        materials.push_back(materialRecord(material));
    for (size_t i = 0; i < desc.analyticObjects.size(); ++i)
        if (desc.analyticObjects[i].material >= desc.materials.size())
            gpu::failArgument("analytic object " + std::to_string(i) +
                              " has a material that does not exist");

    Impl& g = *impl_;
    g.counts = countsOf(meshes, batches);
    Uploads uploads(g);
    constexpr VkBufferUsageFlags storage = VK_BUFFER_USAGE_STORAGE_BUFFER_BIT;
    constexpr VkBufferUsageFlags texels = VK_BUFFER_USAGE_UNIFORM_TEXEL_BUFFER_BIT;
    createVertices(g, uploads, meshes);
    g.indices =
        uploads.buffer("indices", bytesOf(meshes.indices), VK_BUFFER_USAGE_INDEX_BUFFER_BIT);
    g.instances = uploads.buffer("instances", bytesOf(batches.instances), texels);
    g.materials = uploads.buffer("materials", bytesOf(materials), texels);
    g.bounds = uploads.buffer("instance bounds", bytesOf(batches.bounds), storage);
    g.chunks = uploads.buffer("chunks", bytesOf(batches.chunks), storage);
    g.commands = uploads.buffer("draw commands", bytesOf(batches.commands),
                                storage | VK_BUFFER_USAGE_INDIRECT_BUFFER_BIT |
                                    VK_BUFFER_USAGE_TRANSFER_SRC_BIT); // lets hosts copy out how
                                                                       // many instances were drawn
    g.chunkCount = uint32_t(batches.chunks.size());
    createTexels(g, g.instances, "instances");
    createTexels(g, g.materials, "materials");
    createTextures(g, uploads, desc.textures);
    createCulling(g, batches.visibleCount);
    const std::vector<gpu::TriangleCorner> corners = batches.pieces.corners(meshes);
    createTriangleTest(g, uploads, batches.pieces, corners);
    createMeshSets(g, batches.textureSets, desc);
    g.runs = std::move(batches.runs);
    g.analyticObjects.assign(desc.analyticObjects.begin(), desc.analyticObjects.end());
    g.materialFactors.assign(desc.materials.begin(), desc.materials.end());
    uploads.write();
}

Geometry::~Geometry() = default;
Geometry::Geometry(Geometry&&) noexcept = default;
Geometry& Geometry::operator=(Geometry&&) noexcept = default;

GeometryCounts Geometry::counts() const
{
    return impl_->counts;
}

bool Geometry::testsTriangles() const
{
    return impl_->triangles.pieceCount != 0;
}

std::vector<DrawRange> Geometry::draws(bool culledTriangles) const
{
    std::vector<DrawRange> draws;
    for (const Run& run : impl_->runs)
        draws.push_back(impl_->drawsOf(run, culledTriangles));
    return draws;
}

void Geometry::releaseStaging() noexcept
{
    impl_->staging = {};
    impl_->copies = {};
    impl_->textureCopies = {};
}

namespace
{

void transition(const Geometry::Impl& g, VkCommandBuffer cmd, const gpu::Image& image,
                bool toShaders)
{
    const VkImageMemoryBarrier2 barrier{
        .sType = VK_STRUCTURE_TYPE_IMAGE_MEMORY_BARRIER_2,
        .srcStageMask = toShaders ? VK_PIPELINE_STAGE_2_COPY_BIT : VK_PIPELINE_STAGE_2_NONE,
        .srcAccessMask = toShaders ? VK_ACCESS_2_TRANSFER_WRITE_BIT : VK_ACCESS_2_NONE,
        .dstStageMask =
            toShaders ? VK_PIPELINE_STAGE_2_FRAGMENT_SHADER_BIT : VK_PIPELINE_STAGE_2_COPY_BIT,
        .dstAccessMask =
            toShaders ? VK_ACCESS_2_SHADER_SAMPLED_READ_BIT : VK_ACCESS_2_TRANSFER_WRITE_BIT,
        .oldLayout = toShaders ? VK_IMAGE_LAYOUT_TRANSFER_DST_OPTIMAL : VK_IMAGE_LAYOUT_UNDEFINED,
        .newLayout = toShaders ? VK_IMAGE_LAYOUT_SHADER_READ_ONLY_OPTIMAL
                               : VK_IMAGE_LAYOUT_TRANSFER_DST_OPTIMAL,
        .srcQueueFamilyIndex = VK_QUEUE_FAMILY_IGNORED,
        .dstQueueFamilyIndex = VK_QUEUE_FAMILY_IGNORED,
        .image = image.image.get(),
        .subresourceRange = {VK_IMAGE_ASPECT_COLOR_BIT, 0, image.mipLevels, 0, 1}};
    const VkDependencyInfo info{.sType = VK_STRUCTURE_TYPE_DEPENDENCY_INFO,
                                .imageMemoryBarrierCount = 1,
                                .pImageMemoryBarriers = &barrier};
    g.device->CmdPipelineBarrier2(cmd, &info);
}

void copyTexture(const Geometry::Impl& g, VkCommandBuffer cmd, const Geometry::Impl::TextureCopy& c)
{
    const gpu::Image& image = g.textures[c.texture];
    std::array<VkBufferImageCopy, maxMipLevels> regions;
    VkDeviceSize offset = c.offset;
    for (uint32_t level = 0; level < image.mipLevels; ++level) {
        const uint32_t width = std::max(image.width >> level, 1u);
        const uint32_t height = std::max(image.height >> level, 1u);
        regions[level] = {.bufferOffset = offset,
                          .imageSubresource = {VK_IMAGE_ASPECT_COLOR_BIT, level, 0, 1},
                          .imageExtent = {width, height, 1}};
        offset += VkDeviceSize(width) * height * 4;
    }
    transition(g, cmd, image, false);
    g.device->CmdCopyBufferToImage(cmd, g.staging.get(), image.image.get(),
                                   VK_IMAGE_LAYOUT_TRANSFER_DST_OPTIMAL, image.mipLevels,
                                   regions.data());
    transition(g, cmd, image, true);
}

} // namespace

void Geometry::recordUpload(VkCommandBuffer cmd) noexcept
{
    const Impl& g = *impl_;
    const gpu::Device& d = *g.device;
    d.beginLabel(cmd, "geometry upload");
    for (const Impl::Copy& copy : g.copies)
        d.CmdCopyBuffer(cmd, g.staging.get(), copy.target, 1, &copy.region);
    for (const Impl::TextureCopy& copy : g.textureCopies)
        copyTexture(g, cmd, copy);
    const VkMemoryBarrier2 barrier{.sType = VK_STRUCTURE_TYPE_MEMORY_BARRIER_2,
                                   .srcStageMask = VK_PIPELINE_STAGE_2_COPY_BIT,
                                   .srcAccessMask = VK_ACCESS_2_TRANSFER_WRITE_BIT,
                                   .dstStageMask = VK_PIPELINE_STAGE_2_ALL_GRAPHICS_BIT |
                                                   VK_PIPELINE_STAGE_2_COMPUTE_SHADER_BIT,
                                   .dstAccessMask =
                                       VK_ACCESS_2_MEMORY_READ_BIT | VK_ACCESS_2_SHADER_WRITE_BIT};
    const VkDependencyInfo info{.sType = VK_STRUCTURE_TYPE_DEPENDENCY_INFO,
                                .memoryBarrierCount = 1,
                                .pMemoryBarriers = &barrier};
    d.CmdPipelineBarrier2(cmd, &info);
    d.endLabel(cmd);
}

} // namespace candelabra::gbuffer
