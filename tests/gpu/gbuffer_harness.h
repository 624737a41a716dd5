// SPDX-License-Identifier: Apache-2.0
// A host of the raster pass: builds scenes by hand, renders one frame and reads the images back.
#pragma once

#include <deque>
#include <random>
#include <vector>

#include "gbuffer/gbuffer.h"
#include "gpu/lighting_harness.h"

namespace candelabra::test
{

// Scene descriptions, and the memory that they refer to.
struct RasterScene {
    struct MeshData {
        std::vector<gbuffer::Vertex> vertices;
        std::vector<uint32_t> indices;
    };
    std::deque<MeshData> meshData; // a deque, because elements must stay in place
    std::deque<std::vector<uint8_t>> texels;
    std::vector<gbuffer::Mesh> meshes;
    std::vector<gbuffer::Material> materials;
    std::vector<gbuffer::Texture> textures;
    std::vector<gbuffer::Instance> instances;
    std::vector<gbuffer::AnalyticObject> analyticObjects;

    uint32_t addMesh(MeshData data);
    uint32_t addMaterial(const gbuffer::Material& material);
    uint32_t addTexture(gbuffer::Texture texture, std::vector<uint8_t> rgba);
    void addInstance(uint32_t mesh, uint32_t material, const glm::dmat4& worldFromObject);
    gbuffer::GeometryDesc desc() const;
};

// A quad in z = 0 with x and y in -1..1, facing +z; uv (0, 0) is at the top left corner.
RasterScene::MeshData quadMesh();
// A cube with faces at +-1.
RasterScene::MeshData cubeMesh();
// A sphere of radius 1 with 4 * rings * (rings - 1) triangles.
RasterScene::MeshData sphereMesh(uint32_t rings);

// Points the camera at `target` (view space: x right, y up, looking along -z).
void lookAt(CndCamera& camera, const glm::dvec3& position, const glm::dvec3& target);
glm::dmat4 viewFromWorld(const CndCamera& camera);

struct RasterOptions {
    CndGBufferLayout layout = CND_GBUFFER_FULL;
    CndCamera camera{};
    uint32_t width = 160, height = 120;
    float clearDepth = 0;
    glm::vec3 background{0};
    bool cullInstances = true;
    bool cullTriangles = true;
    float maxLevelError = 0; // most tests draw meshes as they describe them
    uint32_t coverageFrame = 0;
    std::vector<CndLight> emitters;
    glm::dvec3 emitterOrigin{0};
};

struct RasterImage : CpuGBuffer {
    std::vector<glm::vec4> radiance;
    std::vector<glm::u8vec4> compactAlbedo; // COMPACT: used instead of albedo and specular

    bool covered(size_t pixel) const { return depth[pixel] != clearDepth; }
    size_t coveredCount() const;
};

class RasterTest : public GpuTest
{
protected:
    gbuffer::Geometry uploadGeometry(const RasterScene& scene);
    RasterImage render(const gbuffer::Geometry& geometry, const RasterOptions& options);
    RasterImage render(const RasterScene& scene, const RasterOptions& options);
    // Renders `options` in slot `slot` of an existing pass.
    RasterImage renderWith(gbuffer::GBuffer& pass, const gbuffer::Geometry& geometry,
                           const RasterOptions& options, uint32_t slot = 0);
    // Calls visit(command) for each command of the ranges, which must be of type Command.
    template <typename Command, typename Visit>
    void forEachDraw(const std::vector<gbuffer::DrawRange>& ranges, const Visit& visit)
    {
        for (const gbuffer::DrawRange& range : ranges) {
            const VkDeviceSize size = range.count * sizeof(Command);
            if (!size)
                continue;
            const gpu::Buffer copy = readback("draw commands", size);
            context().submitAndWait([&](VkCommandBuffer cmd) {
                fullBarrier(cmd);
                const VkBufferCopy region{range.first * sizeof(Command), 0, size};
                vkCmdCopyBuffer(cmd, range.commands, copy.get(), 1, &region);
                fullBarrier(cmd);
            });
            for (const Command& command : copy.as<Command>().first(range.count))
                visit(command);
        }
    }
};

// 160x120 pixels, 1 radian high, near plane 0.1 m, reversed and infinite depth; at the origin,
// looking along -z.
RasterOptions perspectiveOptions();
// A material in which all fields that a test reads back differ.
gbuffer::Material testMaterial();

class Random
{
public:
    explicit Random(uint32_t seed) : engine_(seed) {}
    double uniform(double low, double high);
    glm::dvec3 box(double size); // every coordinate within +-size
    glm::dvec3 direction();

private:
    std::mt19937 engine_;
};

// Returns the angle between two directions in radians; accurate for small angles.
double angleBetween(const glm::dvec3& a, const glm::dvec3& b);
// Expects that all images are equal, bit for bit.
void expectSameImage(const RasterImage& a, const RasterImage& b);

} // namespace candelabra::test
