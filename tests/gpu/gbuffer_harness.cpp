// SPDX-License-Identifier: Apache-2.0
#include "gpu/gbuffer_harness.h"

#include <algorithm>
#include <cmath>
#include <numbers>

#include <glm/gtc/type_ptr.hpp>

namespace candelabra::test
{
namespace
{

gbuffer::Vertex makeVertex(glm::dvec3 position, glm::dvec3 normal, glm::dvec3 tangent,
                           glm::dvec2 uv)
{
    gbuffer::Vertex v{};
    for (int i = 0; i < 3; ++i) {
        v.position[i] = float(position[i]);
        v.normal[i] = float(normal[i]);
        v.tangent[i] = float(tangent[i]);
    }
    v.tangent[3] = 1;
    for (int i = 0; i < 2; ++i)
        v.uv0[i] = v.uv1[i] = float(uv[i]);
    std::fill_n(v.color, 4, 1.0f);
    return v;
}

// Adds two triangles over the corners of a face.
void addFace(RasterScene::MeshData& mesh, const glm::dvec3& normal, const glm::dvec3& right,
             const glm::dvec3& center)
{
    const glm::dvec3 up = glm::cross(normal, right);
    const uint32_t first = uint32_t(mesh.vertices.size());
    for (const glm::dvec2 c : {glm::dvec2(-1, -1), {1, -1}, {1, 1}, {-1, 1}})
        mesh.vertices.push_back(makeVertex(center + c.x * right + c.y * up, normal, right,
                                           {c.x * 0.5 + 0.5, 0.5 - c.y * 0.5}));
    for (const uint32_t i : {0, 1, 2, 0, 2, 3})
        mesh.indices.push_back(first + i);
}

template <typename T>
std::vector<T> as(const std::vector<std::byte>& bytes)
{
    std::vector<T> result(bytes.size() / sizeof(T));
    std::memcpy(static_cast<void*>(result.data()), bytes.data(), bytes.size());
    return result;
}

} // namespace

uint32_t RasterScene::addMesh(MeshData data)
{
    meshData.push_back(std::move(data));
    meshes.push_back({meshData.back().vertices, meshData.back().indices});
    return uint32_t(meshes.size() - 1);
}

uint32_t RasterScene::addMaterial(const gbuffer::Material& material)
{
    materials.push_back(material);
    return uint32_t(materials.size() - 1);
}

uint32_t RasterScene::addTexture(gbuffer::Texture texture, std::vector<uint8_t> rgba)
{
    texels.push_back(std::move(rgba));
    texture.rgba = texels.back();
    textures.push_back(texture);
    return uint32_t(textures.size() - 1);
}

void RasterScene::addInstance(uint32_t mesh, uint32_t material, const glm::dmat4& worldFromObject)
{
    gbuffer::Instance instance{.mesh = mesh, .material = material};
    std::copy_n(glm::value_ptr(worldFromObject), 16, instance.worldFromObject);
    instances.push_back(instance);
}

gbuffer::GeometryDesc RasterScene::desc() const
{
    return {.meshes = meshes,
            .materials = materials,
            .textures = textures,
            .instances = instances,
            .analyticObjects = analyticObjects};
}

RasterScene::MeshData quadMesh()
{
    RasterScene::MeshData mesh;
    addFace(mesh, {0, 0, 1}, {1, 0, 0}, {0, 0, 0});
    return mesh;
}

RasterScene::MeshData cubeMesh()
{
    RasterScene::MeshData mesh;
    for (int axis = 0; axis < 3; ++axis)
        for (const double sign : {-1.0, 1.0}) {
            glm::dvec3 normal(0), right(0);
            normal[axis] = sign;
            right[(axis + 1) % 3] = 1;
            addFace(mesh, normal, right, normal);
        }
    return mesh;
}

RasterScene::MeshData sphereMesh(uint32_t rings)
{
    RasterScene::MeshData mesh;
    const uint32_t columns = 2 * rings;
    for (uint32_t j = 0; j <= rings; ++j)
        for (uint32_t i = 0; i <= columns; ++i) {
            const double theta = std::numbers::pi * j / rings;
            const double phi = 2 * std::numbers::pi * i / columns;
            const glm::dvec3 n(std::sin(theta) * std::cos(phi), std::cos(theta),
                               -std::sin(theta) * std::sin(phi));
            mesh.vertices.push_back(makeVertex(n, n, {-std::sin(phi), 0, -std::cos(phi)},
                                               {double(i) / columns, double(j) / rings}));
        }
    const auto at = [&](uint32_t j, uint32_t i) { return j * (columns + 1) + i; };
    for (uint32_t j = 0; j < rings; ++j)
        for (uint32_t i = 0; i < columns; ++i) {
            if (j + 1 < rings)
                mesh.indices.insert(mesh.indices.end(), {at(j, i), at(j + 1, i), at(j + 1, i + 1)});
            if (j > 0)
                mesh.indices.insert(mesh.indices.end(), {at(j, i), at(j + 1, i + 1), at(j, i + 1)});
        }
    return mesh;
}

void lookAt(CndCamera& camera, const glm::dvec3& position, const glm::dvec3& target)
{
    const glm::dvec3 forward = glm::normalize(target - position);
    const glm::dvec3 up = std::abs(forward.y) > 0.99 ? glm::dvec3(0, 0, 1) : glm::dvec3(0, 1, 0);
    const glm::dvec3 right = glm::normalize(glm::cross(forward, up));
    const glm::dmat3 worldFromView(right, glm::cross(right, forward), -forward);
    glm::dmat4 m(glm::transpose(worldFromView));
    m[3] = glm::dvec4(-(glm::transpose(worldFromView) * position), 1);
    std::copy_n(glm::value_ptr(m), 16, camera.viewFromWorld);
}

glm::dmat4 viewFromWorld(const CndCamera& camera)
{
    return glm::make_mat4(camera.viewFromWorld);
}

size_t RasterImage::coveredCount() const
{
    return size_t(
        std::count_if(depth.begin(), depth.end(), [this](float d) { return d != clearDepth; }));
}

gbuffer::Geometry RasterTest::uploadGeometry(const RasterScene& scene)
{
    gbuffer::Geometry geometry(device(), scene.desc());
    context().submitAndWait([&](VkCommandBuffer cmd) { geometry.recordUpload(cmd); });
    geometry.releaseStaging();
    return geometry;
}

RasterImage RasterTest::render(const RasterScene& scene, const RasterOptions& options)
{
    return render(uploadGeometry(scene), options);
}

RasterImage RasterTest::render(const gbuffer::Geometry& geometry, const RasterOptions& options)
{
    gbuffer::GBuffer pass(device(), {.framesInFlight = 1, .layout = options.layout});
    return renderWith(pass, geometry, options);
}

RasterImage RasterTest::renderWith(gbuffer::GBuffer& pass, const gbuffer::Geometry& geometry,
                                   const RasterOptions& options, uint32_t slot)
{
    const gbuffer::Targets targets =
        gbuffer::createTargets(device(), options.layout, options.width, options.height);
    pass.prepare(geometry);
    pass.setEmitters(options.emitters, glm::value_ptr(options.emitterOrigin));
    const glm::vec3& b = options.background;
    context().submitAndWait([&](VkCommandBuffer cmd) {
        pass.record(cmd, geometry,
                    {.slot = slot,
                     .camera = options.camera,
                     .clearDepth = options.clearDepth,
                     .background = {b.x, b.y, b.z},
                     .attachments = targets.attachments(),
                     .width = options.width,
                     .height = options.height,
                     .cullInstances = options.cullInstances,
                     .cullTriangles = options.cullTriangles,
                     .maxLevelError = options.maxLevelError,
                     .coverageFrame = options.coverageFrame});
    });
    RasterImage image;
    image.width = options.width;
    image.height = options.height;
    image.camera = options.camera;
    image.clearDepth = options.clearDepth;
    const auto read = [&](const gpu::Image& source, uint32_t bytes) {
        const bool isDepth = &source == &targets.depth;
        return readImage(source, isDepth ? VK_IMAGE_ASPECT_DEPTH_BIT : VK_IMAGE_ASPECT_COLOR_BIT,
                         &source == &targets.radiance ? VK_IMAGE_LAYOUT_GENERAL
                                                      : VK_IMAGE_LAYOUT_SHADER_READ_ONLY_OPTIMAL,
                         bytes);
    };
    image.depth = as<float>(read(targets.depth, 4));
    image.radiance = as<glm::vec4>(read(targets.radiance, 16));
    if (options.layout == CND_GBUFFER_COMPACT) {
        for (const uint32_t word : as<uint32_t>(read(targets.normalRoughness, 4)))
            image.normalRoughness.emplace_back(word, 0);
        image.compactAlbedo = as<glm::u8vec4>(read(targets.albedo, 4));
    } else {
        image.normalRoughness = as<glm::uvec2>(read(targets.normalRoughness, 8));
        image.albedo = as<glm::uvec2>(read(targets.albedo, 8));
        image.specular = as<glm::uvec2>(read(targets.specular, 8));
    }
    return image;
}

RasterOptions perspectiveOptions()
{
    RasterOptions options;
    setPerspective(options.camera, 1.0, double(options.width) / options.height, 0.1);
    return options;
}

gbuffer::Material testMaterial()
{
    gbuffer::Material m{.metalness = 0.25f, .perceptualRoughness = 0.37f};
    const float base[3] = {0.8f, 0.5f, 0.2f}, emission[3] = {3, 70000, 0.001f};
    std::copy_n(base, 3, m.baseColor);
    std::copy_n(emission, 3, m.emission);
    return m;
}

double Random::uniform(double low, double high)
{
    return low + (high - low) * double(engine_()) / 4294967296.0;
}

glm::dvec3 Random::box(double size)
{
    const double x = uniform(-size, size), y = uniform(-size, size);
    return {x, y, uniform(-size, size)};
}

glm::dvec3 Random::direction()
{
    const double z = uniform(-1, 1), phi = uniform(0, 2 * std::numbers::pi);
    const double r = std::sqrt(1 - z * z);
    return {r * std::cos(phi), r * std::sin(phi), z};
}

double angleBetween(const glm::dvec3& a, const glm::dvec3& b)
{
    return std::atan2(glm::length(glm::cross(a, b)), glm::dot(a, b));
}

void expectSameImage(const RasterImage& a, const RasterImage& b)
{
    EXPECT_EQ(a.depth, b.depth);
    EXPECT_EQ(a.normalRoughness, b.normalRoughness);
    EXPECT_EQ(a.albedo, b.albedo);
    EXPECT_EQ(a.specular, b.specular);
    EXPECT_EQ(a.radiance, b.radiance);
    EXPECT_EQ(a.compactAlbedo, b.compactAlbedo);
}

} // namespace candelabra::test
