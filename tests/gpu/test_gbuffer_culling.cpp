// SPDX-License-Identifier: Apache-2.0
// Tests culling and batching of instances on the GPU, through images and the draw commands that
// result.
#include <algorithm>

#include <glm/gtc/matrix_transform.hpp>
#include <glm/gtc/type_ptr.hpp>

#include "gbuffer/camera_terms.h"
#include "gbuffer/geometry_impl.h"
#include "gpu/gbuffer_harness.h"

namespace candelabra::test
{

class GBufferCulling : public RasterTest
{
protected:
    static constexpr uint32_t instanceCount = 3000;

    // Boxes, spheres and quads of very different sizes, some mirrored. One batch is much longer
    // than a chunk.
    static RasterScene crowd()
    {
        Random random(5);
        RasterScene scene;
        const uint32_t meshes[] = {scene.addMesh(cubeMesh()), scene.addMesh(sphereMesh(6)),
                                   scene.addMesh(quadMesh())};
        gbuffer::Material twoSided = testMaterial();
        twoSided.doubleSided = true;
        const uint32_t materials[] = {scene.addMaterial(testMaterial()),
                                      scene.addMaterial(twoSided)};
        for (uint32_t i = 0; i < instanceCount; ++i) {
            glm::dmat4 m = glm::translate(glm::dmat4(1), random.box(60));
            m = glm::rotate(m, random.uniform(0, 6), random.direction());
            glm::dvec3 scale(random.uniform(0.05, 1), random.uniform(0.05, 1),
                             random.uniform(0.05, 3));
            if (i % 7 == 0)
                scale.x *= -1;
            scene.addInstance(meshes[i % 5 == 0 ? 2 : i % 3 == 0], materials[i % 11 == 0],
                              glm::scale(m, scale));
        }
        return scene;
    }

    static RasterOptions randomView(Random& random, int index)
    {
        RasterOptions options = perspectiveOptions();
        const double aspect = double(options.width) / options.height;
        options.clearDepth = index % 4 == 1 ? 1.f : 0.f;
        const bool reversed = options.clearDepth == 0;
        if (index % 4 == 3)
            setOrthographic(options.camera, random.uniform(5, 60), aspect, 0.1, 80, reversed);
        else
            setPerspective(options.camera, random.uniform(0.05, 2.2), aspect, 0.1,
                           index % 2 ? 50 : 0, reversed);
        lookAt(options.camera, random.box(50), random.box(50));
        return options;
    }

    uint32_t drawnInstances(const gbuffer::Geometry& geometry)
    {
        const gpu::Buffer& commands = geometry.impl().commands;
        const gpu::Buffer copy = readback("draw commands", commands.size);
        context().submitAndWait([&](VkCommandBuffer cmd) {
            fullBarrier(cmd);
            const VkBufferCopy region{0, 0, commands.size};
            vkCmdCopyBuffer(cmd, commands.get(), copy.get(), 1, &region);
            fullBarrier(cmd);
        });
        uint32_t sum = 0;
        for (const gpu::DrawCommand& c : copy.as<gpu::DrawCommand>())
            sum += c.instanceCount;
        return sum;
    }

