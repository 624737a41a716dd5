// SPDX-License-Identifier: Apache-2.0
// Tests the G-buffer: packing bounds, depth and material factors of meshes, transforms.
#include <cmath>
#include <cstdio>

#include <glm/gtc/matrix_inverse.hpp>
#include <glm/gtc/matrix_transform.hpp>
#include <glm/gtc/type_ptr.hpp>

#include "candelabra_probes.h"
#include "gpu/gbuffer_harness.h"
#include "gpu/probe.h"
#include "harness/constants.h"
#include "shared/gbuffer_probe.h"

namespace candelabra::test
{
class GBufferPacking : public ProbeTest
{
};

// The declared bounds hold and are not loose: the worst error found is at least a third of them.
TEST_F(GBufferPacking, ErrorsStayWithinDeclaredBounds)
{
    Random random(1);
    std::vector<gpu::PackingProbeInput> inputs;
    for (const float x : {-1.f, 0.f, 1.f})
        for (const float y : {-1.f, 0.f, 1.f})
            for (const float z : {-1.f, 0.f, 1.f})
                if (x != 0 || y != 0 || z != 0)
                    inputs.push_back({.normal = glm::normalize(glm::vec3(x, y, z)),
                                      .perceptualRoughness = 0.5f * (x + 1)});
    for (int i = 0; i < 400000; ++i) {
        glm::dvec3 n = random.direction();
        if (i % 4 == 1) // near the fold of the octahedron
            n = glm::normalize(n * glm::dvec3(1, 1, 1e-6));
        else if (i % 4 == 2) // near the poles
            n = glm::normalize(n * glm::dvec3(1e-4, 1e-4, 1));
        inputs.push_back(
            {.normal = glm::vec3(n), .perceptualRoughness = float(random.uniform(0, 1))});
    }
    const auto outputs = runProbe<gpu::PackingProbeOutput>(spirv::gbuffer_packing_comp, inputs);
    double fullAngle = 0, compactAngle = 0, compactRoughness = 0;
    for (size_t i = 0; i < inputs.size(); ++i) {
        const glm::dvec3 n(inputs[i].normal);
        const double r = inputs[i].perceptualRoughness;
        const auto& o = outputs[i];
        ASSERT_NEAR(glm::length(glm::dvec3(o.normalFull)), 1, 3e-7);
        fullAngle = std::max(fullAngle, angleBetween(n, o.normalFull));
        compactAngle = std::max(compactAngle, angleBetween(n, o.normalCompact));
        compactRoughness = std::max(compactRoughness, std::abs(r - o.roughnessCompact));
        ASSERT_EQ(o.unlit, glm::vec3(0));
    }
    std::printf("worst angle: full %.3g, compact %.3g rad; roughness of compact: %.3g\n", fullAngle,
                compactAngle, compactRoughness);
    const auto expectBound = [](double worst, double bound) {
        EXPECT_LE(worst, bound);
        EXPECT_GE(worst, bound / 3);
    };
    expectBound(fullAngle, gpu::NORMAL_ERROR_FULL);
    expectBound(compactAngle, gpu::NORMAL_ERROR_COMPACT);
    expectBound(compactRoughness, gpu::ROUGHNESS_ERROR_COMPACT);
}

namespace
{

// The largest error of a unit float (shared/gbuffer_data.h): relative from UNIT_FLOAT_NORMAL on, in
// smallest steps below.
struct UnitFloatError {
    uint32_t mantissa;
    double relative = 0, steps = 0;

