// SPDX-License-Identifier: Apache-2.0
// Geometry: a static scene on the GPU, built once from plain descriptions.
//
// Conventions: metres; colours are linear Rec.709; matrices are column-major; triangles are
// counter-clockwise seen from their front. Descriptions are read before the constructor returns.
#pragma once

#include <array>
#include <cstdint>
#include <memory>
#include <span>

#include "gpu/device.h"

namespace candelabra::gbuffer
{

struct Vertex {
    float position[3];
    float normal[3];
    float tangent[4]; // w: handedness of the bitangent, +-1
    float uv0[2];
    float uv1[2];
    float color[4]; // multiplies base colour and coverage
};
static_assert(sizeof(Vertex) == 72);

struct Mesh {
    std::span<const Vertex> vertices;
    std::span<const uint32_t> indices; // three per triangle
};

enum class Wrap { Repeat, Mirror, Clamp };

struct Texture {
    uint32_t width = 0, height = 0; // texels, 1..the device's limit
    std::span<const uint8_t> rgba;  // width * height * 4 bytes, rows from the top
    bool srgb = false;              // RGB is sRGB-encoded; alpha never is
    Wrap wrapU = Wrap::Repeat, wrapV = Wrap::Repeat;
    bool nearest = false; // no interpolation and no mip levels; else trilinear
};

struct TextureRef {
    int32_t texture = -1;                     // -1: none, reads as 1 (normals: undisturbed)
    uint32_t uvSet = 0;                       // 0 or 1
    float uRow[3]{1, 0, 0}, vRow[3]{0, 1, 0}; // u' = dot(uRow, (u, v, 1)), v' the same
};

// Metallic-roughness (glTF 2.0). Layout COMPACT ignores dielectricF0 (0.04), diffuseWeight (1) and
// specularWeight (1).
struct Material {
    float baseColor[3]{1, 1, 1}; // 0..1
    float alpha = 1;             // coverage, used by masked materials
    float metalness = 0;
    float perceptualRoughness = 1;
    float dielectricF0[3]{0.04f, 0.04f, 0.04f};
    float diffuseWeight = 1;
    float specularWeight = 1;   // Schlick F90; 0 with dielectricF0 = 0: no specular lobe
    float emission[3]{0, 0, 0}; // cd/m^2
    float normalScale = 1;
    bool masked = false; // drop what has coverage below alphaCutoff; without mip levels no better
                         // than the texture's resolution
    float alphaCutoff = 0.5f;
    bool doubleSided = false;            // back faces are drawn, with the normal turned round
    TextureRef baseColorTexture;         // rgb, a: coverage
    TextureRef metallicRoughnessTexture; // g: roughness, b: metalness
    TextureRef normalTexture;            // tangent space, xyz * 2 - 1
    TextureRef emissiveTexture;
};

struct Instance {
    uint32_t mesh = 0;
    uint32_t material = 0;
    double worldFromObject[16]; // affine; mirroring and non-uniform scale are handled
};

// Exact plane or ball, ray-cast per pixel: no tessellation. Only the plane's upper side and the
// ball's outside are seen.
struct AnalyticObject {
    enum class Type { Plane, Ball } type = Type::Plane;
    double point[3]{0, 0, 0};  // plane: a point on it; ball: centre
    double normal[3]{0, 1, 0}; // plane: unit
    double radius = 1;         // ball, m
    uint32_t material = 0;     // factors only: textures are ignored
};

struct GeometryDesc {
    std::span<const Mesh> meshes;
    std::span<const Material> materials;
    std::span<const Texture> textures;
    std::span<const Instance> instances;
    std::span<const AnalyticObject> analyticObjects;
};

struct GeometryCounts {
    uint32_t meshes = 0, instances = 0, draws = 0, textureSets = 0;
    uint64_t triangles = 0; // of all instances
    uint64_t bytes = 0;     // of GPU memory
};

class Geometry
{
public:
    // Validates, optimises the meshes, filters the textures, and fills the staging memory.
    // Throws gpu::Failure: a description out of range, no memory, a limit of the device.
    Geometry(const gpu::Device& device, const GeometryDesc& desc);
    ~Geometry();
    Geometry(Geometry&&) noexcept;
    Geometry& operator=(Geometry&&) noexcept;

    // Records the copies; once, before the first frame, outside a render pass.
    void recordUpload(VkCommandBuffer cmd) noexcept;
    // Frees the staging memory; the GPU must have finished the upload.
    void releaseStaging() noexcept;

    GeometryCounts counts() const;

    struct Impl;
    const Impl& impl() const { return *impl_; } // for GBuffer

private:
    std::unique_ptr<Impl> impl_;
};

} // namespace candelabra::gbuffer
