// SPDX-License-Identifier: Apache-2.0
// Geometry: a static scene on the GPU, built once from plain descriptions.
//
// Conventions: metres; colours are linear Rec.709; matrices are column-major; the front of a
// triangle is the side from which its vertices are counter-clockwise. Descriptions are read before
// the constructor returns.
#pragma once

#include <cstdint>
#include <memory>
#include <span>
#include <vector>

#include "gpu/device.h"
#include "gpu/memory.h"

namespace candelabra::gbuffer
{

struct Vertex {
    float position[3];
    float normal[3];
    float tangent[4]; // w is the handedness of the bitangent, +1 or -1
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
    uint32_t width = 0, height = 0; // texels, 1 up to the device's limit
    std::span<const uint8_t> rgba;  // width * height * 4 bytes, rows from the top
    bool srgb = false;              // RGB is sRGB-encoded; alpha is always linear
    Wrap wrapU = Wrap::Repeat, wrapV = Wrap::Repeat;
    bool nearest = false; // no interpolation and no mip levels; otherwise trilinear filtering
};

struct TextureRef {
    int32_t texture = -1; // -1: no texture, which reads as 1 (normal maps: unperturbed)
    uint32_t uvSet = 0;   // 0 or 1
    float uRow[3]{1, 0, 0}, vRow[3]{0, 1, 0}; // u' = dot(uRow, (u, v, 1)), v' = dot(vRow, (u, v,
                                              // 1))
};

// The fragments of a surface that are drawn; the values are those of COVERAGE_* (shared/raster.h).
enum class Coverage : uint32_t {
    Full,
    // Fragments with a coverage of at least alphaCutoff. Without mip levels the edge is only as
    // fine as the texture's resolution.
    Masked,
    // A share of the fragments as large as their coverage, chosen by pixel, instance and
    // FrameInputs::coverageFrame.
    Dithered
};

// A metallic-roughness material (glTF 2.0). Layout COMPACT cannot store dielectricF0, diffuseWeight
// and specularWeight and uses 0.04, 1 and 1 instead.
struct Material {
    float baseColor[3]{1, 1, 1}; // 0..1
    float alpha = 1;             // coverage; not used with Coverage::Full
    float metalness = 0;
    float perceptualRoughness = 1;
    float dielectricF0[3]{0.04f, 0.04f, 0.04f};
    float diffuseWeight = 1;
    float specularWeight = 1;   // Schlick's F90; 0 with dielectricF0 = 0: no specular lobe
    float emission[3]{0, 0, 0}; // cd/m^2
    float normalScale = 1;
    Coverage coverage = Coverage::Full;
    float alphaCutoff = 0.5f;
    bool doubleSided = false; // back faces are drawn too, with the normal reversed
    // Emits `emission`, multiplied by baseColorTexture and vertex colours, and reflects nothing.
    bool unlit = false;
    TextureRef baseColorTexture;         // rgb: base colour, a: coverage
    TextureRef metallicRoughnessTexture; // g: roughness, b: metalness
    TextureRef normalTexture;            // tangent space, xyz * 2 - 1 is the normal
    TextureRef emissiveTexture;

    bool isEmissive() const
    {
        return unlit || emission[0] != 0 || emission[1] != 0 || emission[2] != 0;
    }
};

struct Instance {
    uint32_t mesh = 0;
    uint32_t material = 0;
    double worldFromObject[16]; // affine; may mirror and scale non-uniformly
};

// An exact plane or ball, ray-cast per pixel without tessellation. Only the plane's upper side and
// the ball's outside are visible.
struct AnalyticObject {
    enum class Type { Plane, Ball } type = Type::Plane;
    double point[3]{0, 0, 0};  // plane: a point on it; ball: centre
    double normal[3]{0, 1, 0}; // plane: unit normal
    double radius = 1;         // ball: radius in metres
    uint32_t material = 0;     // its factors are used, its textures are ignored
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
    uint64_t triangles = 0; // summed over all instances
    uint64_t bytes = 0;     // GPU memory
};

// Consecutive commands of indirect draws in a buffer.
struct DrawRange {
    VkBuffer commands;
    uint32_t first, count;
};

class Geometry
{
public:
    // Validates the description, optimises the meshes, filters the textures and fills the staging
    // memory. Throws gpu::Failure when the description is out of range, memory runs out or a device
    // limit is exceeded.
    Geometry(const gpu::Device& device, const GeometryDesc& desc);
    ~Geometry();
    Geometry(Geometry&&) noexcept;
    Geometry& operator=(Geometry&&) noexcept;

    // Records the copies from staging memory. Must be recorded once, before the first frame,
    // outside a render pass.
    void recordUpload(VkCommandBuffer cmd) noexcept;
    // Frees the staging memory. The GPU must have finished the upload.
    void releaseStaging() noexcept;

    GeometryCounts counts() const;
    // The draws of the last recorded frame, a VkDrawIndexedIndirectCommand each, in order.
    // `culledTriangles`: its FrameInputs::cullTriangles. Hosts that want to know what was drawn may
    // copy them after the frame.
    std::vector<DrawRange> draws(bool culledTriangles) const;
    bool testsTriangles() const; // whether there is anything for cull_triangles to do

    struct Impl;
    const Impl& impl() const { return *impl_; } // used by GBuffer

private:
    std::unique_ptr<Impl> impl_;
};

} // namespace candelabra::gbuffer