    void add(double value, double stored)
    {
        const double normal = gpu::UNIT_FLOAT_NORMAL;
        const double error = std::abs(stored - value);
        if (value >= normal)
            relative = std::max(relative, error / value);
        else
            steps = std::max(steps, error / std::ldexp(normal, -int(mantissa)));
    }
    void expect(const char* what, double bound) const
    {
        std::printf("%s: relative error %.3g, below 2^-7 %.3g steps\n", what, relative, steps);
        EXPECT_LE(relative, bound) << what;
        EXPECT_GE(relative, bound / 1.5) << what;
        EXPECT_LE(steps, 1.5) << what;
    }
};

} // namespace

// Roughness, albedo and F0 of FULL over the whole range; and what is packed are the bits of a
// second implementation of the format, on every device.
TEST_F(GBufferPacking, UnitFloatsAreTheNearest)
{
    Random random(2);
    std::vector<gpu::PackingProbeInput> inputs;
    const auto number = [&](int i) {
        const double x = i % 4 ? random.uniform(0, 1) : std::exp2(random.uniform(-30, 0));
        return float(i % 31 == 7 ? 1 - x * 1e-5 : x); // some near 1
    };
    for (int i = 0; i < 400000; ++i) {
        const glm::vec3 albedo(number(i), number(i), number(i));
        inputs.push_back({.normal = {0, 0, 1},
                          .perceptualRoughness = number(i),
                          .albedo = albedo,
                          .specularWeight = i % 3 ? 1 : number(i),
                          .F0 = {number(i), number(i), number(i)}});
    }
    const auto outputs = runProbe<gpu::PackingProbeOutput>(spirv::gbuffer_packing_comp, inputs);
    UnitFloatError roughness{gpu::ROUGHNESS_MANTISSA}, albedo{gpu::COLOUR_MANTISSA},
        F0{gpu::COLOUR_MANTISSA}, shortF0{gpu::COLOUR_MANTISSA_SHORT};
    double weight = 0;
    CpuGBuffer expected, packed;
    for (size_t i = 0; i < inputs.size(); ++i) {
        const gpu::PackingProbeInput& in = inputs[i];
        const gpu::PackingProbeOutput& o = outputs[i];
        addPixel(expected, {.perceptualRoughness = double(in.perceptualRoughness),
                            .albedo = in.albedo,
                            .F0F90 = glm::vec4(in.F0, in.specularWeight)});
        packed.albedo.push_back(o.albedo);
        packed.specular.push_back(o.specular);
        ASSERT_EQ(o.normalRoughness, expected.normalRoughness[i]) << i;
        ASSERT_EQ(o.albedo, expected.albedo[i]) << i;
        ASSERT_EQ(o.specular, expected.specular[i]) << i;
        roughness.add(in.perceptualRoughness, o.roughnessFull);
        for (int c = 0; c < 3; ++c) {
            albedo.add(in.albedo[c], o.albedoFull[c]);
            (in.specularWeight == 1 ? F0 : shortF0).add(in.F0[c], o.F0Full[c]);
            // These are floats: nothing is rounded.
            ASSERT_EQ(double(o.albedoFull[c]), storedAlbedo(packed, i)[c]);
            ASSERT_EQ(double(o.F0Full[c]), storedSpecular(packed, i)[c]);
        }
        weight = std::max(weight, std::abs(double(o.weightFull) - double(in.specularWeight)));
    }
    roughness.expect("roughness", gpu::ROUGHNESS_ERROR_FULL);
    albedo.expect("albedo", gpu::COLOUR_ERROR_FULL);
    F0.expect("F0", gpu::COLOUR_ERROR_FULL);
    shortF0.expect("F0 with F90 below 1", gpu::COLOUR_ERROR_FULL_SHORT);
    EXPECT_LE(weight, gpu::F90_ERROR_FULL);
}

TEST_F(GBufferPacking, ExactNumbersAndNumbersOutOfRange)
{
    std::vector<gpu::PackingProbeInput> inputs;
    const auto add = [&](float x, float weight) {
        inputs.push_back({{0, 0, 1}, x, glm::vec3(x), weight, glm::vec3(x)});
    };
    const float exact[] = {0, 1, 0.5f, 0.25f, 0.75f, 0.0625f, 1.0f / 1024};
    const float outside[] = {-0.0f, -1, -1e30f, nan, 1.5f, 1e30f};
    const float clamped[] = {0, 0, 0, 0, 1, 1};
    for (const float x : exact)
        for (const float weight : {0.f, 1.f})
            add(x, weight);
    for (const float x : outside)
        add(x, x);
    const auto outputs = runProbe<gpu::PackingProbeOutput>(spirv::gbuffer_packing_comp, inputs);
    const auto expectNumbers = [&](size_t i, float x, float weight) {
        EXPECT_EQ(outputs[i].roughnessFull, x) << i;
        EXPECT_EQ(outputs[i].albedoFull, glm::vec3(x)) << i;
        EXPECT_EQ(outputs[i].F0Full, glm::vec3(x)) << i;
        EXPECT_EQ(outputs[i].weightFull, weight) << i;
        EXPECT_EQ(outputs[i].normalFull, glm::vec3(0, 0, 1)) << i;
    };
    for (size_t i = 0; i < 2 * std::size(exact); ++i)
        expectNumbers(i, exact[i / 2], float(i % 2));
    for (size_t i = 0; i < std::size(outside); ++i)
        expectNumbers(2 * std::size(exact) + i, clamped[i], clamped[i]);
    // A surface that reflects nothing is stored as zeros.
    EXPECT_EQ(outputs[0].albedo, glm::uvec2(0));
    EXPECT_EQ(outputs[0].specular, glm::uvec2(0));
}

class GBufferMesh : public RasterTest
{
protected:
    // A tilted, non-uniformly scaled quad that fills the middle of the view.
    static glm::dmat4 tilted()
    {
        glm::dmat4 m = glm::translate(glm::dmat4(1), glm::dvec3(0.3, -0.2, -7));
        m = glm::rotate(m, 0.8, glm::normalize(glm::dvec3(1, 2, 0.3)));
        return glm::scale(m, glm::dvec3(3, 1.5, 0.7));
    }
    static RasterScene quadScene(const gbuffer::Material& material, const glm::dmat4& place)
    {
        RasterScene scene;
        scene.addInstance(scene.addMesh(quadMesh()), scene.addMaterial(material), place);
        return scene;
    }
};

// Relative distance of reconstructed positions from the quad's plane. The rasteriser interpolates
// depth; the worst values measured on lavapipe are 1.3e-7 reversed, 4e-7 orthographic, 1.1e-6 not
// reversed. Other devices first move vertices to a grid of 2^-subPixelPrecisionBits pixels, and the
// plane with them: by 2e-4 with SwiftShader's four bits, where a pixel is 0.01 wide.
TEST_F(GBufferMesh, DepthGivesThePositionBack)
{
    RasterOptions options = perspectiveOptions();
    const RasterScene scene = quadScene(testMaterial(), tilted());
    const glm::dvec3 normal = glm::normalize(glm::dvec3(glm::inverseTranspose(tilted())[2]));
    const double aspect = double(options.width) / options.height;
    const double moved =
        device().lanesAreCpuVector ? 0 : std::exp2(-1.0 - device().limits.subPixelPrecisionBits);
    for (const int projection : {0, 1, 2, 3, 4}) {
        SCOPED_TRACE(projection);
        options.clearDepth = projection % 2 ? 1.f : 0.f;
        const bool reversed = options.clearDepth == 0;
        if (projection < 4)
            setPerspective(options.camera, 1.0, aspect, 0.5, projection < 2 ? 0 : 50, reversed);
        else
            setOrthographic(options.camera, 7, aspect, 0.5, 50, reversed);
        const RasterImage image = render(scene, options);
        ASSERT_GT(image.coveredCount(), 2000u);
        double worst = 0;
        for (uint32_t y = 0; y < image.height; ++y)
            for (uint32_t x = 0; x < image.width; ++x) {
                if (!image.covered(size_t(y) * image.width + x))
                    continue;
                const glm::dvec3 p = viewPosition(image, x, y);
                const double off = std::abs(glm::dot(p - glm::dvec3(tilted()[3]), normal));
                const double pixel =
                    (projection < 4 ? -2 * std::tan(0.5) * p.z : 7) / options.height;
                worst = std::max(worst, (off - moved * pixel) / glm::length(p));
            }
        std::printf("projection %d: worst relative distance from the plane %.3g\n", projection,
                    worst);
        // Depth that is not reversed has steps of 2^-24 near 1, which are z^2 / near * 2^-24
        // metres.
        EXPECT_LE(worst, reversed ? 1e-6 : 1e-5);
    }
}

TEST_F(GBufferMesh, FullLayoutHoldsTheMaterial)
{
    const gbuffer::Material m = testMaterial();
    RasterOptions options = perspectiveOptions();
    options.background = {7, 8, 9};
    const RasterImage image = render(quadScene(m, tilted()), options);
    glm::dvec3 normal = glm::normalize(glm::dvec3(glm::inverseTranspose(tilted())[2]));
    size_t background = 0;
    for (size_t i = 0; i < image.depth.size(); ++i) {
        if (!image.covered(i)) {
            ++background;
            ASSERT_EQ(image.radiance[i], glm::vec4(7, 8, 9, 1));
            continue;
        }
        // 1e-6 allows for rounding of the normal in the vertex shader.
        ASSERT_LE(angleBetween(storedNormal(image, i), normal), gpu::NORMAL_ERROR_FULL + 1e-6);
        ASSERT_NEAR(storedRoughness(image, i), m.perceptualRoughness, gpu::ROUGHNESS_ERROR_FULL);
        const glm::dvec3 albedo = storedAlbedo(image, i);
        const glm::dvec4 specular = storedSpecular(image, i);
        for (int c = 0; c < 3; ++c) {
            // The bound of packing, and the rounding of floats.
            const double bound = double(gpu::COLOUR_ERROR_FULL) + 2e-7;
            const double base = double(m.baseColor[c]);
            ASSERT_NEAR(albedo[c], base * 0.75, base * 0.75 * bound);
            const double F0 = 0.04 * 0.75 + base * 0.25;
            ASSERT_NEAR(specular[c], F0, F0 * bound);
            ASSERT_EQ(image.radiance[i][c], m.emission[c]);
        }
        ASSERT_EQ(specular.a, 1);
    }
    EXPECT_GT(background, 1000u);
}

// A thousand materials: the bits in the G-buffer are those of a second implementation of the
// format.
TEST_F(GBufferMesh, MaterialsHaveTheSameBitsOnEveryDevice)
{
    constexpr uint32_t columns = 40, rows = 25, side = 4; // pixels
    Random random(12);
    RasterScene scene;
    const uint32_t mesh = scene.addMesh(quadMesh());
    for (uint32_t i = 0; i < columns * rows; ++i) {
        gbuffer::Material m{.perceptualRoughness = float(random.uniform(0, 1))};
        m.specularWeight = i % 5 ? 1 : float(random.uniform(0, 1));
        for (int c = 0; c < 3; ++c) {
            m.baseColor[c] = float(random.uniform(0, 1));
            m.dielectricF0[c] = float(random.uniform(0, 1));
        }
        const glm::dvec3 at(i % columns + 0.5 - 0.5 * columns, 0.5 * rows - i / columns - 0.5, -2);
        scene.addInstance(mesh, scene.addMaterial(m),
                          glm::scale(glm::translate(glm::dmat4(1), at), glm::dvec3(0.5)));
    }
    RasterOptions options = perspectiveOptions();
    options.width = columns * side;
    options.height = rows * side;
    setOrthographic(options.camera, rows, double(columns) / rows, 0.1, 10);
    const RasterImage image = render(scene, options);
    CpuGBuffer expected;
    for (const gbuffer::Material& m : scene.materials)
        addPixel(expected, {.perceptualRoughness = double(m.perceptualRoughness),
                            .albedo = glm::make_vec3(m.baseColor),
                            .F0F90 = glm::vec4(glm::make_vec3(m.dielectricF0), m.specularWeight)});
    for (uint32_t y = 0; y < image.height; ++y)
        for (uint32_t x = 0; x < image.width; ++x) {
            const size_t i = size_t(y) * image.width + x;
            const size_t material = y / side * columns + x / side;
            ASSERT_EQ(image.normalRoughness[i], expected.normalRoughness[material]) << material;
            ASSERT_EQ(image.albedo[i], expected.albedo[material]) << material;
            ASSERT_EQ(image.specular[i], expected.specular[material]) << material;
        }
}

TEST_F(GBufferMesh, CompactLayoutHoldsTheMaterial)
{
    const gbuffer::Material m = testMaterial();
    RasterOptions options = perspectiveOptions();
    options.layout = CND_GBUFFER_COMPACT;
    const RasterImage image = render(quadScene(m, tilted()), options);
    ASSERT_GT(image.coveredCount(), 2000u);
    for (size_t i = 0; i < image.depth.size(); ++i) {
        if (!image.covered(i))
            continue;
        const uint32_t word = image.normalRoughness[i].x;
        ASSERT_NEAR((word >> 24) / 255.0, m.perceptualRoughness, gpu::ROUGHNESS_ERROR_COMPACT);
        ASSERT_NE(word & 0xFFFu, gpu::NORMAL_ROUGHNESS_UNLIT_COMPACT);
        const glm::u8vec4 albedo = image.compactAlbedo[i];
        for (int c = 0; c < 3; ++c) {
            const double encoded = 1.055 * std::pow(double(m.baseColor[c]), 1 / 2.4) - 0.055;
            // Vulkan allows an error of 0.6 steps when sRGB is encoded.
            ASSERT_NEAR(albedo[c], encoded * 255, 0.6 + 0.5);
        }
        ASSERT_NEAR(albedo.a / 255.0, m.metalness, 0.51 / 255);
    }
}

// Emissive surfaces are drawn after everything else, in a separate pass. Whatever the order of the
// instances, the nearer surface is seen, and it alone is in the radiance.
TEST_F(GBufferMesh, NearerSurfacesHideRadiance)
{
    gbuffer::Material dark = testMaterial(), lit = testMaterial();
    std::fill_n(dark.emission, 3, 0.0f);
    dark.baseColor[0] = 0.1f;
    const auto place = [](double x, double z) {
        return glm::translate(glm::dmat4(1), glm::dvec3(x, 0, z));
    };
    RasterOptions options = perspectiveOptions();
    options.background = {7, 8, 9};
    for (const bool analytic : {false, true})
        for (const bool litFirst : {false, true}) {
            SCOPED_TRACE(::testing::Message() << analytic << litFirst);
            RasterScene scene;
            const uint32_t mesh = scene.addMesh(sphereMesh(24));
            const uint32_t materials[] = {scene.addMaterial(dark), scene.addMaterial(lit)};
            // On the left the dark sphere is in front, on the right the one that emits light.
            for (const bool isLit : {litFirst, !litFirst})
                for (const double side : {-2.0, 2.0}) {
                    const bool inFront = isLit == (side > 0);
                    const glm::dmat4 m = place(side * (inFront ? 1 : 1.5), inFront ? -6 : -9);
                    if (!analytic) {
                        scene.addInstance(mesh, materials[isLit], m);
                        continue;
                    }
                    gbuffer::AnalyticObject o{.type = gbuffer::AnalyticObject::Type::Ball,
                                              .material = materials[isLit]};
                    std::copy_n(glm::value_ptr(m[3]), 3, o.point);
                    scene.analyticObjects.push_back(o);
                }
            const RasterImage image = render(scene, options);
            size_t seen[2] = {};
            for (size_t i = 0; i < image.depth.size(); ++i) {
                if (!image.covered(i)) {
                    ASSERT_EQ(image.radiance[i], glm::vec4(7, 8, 9, 1));
                    continue;
                }
                const bool isLit = storedAlbedo(image, i).r > 0.3;
                ++seen[isLit];
                for (int c = 0; c < 3; ++c)
                    ASSERT_EQ(image.radiance[i][c], isLit ? lit.emission[c] : 0) << i;
                // Only the spheres in front are that near, and they are seen whole.
                const bool near =
                    -viewPosition(image, uint32_t(i % image.width), uint32_t(i / image.width)).z <
                    6.1;
                const bool right = i % image.width >= image.width / 2;
                if (near) {
                    ASSERT_EQ(isLit, right) << i;
                }
            }
            EXPECT_GT(seen[0], 500u);
            EXPECT_GT(seen[1], 500u);
        }
}

// A thousand kilometres from the origin along every axis the image equals that at the origin.
TEST_F(GBufferMesh, FarFromTheOriginLooksTheSame)
{
    Random random(3);
    RasterScene near, far;
    const glm::dvec3 shift(1e6 + 1.0 / 3, -1e6 - 0.7, 1e6 + 0.1);
    for (RasterScene* scene : {&near, &far}) {
        Random same(4);
        const uint32_t mesh = scene->addMesh(cubeMesh());
        const uint32_t material = scene->addMaterial(testMaterial());
        for (int i = 0; i < 40; ++i) {
            glm::dmat4 m =
                glm::translate(glm::dmat4(1), same.box(4) - glm::dvec3(0, 0, 9) +
                                                  (scene == &far ? shift : glm::dvec3(0)));
            m = glm::rotate(m, same.uniform(0, 6), same.direction());
            scene->addInstance(mesh, material, glm::scale(m, glm::dvec3(same.uniform(0.1, 0.7))));
        }
    }
    RasterOptions options = perspectiveOptions();
    lookAt(options.camera, {0.5, 0.25, 1}, {0, 0, -9});
    const RasterImage a = render(near, options);
    lookAt(options.camera, glm::dvec3(0.5, 0.25, 1) + shift, glm::dvec3(0, 0, -9) + shift);
    const RasterImage b = render(far, options);
    size_t different = 0;
    for (size_t i = 0; i < a.depth.size(); ++i)
        different += std::abs(a.depth[i] - b.depth[i]) > 2e-6f * a.depth[i] ||
                     angleBetween(storedNormal(a, i), storedNormal(b, i)) > 2e-6;
    EXPECT_GT(a.coveredCount(), 5000u);
    EXPECT_LE(different, 4u); // pixel centres on an edge
}

// A mirrored instance shows its outside: the silhouette is mirrored, and the normals are those of
// the mirrored shape.
TEST_F(GBufferMesh, MirroredInstancesKeepTheirOutside)
{
    for (const bool flipCamera : {false, true}) {
        SCOPED_TRACE(flipCamera);
        RasterOptions options = perspectiveOptions();
        if (flipCamera) // an upside-down image
            options.camera.clipFromView[5] *= -1;
        const glm::dmat4 place = glm::translate(glm::dmat4(1), glm::dvec3(0, 0, -4));
        const glm::dmat4 mirror = glm::scale(place, glm::dvec3(-1, 1, 1));
        RasterScene plain, mirrored;
        for (RasterScene* scene : {&plain, &mirrored})
            scene->addInstance(scene->addMesh(sphereMesh(24)), scene->addMaterial(testMaterial()),
                               scene == &plain ? place : mirror);
        const RasterImage a = render(plain, options), b = render(mirrored, options);
        ASSERT_GT(a.coveredCount(), 1500u);
        for (uint32_t y = 0; y < a.height; ++y)
            for (uint32_t x = 0; x < a.width; ++x) {
                const size_t i = size_t(y) * a.width + x;
                const size_t j = size_t(y) * a.width + (a.width - 1 - x);
                ASSERT_NEAR(a.depth[i], b.depth[j], 1e-6);
                if (!a.covered(i))
                    continue;
                const glm::dvec3 n = storedNormal(a, i), m = storedNormal(b, j);
                // Facets at grazing angles may face slightly away from the viewer.
                ASSERT_GT(glm::dot(n, viewPosition(a, x, y)), -4.0);
                ASSERT_LT(glm::dot(n, glm::normalize(viewPosition(a, x, y))), 0.1);
                ASSERT_LT(angleBetween(n, m * glm::dvec3(-1, 1, 1)), 1e-5);
            }
    }
}

TEST_F(GBufferMesh, DoubleSidedShowsItsBackWithTheNormalTurned)
{
    const glm::dmat4 back =
        glm::rotate(glm::translate(glm::dmat4(1), glm::dvec3(0, 0, -3)), pi, glm::dvec3(0, 1, 0));
    const RasterOptions options = perspectiveOptions();
    gbuffer::Material m = testMaterial();
    EXPECT_EQ(render(quadScene(m, back), options).coveredCount(), 0u);
    m.doubleSided = true;
    const RasterImage image = render(quadScene(m, back), options);
    ASSERT_GT(image.coveredCount(), 2000u);
    for (size_t i = 0; i < image.depth.size(); ++i)
        if (image.covered(i)) {
            ASSERT_LT(angleBetween(storedNormal(image, i), {0, 0, 1}), 2e-6);
        }
}

} // namespace candelabra::test