    // Counts, in double precision, the instances whose bounds reach into the view by at least
    // `margin` (a share of their size and distance).
    static uint32_t boundsInView(const RasterScene& scene, const RasterOptions& options,
                                 double margin)
    {
        const gbuffer::CameraTerms camera(options.camera, options.clearDepth);
        uint32_t count = 0;
        for (const gbuffer::Instance& instance : scene.instances) {
            const glm::dmat4 m = glm::make_mat4(instance.worldFromObject);
            // All three meshes fill -1..1; the quad has no depth.
            glm::dvec3 extent = glm::abs(glm::dvec3(m[0])) + glm::abs(glm::dvec3(m[1]));
            if (instance.mesh != 2)
                extent += glm::abs(glm::dvec3(m[2]));
            const glm::dvec3 center = glm::dvec3(m[3]) - camera.position;
            bool inside = true;
            for (const glm::dvec4& plane : camera.planes)
                inside = inside && glm::dot(glm::dvec3(plane), center) + plane.w +
                                           glm::dot(glm::abs(glm::dvec3(plane)), extent) >=
                                       margin * (glm::length(center) + glm::length(extent));
            count += inside;
        }
        return count;
    }
};

// Culling must not change the image, and must not draw what is outside the view.
TEST_F(GBufferCulling, ChangesNothingButTheWork)
{
    Random random(6);
    const RasterScene scene = crowd();
    const gbuffer::Geometry geometry = uploadGeometry(scene);
    ASSERT_EQ(geometry.counts().instances, instanceCount);
    gbuffer::GBuffer pass(device(), {.framesInFlight = 1});
    uint32_t fewest = instanceCount, most = 0;
    for (int view = 0; view < 16; ++view) {
        SCOPED_TRACE(view);
        RasterOptions options = randomView(random, view);
        const RasterImage culled = renderWith(pass, geometry, options);
        const uint32_t drawn = drawnInstances(geometry);
        options.cullInstances = false;
        const RasterImage all = renderWith(pass, geometry, options);
        EXPECT_EQ(drawnInstances(geometry), instanceCount);
        expectSameImage(culled, all);
        EXPECT_GE(drawn, boundsInView(scene, options, 0));
        // The slack of the kernel's test is 1e-5 of the sum of the coordinates.
        EXPECT_LE(drawn, boundsInView(scene, options, -4e-5));
        fewest = std::min(fewest, drawn);
        most = std::max(most, drawn);
    }
    EXPECT_LT(fewest, instanceCount / 10);
    EXPECT_GT(most, instanceCount / 4);
}

// Coplanar quads compete for every pixel; the same one must win in each run.
TEST_F(GBufferCulling, TwoRunsAreBitIdentical)
{
    RasterScene scene;
    const uint32_t mesh = scene.addMesh(quadMesh());
    for (int i = 0; i < 200; ++i) {
        gbuffer::Material m = testMaterial();
        m.baseColor[0] = float(i) / 200;
        scene.addInstance(mesh, scene.addMaterial(m),
                          glm::translate(glm::dmat4(1), glm::dvec3(0.002 * i, 0, -2)));
    }
    const RasterOptions options = perspectiveOptions();
    const gbuffer::Geometry geometry = uploadGeometry(scene);
    EXPECT_EQ(geometry.counts().draws, 1u);
    const RasterImage first = render(geometry, options);
    // With equal depth the quad drawn first stays.
    EXPECT_EQ(storedAlbedo(first, 60 * 160 + 80).r, 0);
    expectSameImage(first, render(geometry, options));
    expectSameImage(first, render(scene, options));
}

// 40000 instances of one mesh are split into three draws within one run.
TEST_F(GBufferCulling, LongBatchesAreSplit)
{
    // The transforms of instances are read from a texel buffer.
    constexpr uint32_t instances = 40000;
    if (device().limits.maxTexelBufferElements < instances * gpu::INSTANCE_TEXELS)
        GTEST_SKIP() << "texel buffers of this device hold "
                     << device().limits.maxTexelBufferElements << " texels, too few for "
                     << instances << " instances";
    RasterScene scene;
    const uint32_t mesh = scene.addMesh(quadMesh());
    const uint32_t material = scene.addMaterial(testMaterial());
    for (int i = 0; i < int(instances); ++i) {
        const glm::dvec3 at((i % 200 - 99.5) * 0.01, (i / 200 - 99.5) * 0.01, -2);
        scene.addInstance(mesh, material,
                          glm::scale(glm::translate(glm::dmat4(1), at), glm::dvec3(0.005)));
    }
    const gbuffer::Geometry geometry = uploadGeometry(scene);
    EXPECT_EQ(geometry.counts().draws, 3u);
    RasterOptions options = perspectiveOptions();
    const RasterImage tiles = render(geometry, options);
    EXPECT_EQ(drawnInstances(geometry), instances);
    // Together they form a quad of half size 1; adjacent edges round to the same subpixel.
    RasterScene one;
    one.addInstance(one.addMesh(quadMesh()), one.addMaterial(testMaterial()),
                    glm::translate(glm::dmat4(1), glm::dvec3(0, 0, -2)));
    EXPECT_NEAR(double(tiles.coveredCount()), double(render(one, options).coveredCount()),
                0.01 * double(tiles.coveredCount()));
}

TEST_F(GBufferCulling, BadDescriptionsAreRefusedInOneSentence)
{
    const auto refused = [&](const RasterScene& scene) -> std::string {
        try {
            gbuffer::Geometry geometry(device(), scene.desc());
        } catch (const gpu::Failure& failure) {
            return failure.message;
        }
        return "accepted";
    };
    RasterScene scene;
    RasterScene::MeshData mesh = quadMesh();
    mesh.indices[4] = 4;
    scene.addMesh(mesh);
    EXPECT_EQ(refused(scene), "mesh 0: index 4 is not below the number of vertices, 4");

    scene = {};
    scene.addInstance(scene.addMesh(quadMesh()), 0, glm::dmat4(1));
    EXPECT_EQ(refused(scene), "instance 0: material 0 is not below the number of materials, 0");
    scene.addMaterial(testMaterial());
    EXPECT_EQ(refused(scene), "accepted");
    scene.materials[0].normalTexture.texture = 2;
    EXPECT_EQ(refused(scene), "material 0: texture 2 is not below the number of textures, 0");
    scene.materials[0].normalTexture.texture = -1;
    scene.addTexture({.width = 2, .height = 2}, std::vector<uint8_t>(15));
    EXPECT_EQ(refused(scene), "texture 0 has 15 bytes, not four per texel");
}

} // namespace candelabra::test
