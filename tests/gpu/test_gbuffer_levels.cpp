// SPDX-License-Identifier: Apache-2.0
// Tests the choice of levels of detail on the GPU, through draw commands, instances and images.
#include <algorithm>

#include <glm/gtc/matrix_transform.hpp>
#include <glm/gtc/type_ptr.hpp>

#include "gbuffer/batches.h"
#include "gbuffer/camera_terms.h"
#include "gbuffer/geometry_impl.h"
#include "gbuffer/meshes.h"
#include "gpu/gbuffer_harness.h"

namespace candelabra::test
{

class GBufferLevels : public RasterTest
{
protected:
    // The result of culling: the draw commands, and the instances that they draw.
    struct Drawn {
        std::vector<gpu::DrawCommand> commands;
        std::vector<uint32_t> visible;
    };

    Drawn drawn(const gbuffer::Geometry& geometry)
    {
        const gpu::Buffer &commands = geometry.impl().commands, &visible = geometry.impl().visible;
        const gpu::Buffer copyOfCommands = readback("draw commands", commands.size);
        const gpu::Buffer copyOfVisible = readback("visible instances", visible.size);
        context().submitAndWait([&](VkCommandBuffer cmd) {
            fullBarrier(cmd);
            const VkBufferCopy all{0, 0, commands.size}, ids{0, 0, visible.size};
            vkCmdCopyBuffer(cmd, commands.get(), copyOfCommands.get(), 1, &all);
            vkCmdCopyBuffer(cmd, visible.get(), copyOfVisible.get(), 1, &ids);
            fullBarrier(cmd);
        });
        const auto c = copyOfCommands.as<gpu::DrawCommand>();
        const auto v = copyOfVisible.as<uint32_t>();
        return {{c.begin(), c.end()}, {v.begin(), v.end()}};
    }

    static uint64_t triangles(const Drawn& d)
    {
        uint64_t sum = 0;
        for (const gpu::DrawCommand& c : d.commands)
            sum += uint64_t(c.indexCount / 3) * c.instanceCount;
        return sum;
    }

    // Spheres of very different sizes, some of them sheared or mirrored, around the origin. There
    // are more than a chunk of them, and the box between them has no coarser levels.
    static RasterScene crowd()
    {
        Random random(15);
        RasterScene scene;
        const uint32_t meshes[] = {scene.addMesh(sphereMesh(12)), scene.addMesh(cubeMesh()),
                                   scene.addMesh(sphereMesh(24))};
        const uint32_t material = scene.addMaterial(testMaterial());
        for (int i = 0; i < 2000; ++i) {
            glm::dmat4 m = glm::translate(glm::dmat4(1), random.box(40));
            m = glm::rotate(m, random.uniform(0, 6), random.direction());
            m = glm::scale(m, glm::dvec3(random.uniform(0.02, 1.5), random.uniform(0.02, 1.5),
                                         random.uniform(0.02, 1.5) * (i % 7 ? 1 : -1)));
            if (i % 5 == 0)
                m[0] += 0.4 * m[1];
            scene.addInstance(meshes[i % 11 ? i % 2 * 2 : 1], material, m);
        }
        return scene;
    }

    static RasterOptions view(Random& random, int index)
    {
        RasterOptions options = perspectiveOptions();
        options.maxLevelError = gbuffer::defaultMaxLevelError;
        const double aspect = double(options.width) / options.height;
        if (index % 3 == 2)
            setOrthographic(options.camera, random.uniform(5, 60), aspect, 0.1, 80, true);
        else
            setPerspective(options.camera, random.uniform(0.3, 2), aspect, 0.1, 0, true);
        lookAt(options.camera, random.box(40), random.box(30));
        return options;
    }

