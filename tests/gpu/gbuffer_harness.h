// SPDX-License-Identifier: Apache-2.0
// A host of the raster pass: scenes made by hand, one frame, and the images read back.
#pragma once

#include <deque>
#include <random>
#include <vector>

#include "gbuffer/gbuffer.h"
#include "gpu/lighting_harness.h"

namespace candelabra::test
{

// Descriptions and the memory behind them.
struct RasterScene {
    struct MeshData {
        std::vector<gbuffer::Vertex> vertices;
        std::vector<uint32_t> indices;
    };
    std::deque<MeshData> meshData; // stays in place
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

// Unit quad in z = 0, x and y in -1..1, facing +z; uv (0, 0) is the top left corner.
RasterScene::MeshData quadMesh();
// Cube with faces at +-1.
RasterScene::MeshData cubeMesh();
// Sphere of radius 1 of 2 * rings^2 triangles or so.
RasterScene::MeshData sphereMesh(uint32_t rings);

// Turns the camera (view: x right, y up, looking down -z).
void lookAt(CndCamera& camera, const glm::dvec3& position, const glm::dvec3& target);
glm::dmat4 viewFromWorld(const CndCamera& camera);

struct RasterOptions {
    CndGBufferLayout layout = CND_GBUFFER_FULL;
    CndCamera camera{};
    uint32_t width = 160, height = 120;
    float clearDepth = 0;
    glm::vec3 background{0};
    bool cullInstances = true;
    std::vector<CndLight> emitters;
    glm::dvec3 emitterOrigin{0};
};

struct RasterImage : CpuGBuffer {
    std::vector<glm::vec4> radiance;
    std::vector<glm::u8vec4> compactAlbedo; // COMPACT: instead of albedo and specular

    bool covered(size_t pixel) const { return depth[pixel] != clearDepth; }
    size_t coveredCount() const;
};

class RasterTest : public GpuTest
{
protected:
    gbuffer::Geometry uploadGeometry(const RasterScene& scene);
    RasterImage render(const gbuffer::Geometry& geometry, const RasterOptions& options);
    RasterImage render(const RasterScene& scene, const RasterOptions& options);
    // Records `options` into slot 0 of an existing pass.
    RasterImage renderWith(gbuffer::GBuffer& pass, const gbuffer::Geometry& geometry,
                           const RasterOptions& options, uint32_t slot = 0);
};

// 160x120 pixels, 1 radian high, near plane 0.1 m, reversed and infinite; at the origin along -z.
RasterOptions perspectiveOptions();
// Every field that a test reads back is different.
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

// Angle between two directions, radians; accurate for small ones.
double angleBetween(const glm::dvec3& a, const glm::dvec3& b);
// The same bits in every image.
void expectSameImage(const RasterImage& a, const RasterImage& b);

} // namespace candelabra::test
