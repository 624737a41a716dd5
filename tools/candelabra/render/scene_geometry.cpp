// SPDX-License-Identifier: Apache-2.0
#include "render/scene_upload.h"

#include <cstddef>
#include <cstring>
#include <vector>

namespace candelabra::app
{
namespace
{

// The two vertex structs have the same layout, so that the vertices of a mesh are copied in one
// piece.
static_assert(sizeof(Vertex) == sizeof(gbuffer::Vertex));
static_assert(offsetof(Vertex, position) == offsetof(gbuffer::Vertex, position));
static_assert(offsetof(Vertex, normal) == offsetof(gbuffer::Vertex, normal));
static_assert(offsetof(Vertex, tangent) == offsetof(gbuffer::Vertex, tangent));
static_assert(offsetof(Vertex, uv) == offsetof(gbuffer::Vertex, uv0));
static_assert(offsetof(Vertex, color) == offsetof(gbuffer::Vertex, color));

template <size_t N, typename V>
void copy(float (&out)[N], const V& in)
{
    static_assert(V::length() == N);
    for (size_t i = 0; i < N; ++i)
        out[i] = in[int(i)];
}

gbuffer::TextureRef convert(const TextureRef& in)
{
    gbuffer::TextureRef out{.texture = in.texture, .uvSet = in.uvSet};
    copy(out.uRow, in.uRow);
    copy(out.vRow, in.vRow);
    return out;
}

gbuffer::Material convert(const Material& in)
{
    gbuffer::Material out{
        .alpha = in.alpha,
        .metalness = in.metalness,
        .perceptualRoughness = in.perceptualRoughness,
        .diffuseWeight = in.diffuseWeight,
        .specularWeight = in.specularWeight,
        .normalScale = in.normalScale,
        .coverage = in.alphaMode == AlphaMode::Mask    ? gbuffer::Coverage::Masked
                    : in.alphaMode == AlphaMode::Blend ? gbuffer::Coverage::Dithered
                                                       : gbuffer::Coverage::Full,
        .alphaCutoff = in.alphaCutoff,
        .doubleSided = in.doubleSided,
        .unlit = in.unlit,
        .baseColorTexture = convert(in.baseColorTexture),
        .metallicRoughnessTexture = convert(in.metallicRoughnessTexture),
        .normalTexture = convert(in.normalTexture),
        .emissiveTexture = convert(in.emissiveTexture),
    };
    copy(out.baseColor, in.baseColor);
    copy(out.dielectricF0, in.dielectricF0);
    copy(out.emission, in.emission);
    return out;
}

gbuffer::Texture convert(const Texture& in)
{
    const auto wrap = [](bool repeat, bool mirror) {
        return mirror   ? gbuffer::Wrap::Mirror
               : repeat ? gbuffer::Wrap::Repeat
                        : gbuffer::Wrap::Clamp;
    };
    return {.width = in.width,
            .height = in.height,
            .rgba = in.rgba,
            .srgb = in.srgb,
            .wrapU = wrap(in.repeatU, in.mirrorU),
            .wrapV = wrap(in.repeatV, in.mirrorV),
            .nearest = in.nearest};
}

gbuffer::Instance convert(const Instance& in)
{
    gbuffer::Instance out{.mesh = in.mesh, .material = in.material};
    for (int i = 0; i < 16; ++i)
        out.worldFromObject[i] = in.worldFromObject[i / 4][i % 4];
    return out;
}

gbuffer::AnalyticObject convert(const AnalyticObject& in)
{
    gbuffer::AnalyticObject out{.type = in.type == AnalyticObject::Type::Ball
                                            ? gbuffer::AnalyticObject::Type::Ball
                                            : gbuffer::AnalyticObject::Type::Plane,
                                .radius = in.radius,
                                .material = in.material};
    for (int i = 0; i < 3; ++i) {
        out.point[i] = in.point[i];
        out.normal[i] = in.normal[i];
    }
    return out;
}

template <typename Out, typename In>
std::vector<Out> convertAll(const std::vector<In>& in)
{
    std::vector<Out> out;
    out.reserve(in.size());
    for (const In& x : in)
        out.push_back(convert(x));
    return out;
}

gbuffer::Geometry geometryOf(const gpu::Device& device, const Scene& scene,
                             const std::vector<Material>& sceneMaterials)
{
    std::vector<std::vector<gbuffer::Vertex>> vertices;
    std::vector<gbuffer::Mesh> meshes;
    for (const Mesh& mesh : scene.meshes) {
        vertices.emplace_back(mesh.vertices.size());
        if (!mesh.vertices.empty())
            std::memcpy(static_cast<void*>(vertices.back().data()), mesh.vertices.data(),
                        mesh.vertices.size() * sizeof(Vertex));
        meshes.push_back({vertices.back(), mesh.indices});
    }
    const auto materials = convertAll<gbuffer::Material>(sceneMaterials);
    const auto textures = convertAll<gbuffer::Texture>(scene.textures);
    const auto instances = convertAll<gbuffer::Instance>(scene.instances);
    const auto analytic = convertAll<gbuffer::AnalyticObject>(scene.analyticObjects);
    return gbuffer::Geometry(device, {.meshes = meshes,
                                      .materials = materials,
                                      .textures = textures,
                                      .instances = instances,
                                      .analyticObjects = analytic});
}

} // namespace

gbuffer::Geometry uploadGeometry(const VulkanContext& context, const Scene& scene,
                                 const std::vector<Material>& materials)
{
    gbuffer::Geometry geometry = geometryOf(context.device(), scene, materials);
    context.submitAndWait([&](VkCommandBuffer cmd) { geometry.recordUpload(cmd); });
    geometry.releaseStaging();
    return geometry;
}

} // namespace candelabra::app