    // A bound of the pixels that a vector of 1 m covers in the image anywhere in a box, found from
    // the projection itself: the worst of the box's corners and middle, in many directions.
    static double pixelsPerMetre(const RasterOptions& options, const gpu::InstanceBounds& bounds)
    {
        const glm::dmat4 clip =
            glm::dmat4(glm::make_mat4(options.camera.clipFromView)) * viewFromWorld(options.camera);
        const auto pixel = [&](const glm::dvec3& p) {
            const glm::dvec4 c = clip * glm::dvec4(p, 1);
            return glm::dvec2(c.x / c.w * 0.5 * options.width, c.y / c.w * 0.5 * options.height);
        };
        const glm::dvec3 center = glm::dvec3(bounds.centerHi) + glm::dvec3(bounds.centerLo);
        double worst = 0;
        Random random(3);
        for (int corner = 0; corner < 9; ++corner) {
            const glm::dvec3 at =
                center + (corner == 8 ? glm::dvec3(0)
                                      : glm::dvec3(bounds.extent) *
                                            glm::dvec3(corner & 1 ? 1 : -1, corner & 2 ? 1 : -1,
                                                       corner & 4 ? 1 : -1));
            if ((clip * glm::dvec4(at, 1)).w <= 0)
                return 1e300;
            for (int i = 0; i < 20; ++i) {
                constexpr double step = 1e-6;
                const glm::dvec3 along = step * random.direction();
                worst = std::max(worst, glm::length(pixel(at + along) - pixel(at)) / step);
            }
        }
        return worst;
    }
};

// Each visible instance is drawn once, in one level, and in the order of the description.
TEST_F(GBufferLevels, InstancesKeepTheirOrderInEveryLevel)
{
    Random random(16);
    const RasterScene scene = crowd();
    const gbuffer::Geometry geometry = uploadGeometry(scene);
    gbuffer::GBuffer pass(device(), {.framesInFlight = 1});
    std::vector<uint32_t> drawnAs(gpu::MESH_LEVELS);
    for (int i = 0; i < 6; ++i) {
        RasterOptions options = view(random, i);
        renderWith(pass, geometry, options);
        const Drawn levels = drawn(geometry);
        options.maxLevelError = 0;
        renderWith(pass, geometry, options);
        const Drawn full = drawn(geometry);
        std::vector<uint32_t> ids, fullIds;
        for (size_t c = 0; c < levels.commands.size(); ++c) {
            const auto range = [c](const Drawn& d) {
                const auto first = d.visible.begin() + d.commands[c].firstInstance;
                return std::vector<uint32_t>(first, first + d.commands[c].instanceCount);
            };
            const std::vector<uint32_t> one = range(levels), other = range(full);
            EXPECT_TRUE(std::is_sorted(one.begin(), one.end()));
            ids.insert(ids.end(), one.begin(), one.end());
            fullIds.insert(fullIds.end(), other.begin(), other.end());
        }
        std::sort(ids.begin(), ids.end());
        EXPECT_EQ(ids, fullIds); // in level 0 all are in order
        EXPECT_LT(triangles(levels), triangles(full));
    }
}

// The level is the coarsest whose error is within a quarter of a pixel, by a bound in double
// precision; and no error is longer than that in the image.
TEST_F(GBufferLevels, ErrorsAreWithinAQuarterOfAPixel)
{
    Random random(17);
    const RasterScene scene = crowd();
    const gbuffer::Geometry geometry = uploadGeometry(scene);
    gbuffer::GBuffer pass(device(), {.framesInFlight = 1});
    const gbuffer::PackedMeshes packed =
        gbuffer::packMeshes(scene.meshes, gbuffer::texturedMeshes(scene.desc()));
    const gbuffer::Batches batches =
        gbuffer::buildBatches(scene.desc(), packed.meshes, UINT32_MAX, 0);
    uint32_t coarse = 0, fine = 0;
    for (int i = 0; i < 9; ++i) {
        SCOPED_TRACE(i);
        const RasterOptions options = view(random, i);
        renderWith(pass, geometry, options);
        const Drawn d = drawn(geometry);
        const gbuffer::CameraTerms camera(options.camera, options.clearDepth);
        const glm::dvec3 forward = glm::transpose(camera.viewFromWorld) * camera.forward;
        for (const gpu::Chunk& chunk : batches.chunks) {
            for (uint32_t level = 0; level < chunk.levelCount; ++level) {
                const gpu::DrawCommand& c = d.commands[chunk.firstCommand + level];
                for (uint32_t k = 0; k < c.instanceCount; ++k) {
                    const uint32_t id = d.visible[c.firstInstance + k];
                    if (id < chunk.firstInstance || id >= chunk.firstInstance + chunk.count)
                        continue;
                    const gpu::InstanceBounds& bounds = batches.bounds[id];
                    const glm::dvec3 center =
                        glm::dvec3(bounds.centerHi) + glm::dvec3(bounds.centerLo) - camera.position;
                    const double depth = glm::dot(forward, center) -
                                         glm::dot(glm::abs(forward), glm::dvec3(bounds.extent));
                    const double distance =
                        glm::length(center) + glm::length(glm::dvec3(bounds.extent));
                    double scale = camera.pixelScale(options.width, options.height);
                    if (camera.perspective)
                        scale = depth > 0 ? scale * distance / (depth * depth) : 1e300;
                    const auto pixels = [&](uint32_t l) {
                        return double(chunk.levelErrors[l - 1]) * bounds.scale * scale;
                    };
                    if (level > 0) {
                        EXPECT_LE(pixels(level), 0.25);
                        const double metres = double(chunk.levelErrors[level - 1]) * bounds.scale;
                        EXPECT_LE(metres * pixelsPerMetre(options, bounds), 0.25);
                        ++coarse;
                    }
                    if (level + 1 < chunk.levelCount) {
                        EXPECT_GE(pixels(level + 1), 0.25 * (1 - 1e-3));
                        ++fine;
                    }
                }
            }
        }
    }
    EXPECT_GT(coarse, 500u);
    EXPECT_GT(fine, 500u);
}

TEST_F(GBufferLevels, FarInstancesAreCoarseAndNearOnesAreNot)
{
    RasterScene scene;
    const uint32_t mesh = scene.addMesh(sphereMesh(24));
    scene.addInstance(mesh, scene.addMaterial(testMaterial()), glm::dmat4(1));
    const gbuffer::Geometry geometry = uploadGeometry(scene);
    RasterOptions options = perspectiveOptions();
    options.maxLevelError = gbuffer::defaultMaxLevelError;
    uint64_t before = 0;
    // The first camera is inside the sphere's bounds.
    for (const double distance : {1.2, 3.0, 30.0, 1000.0}) {
        lookAt(options.camera, {0, 0, distance}, {0, 0, 0});
        render(geometry, options);
        const Drawn d = drawn(geometry);
        uint32_t instances = 0;
        for (const gpu::DrawCommand& c : d.commands)
            instances += c.instanceCount;
        EXPECT_EQ(instances, 1u);
        if (distance < 10) {
            EXPECT_EQ(triangles(d), geometry.counts().triangles);
        } else {
            EXPECT_LT(triangles(d), before);
        }
        before = triangles(d);
    }
    EXPECT_LT(before, geometry.counts().triangles / 10);
}

// Coverage changes at silhouettes alone. The spheres are apart from each other and some pixels
// wide, so that every silhouette has surface on one side and background on the other.
TEST_F(GBufferLevels, PicturesChangeAtSilhouettesAlone)
{
    RasterScene scene;
    const uint32_t mesh = scene.addMesh(sphereMesh(24));
    const uint32_t material = scene.addMaterial(testMaterial());
    for (int y = -3; y <= 3; ++y)
        for (int x = -4; x <= 4; ++x)
            scene.addInstance(mesh, material,
                              glm::translate(glm::dmat4(1), glm::dvec3(2.6 * x, 2.6 * y, 0.1 * x)));
    const gbuffer::Geometry geometry = uploadGeometry(scene);
    RasterOptions options = perspectiveOptions();
    options.maxLevelError = gbuffer::defaultMaxLevelError;
    lookAt(options.camera, {0.3, 0.2, 19}, {0, 0, 0});
    const RasterImage levels = render(geometry, options);
    EXPECT_LT(triangles(drawn(geometry)), geometry.counts().triangles / 2);
    expectSameImage(levels, render(geometry, options));
    options.maxLevelError = 0;
    const RasterImage full = render(geometry, options);
    size_t changed = 0;
    for (uint32_t y = 1; y + 1 < full.height; ++y)
        for (uint32_t x = 1; x + 1 < full.width; ++x) {
            const size_t at = size_t(y) * full.width + x;
            if (levels.covered(at) == full.covered(at))
                continue;
            ++changed;
            size_t around = 0;
            for (const int dy : {-1, 0, 1})
                for (const int dx : {-1, 0, 1})
                    around += full.covered(size_t(int64_t(at) + dy * int64_t(full.width) + dx));
            EXPECT_TRUE(around > 0 && around < 9) << x << "," << y;
        }
    // A quarter of a pixel along the silhouettes is less than this share of the surfaces.
    EXPECT_LT(double(changed), 0.1 * double(full.coveredCount()));
}

} // namespace candelabra::test
