// SPDX-License-Identifier: Apache-2.0
// Surfaces lit through the GLSL for hosts (lib/forward.glsl) must have the luminance that the
// module's own pass gives them: on the opaque surfaces of the view, and anywhere in front of,
// behind and beside them.
#include <cmath>
#include <iostream>
#include <random>

#include "candelabra/compiler.hpp"
#include "candelabra_probes.h"
#include "gpu/kernel.h"
#include "gpu/lighting_harness.h"
#include "gpu/pixel_difference.h"
#include "shared/forward_probe.h"

namespace candelabra::test
{
namespace
{

// The largest relative difference of a pixel on llvmpipe, where positions have the same bits.
constexpr double tolerance = 1e-5;

// A host with a pipeline of its own in addition to the module.
class ForwardTest : public LightingTest
{
protected:
    void create(const CpuGBuffer& g, const std::vector<CndLight>& lights, bool byError = false,
                uint32_t shadowPoints = 0, const CndHostKernels& rays = {})
    {
        own_ = createLighting(
            g, CndLightingDesc{.framesInFlight = 2,
                               .specularMethods = 1u << CND_SPECULAR_CONIC,
                               .shading = CND_SHADING_CLUSTERED_BIT | CND_SHADING_BRUTE_BIT,
                               .forwardStages = VK_SHADER_STAGE_COMPUTE_BIT,
                               .hostKernels = rays,
                               .influenceByError = byError,
                               .shadows = {.points = shadowPoints}});
        ASSERT_TRUE(own_.lighting && own_.view);
        setLights(own_.lighting, lights);
        // The sets of all modules with occluders fit the same pipeline.
        if (!pipeline_.get())
            createPipeline(rays.count     ? spirv::forward_comp_candelabra_visible_points
                           : shadowPoints ? spirv::forward_comp_candelabra_shadows
                                          : spirv::forward_comp);
    }
    void TearDown() override
    {
        pipeline_ = {};
        layout_ = {};
        bindings_ = {};
        LightingTest::TearDown();
    }
    void createPipeline(const gpu::Spirv& spirv)
    {
        CndError error{};
        VkDescriptorSetLayout forward{};
        ASSERT_EQ(cndGetForwardSetLayout(own_.lighting, &forward, &error), CND_SUCCESS)
            << error.message;
        constexpr VkDescriptorType image = VK_DESCRIPTOR_TYPE_SAMPLED_IMAGE;
        bindings_ =
            gpu::Bindings(device(), "forward probe",
                          {{gpu::FORWARD_PROBE_NORMAL_ROUGHNESS, image, 1},
                           {gpu::FORWARD_PROBE_ALBEDO, image, 1},
                           {gpu::FORWARD_PROBE_SPECULAR, image, 1},
                           {gpu::FORWARD_PROBE_DEPTH, image, 1},
                           {gpu::FORWARD_PROBE_OUTPUT, VK_DESCRIPTOR_TYPE_STORAGE_BUFFER, 1}},
                          VK_SHADER_STAGE_COMPUTE_BIT, 1);
        const VkDescriptorSetLayout sets[] = {bindings_.layout(), forward};
        layout_ =
            gpu::createPipelineLayout(device(), "forward probe", sets, VK_SHADER_STAGE_COMPUTE_BIT,
                                      sizeof(gpu::ForwardProbeParams));
        const auto shader = gpu::createShaderModule(device(), spirv);
        const VkComputePipelineCreateInfo info{
            .sType = VK_STRUCTURE_TYPE_COMPUTE_PIPELINE_CREATE_INFO,
            .stage = {.sType = VK_STRUCTURE_TYPE_PIPELINE_SHADER_STAGE_CREATE_INFO,
                      .stage = VK_SHADER_STAGE_COMPUTE_BIT,
                      .module = shader.get(),
                      .pName = "main"},
            .layout = layout_.get()};
        VkPipeline pipeline{};
        ASSERT_EQ(device().CreateComputePipelines(device().handle, VK_NULL_HANDLE, 1, &info,
                                                  nullptr, &pipeline),
                  VK_SUCCESS);
        pipeline_ = gpu::Handle(device(), pipeline);
    }

    struct Lit {
        std::vector<glm::vec4> deferred;              // radiance of the view
        std::vector<gpu::ForwardProbeOutput> forward; // luminance of the surfaces of `at`
        std::vector<glm::vec4> lit() const
        {
            std::vector<glm::vec4> out;
            for (const gpu::ForwardProbeOutput& f : forward)
                out.push_back(f.lit);
            return out;
        }
        std::vector<glm::vec4> stepped() const
        {
            std::vector<glm::vec4> out;
            for (const gpu::ForwardProbeOutput& f : forward)
                out.push_back(f.stepped);
            return out;
        }
    };
    // Records the view with the surfaces of `seen`, then lights the surfaces of `at`, which have
    // the same camera.
    Lit frame(const CpuGBuffer& seen, const CpuGBuffer& at, const RunOptions& options,
              uint32_t shadowed = 0)
    {
        CndError error{};
        const Images images = uploadImages(seen), others = uploadImages(at);
        CndLightingFrame f = frameOf(seen, images, options);
        f.frameSlot = slot_ = 1 - slot_;
        VkDescriptorSet forward{};
        EXPECT_EQ(cndGetForwardSet(own_.view, slot_, &forward, &error), CND_SUCCESS)
            << error.message;
        const uint32_t count = at.width * at.height;
        const gpu::Buffer out =
            readback("forward outputs", count * sizeof(gpu::ForwardProbeOutput));
        using gpu::Binding;
        bindings_.write(0,
                        {Binding::sampled(gpu::FORWARD_PROBE_NORMAL_ROUGHNESS,
                                          others.normalRoughness.view.get()),
                         Binding::sampled(gpu::FORWARD_PROBE_ALBEDO, others.albedo.view.get()),
                         Binding::sampled(gpu::FORWARD_PROBE_SPECULAR, others.specular.view.get()),
                         Binding::sampled(gpu::FORWARD_PROBE_DEPTH, others.depth.view.get()),
                         Binding::of(gpu::FORWARD_PROBE_OUTPUT, out)});
        const gpu::ForwardProbeParams params{.size = {at.width, at.height},
                                             .invImageSize = 1.0f / glm::vec2(at.width, at.height),
                                             .clearDepth = at.clearDepth,
                                             .shadowed = shadowed};
        context().submitAndWait([&](VkCommandBuffer cmd) {
            clearRadiance(cmd, images);
            EXPECT_EQ(cndRecordLighting(own_.view, cmd, &f, &error), CND_SUCCESS) << error.message;
            const gpu::Device& d = device();
            const VkDescriptorSet sets[] = {bindings_.set(0), forward};
            d.CmdBindPipeline(cmd, VK_PIPELINE_BIND_POINT_COMPUTE, pipeline_.get());
            d.CmdBindDescriptorSets(cmd, VK_PIPELINE_BIND_POINT_COMPUTE, layout_.get(), 0, 2, sets,
                                    0, nullptr);
            d.CmdPushConstants(cmd, layout_.get(), VK_SHADER_STAGE_COMPUTE_BIT, 0, sizeof params,
                               &params);
            d.CmdDispatch(cmd, gpu::divideUp(count, gpu::FORWARD_PROBE_GROUP), 1, 1);
            // The next frame may be recorded immediately: the module waits for the shader above.
            f.frameSlot = slot_ = 1 - slot_;
            EXPECT_EQ(cndRecordLighting(own_.view, cmd, &f, &error), CND_SUCCESS) << error.message;
            fullBarrier(cmd);
        });
        const auto values = out.as<gpu::ForwardProbeOutput>();
        return {readRadiance(images), {values.begin(), values.begin() + long(count)}};
    }

    // Expects that what the shader of this test has computed for surfaces, with the module's
    // forward functions, is what the view shows of them. llvmpipe compiles both alike. Elsewhere
    // each pipeline computes positions with roundings of its own, and where the lobe is narrow and
    // a light is near, an ulp of the position turns the direction to the light by a part of the
    // lobe's width. So there the images may differ by a few times what an ulp of the depth changes.
    void expectAlike(const std::vector<glm::vec4>& forward, const std::vector<glm::vec4>& expected,
                     const CpuGBuffer& at, const std::vector<CndLight>& lights,
                     const RunOptions& options, double onLlvmpipe = tolerance)
    {
        if (device().lanesAreCpuVector) {
            EXPECT_LE(maxPixelDifference(forward, expected), onLlvmpipe);
            return;
        }
        const std::vector<glm::vec4> image = run(at, lights, options).radiance;
        double moved = 0;
        for (const float end : {0.0f, 1.0f}) {
            CpuGBuffer g = at;
            for (float& depth : g.depth)
                if (depth != g.clearDepth)
                    depth = std::nextafter(depth, end);
            moved = std::max(moved, maxRelativeDifference(run(g, lights, options).radiance, image));
        }
        const double difference = maxRelativeDifference(forward, expected);
        std::cout << "largest difference over the peak " << difference
                  << "; an ulp of the depth makes " << moved << "\n";
        EXPECT_LE(difference, std::max(acrossPipelines, 4 * moved));
    }
    // Draws with the module's shadows and expects the light of the deferred view. Returns the
    // largest difference from the light without shadows, as a share of the largest radiance.
    double changeByShadows(const CpuGBuffer& seen, const std::vector<CndLight>& lights)
    {
        const RunOptions options{.specular = CND_SPECULAR_CONIC};
        const Lit shadowed = frame(seen, seen, options);
        std::vector<glm::vec4> twice = shadowed.lit(); // the view was recorded twice
        for (glm::vec4& pixel : twice)
            pixel *= 2;
        expectAlike(twice, shadowed.deferred, seen, lights, options);
        return maxRelativeDifference(run(seen, lights, options).radiance, shadowed.lit());
    }

    LightingAndView own_;
    uint32_t slot_ = 0;
    gpu::Bindings bindings_;
    gpu::Handle<VkPipelineLayout> layout_;
    gpu::Handle<VkPipeline> pipeline_;
};

std::vector<CndLight> everyType(const CpuGBuffer& g, uint32_t perType)
{
    std::vector<CndLight> all;
    for (uint32_t type = 0; type < CND_LIGHT_TYPE_COUNT; ++type) {
        const bool distant = cndIsDistant(type);
        const std::vector<CndLight> some =
            lightsOf(CndLightType(type), g, distant ? 3 : perType, 40 + type);
        all.insert(all.end(), some.begin(), some.end());
    }
    return all;
}

CpuGBuffer gbuffer(uint32_t seed, bool perspective = true)
{
    CndCamera camera;
    if (perspective)
        setPerspective(camera, 1.0, 4.0 / 3, 0.1);
    else
        setOrthographic(camera, 20, 4.0 / 3, 0.1, 50);
    return randomGBuffer(64, 48, camera, 0, seed);
}

// Also without any opaque surface, and when the module itself does not cull. Lights of other layers
// are left out, and a shadow term scales lights by their ids.
TEST_F(ForwardTest, EqualsTheDeferredResultForTheSameSurface)
{
    const CpuGBuffer seen = gbuffer(3), elsewhere = gbuffer(4);
    CpuGBuffer nothing = seen;
    std::fill(nothing.depth.begin(), nothing.depth.end(), nothing.clearDepth);
    std::vector<CndLight> lights = everyType(seen, 25);
    for (size_t i = 0; i < lights.size(); ++i)
        lights[i].layers = i % 5 ? 1 : 2;
    create(seen, lights);
    RunOptions options{.specular = CND_SPECULAR_CONIC,
                       .lobes = CND_LOBES_CONSERVING,
                       .energyCompensation = true,
                       .layers = 1};
    const Lit same = frame(seen, seen, options);
    std::vector<glm::vec4> twice = same.lit(); // the view was recorded twice
    for (glm::vec4& pixel : twice)
        pixel *= 2;
    expectAlike(twice, same.deferred, seen, lights, options);
    EXPECT_LE(maxPixelDifference(same.stepped(), same.lit()), tolerance);
    constexpr uint32_t shadowed = 9; // a bit mask of ids
    for (size_t id = 0; id < lights.size(); ++id)
        for (float& e : lights[id].emission)
            e *= id & shadowed ? 0.5f : 1.0f;
    std::erase_if(lights, [](const CndLight& light) { return light.layers == 2; });
    const std::vector<glm::vec4> expected = run(elsewhere, lights, options).radiance;
    for (const CpuGBuffer& opaque : {seen, nothing})
        expectAlike(frame(opaque, elsewhere, options, shadowed).lit(), expected, elsewhere, lights,
                    options);
    options.culling = CND_CULLING_BRUTE;
    const Lit brute = frame(seen, elsewhere, options, shadowed);
    expectAlike(brute.lit(), expected, elsewhere, lights, options);
    expectAlike(brute.stepped(), expected, elsewhere, lights, options);
}

TEST_F(ForwardTest, OfEachTypeAloneEqualsTheDeferredResult)
{
    const CpuGBuffer seen = gbuffer(5), elsewhere = gbuffer(6);
    create(seen, {});
    const RunOptions options{.specular = CND_SPECULAR_CONIC};
    for (uint32_t type = 0; type < CND_LIGHT_TYPE_COUNT; ++type) {
        const std::vector<CndLight> lights = lightsOf(CndLightType(type), seen, 40, 50 + type);
        setLights(own_.lighting, lights);
        // The view sorts lights by how hard their outlines are, and evaluates the easy ones by
        // shorter code. Where the lobe is as narrow as allowed, rounding differs by up to 3e-4.
        const bool byOutline = type == CND_LIGHT_TUBE || type == CND_LIGHT_RECTANGLE ||
                               type == CND_LIGHT_DISC || type == CND_LIGHT_POLYGON;
        SCOPED_TRACE(type);
        expectAlike(frame(seen, elsewhere, options).lit(), run(elsewhere, lights, options).radiance,
                    elsewhere, lights, options, byOutline ? 3e-4 : tolerance);
    }
}

// Lights cut with CND_INFLUENCE_BY_ERROR are cut alike for both.
TEST_F(ForwardTest, UnderLightsThatAreCutByAnError)
{
    const CpuGBuffer seen = gbuffer(12);
    std::vector<CndLight> lights = randomSpheres(seen, 100, 62);
    for (size_t i = 10; i < lights.size(); ++i)
        lights[i].radius = 0.01f; // makes the light dim
    create(seen, lights, true);
    const RunOptions options{
        .specular = CND_SPECULAR_CONIC,
        .influence = {.rule = CND_INFLUENCE_BY_ERROR, .maxError = 0.1f, .exposure = 0.003f}};
    const Lit cut = frame(seen, seen, options);
    const CndLightingStats stats = statsOf(own_.view, slot_);
    EXPECT_GT(stats.cutBelow, 0);
    std::vector<glm::vec4> twice = cut.lit();
    for (glm::vec4& pixel : twice)
        pixel *= 2;
    expectAlike(twice, cut.deferred, seen, lights, options);
    EXPECT_GT(maxPixelDifference(cut.lit(), run(seen, lights,
                                                {.specular = CND_SPECULAR_CONIC,
                                                 .influence = {.rule = CND_INFLUENCE_UNCUT}})
                                                .radiance),
              tolerance);
}

TEST_F(ForwardTest, UnderAnOrthographicCameraAndManyLights)
{
    const CpuGBuffer seen = gbuffer(7, false), elsewhere = gbuffer(8, false);
    std::vector<CndLight> lights = randomSpheres(elsewhere, 3000, 60);
    for (CndLight& light : lights) // so that no loop exceeds llvmpipe's limit
        light.influenceRadius = 0.3f + 1.01f * light.radius;
    create(seen, lights);
    const RunOptions options{.specular = CND_SPECULAR_CONIC};
    expectAlike(frame(seen, elsewhere, options).lit(), run(elsewhere, lights, options).radiance,
                elsewhere, lights, options);
}

// The illuminance of points and spheres has a closed form. The shader computes the position by
// division, which Vulkan allows to be wrong by 2.5 ULP, 3e-7 of the distance to the eye. (On
// llvmpipe it is right to 0.5 ULP.) The window of a light falls steeply near the edge of its
// influence: on NVIDIA an error of 4e-6 m, 27 m in front of the eye, moves one pixel by 3.5e-4.
TEST_F(ForwardTest, IlluminanceForVolumes)
{
    const CpuGBuffer g = gbuffer(9);
    std::vector<CndLight> lights = randomSpheres(g, 60, 61);
    for (size_t i = 0; i < lights.size(); i += 2)
        lights[i].type = CND_LIGHT_POINT;
    create(g, lights);
    const Lit result = frame(g, g, {.specular = CND_SPECULAR_CONIC});
    double largest = 0, peak = 0;
    for (uint32_t i = 0; i < g.width * g.height; ++i) {
        if (g.depth[i] == g.clearDepth)
            continue;
        glm::dvec3 expected(0), by(0);
        glm::dvec3 moved(0); // change of the illuminance by windows, if the position is as wrong
        const double positionError = device().lanesAreCpuVector ? 0 : 3e-7;
        const glm::dvec3 position = viewPosition(g, i % g.width, i / g.width);
        for (const CndLight& light : lights) {
            const glm::dvec3 to =
                glm::dvec3(light.position[0], light.position[1], light.position[2]) - position;
            const double d = glm::length(to), x = d / light.influenceRadius;
            if (x >= 1)
                continue;
            const double s = std::min(light.radius / d, 1.0);
            const double perEmission =
                light.type == CND_LIGHT_POINT ? 1 / (d * d) : std::acos(-1.0) * s * s;
            const double window = (1 - x * x * x * x) * (1 - x * x * x * x);
            const glm::dvec3 e =
                perEmission * window *
                glm::dvec3(light.emission[0], light.emission[1], light.emission[2]);
            expected += e;
            by += e.x * to / d;
            const double slope = 8 * x * x * x / ((1 - x * x * x * x) * light.influenceRadius);
            moved += e * slope * positionError * glm::length(position);
        }
        const gpu::ForwardProbeOutput& f = result.forward[i];
        for (int c = 0; c < 3; ++c)
            largest = std::max(largest, (std::abs(expected[c] - f.illuminance[c]) - moved[c]) /
                                            std::max(expected[c], 1.0));
        EXPECT_NEAR(f.illuminanceBy.x, by.x, 2e-4 * expected.x + 1e-6 + moved.x);
        peak = std::max(peak, expected.x);
    }
    EXPECT_GT(peak, 0);
    EXPECT_LE(largest,
              2e-4); // for a point a few centimetres away, whose position is single precision
}

TEST_F(ForwardTest, SetsThatAreNotThereAreNamed)
{
    const CpuGBuffer g = gbuffer(10);
    const auto own = createLighting(g, 1);
    CndError error{};
    VkDescriptorSetLayout layout{};
    VkDescriptorSet set{};
    const auto refused = [&](CndResult result) {
        EXPECT_EQ(result, CND_ERROR_INVALID_ARGUMENT);
        EXPECT_NE(std::string(error.message).find("forwardStages"), std::string::npos)
            << error.message;
    };
    refused(cndGetForwardSetLayout(own.lighting, &layout, &error));
    refused(cndGetForwardSet(own.view, 0, &set, &error));
    const CndLightingDesc desc{.structSize = sizeof desc,
                               .framesInFlight = 1,
                               .forwardStages = VK_SHADER_STAGE_GEOMETRY_BIT};
    CndLighting none{};
    refused(cndCreateLighting(&deviceDesc(), &desc, &none, &error));
    create(g, {});
    EXPECT_EQ(cndGetForwardSet(own_.view, 2, &set, &error), CND_ERROR_INVALID_ARGUMENT);
    EXPECT_NE(std::string(error.message).find("frameSlot is 2"), std::string::npos);
}

} // namespace
TEST_F(ForwardTest, FindsTheShadowsOfTheModulesOccluders)
{
    const CpuGBuffer seen = gbuffer(3);
    std::mt19937 random(1);
    std::uniform_real_distribution<float> uniform(-1, 1);
    std::vector<float> positions;
    for (int i = 0; i < 100; ++i) {
        const float x = 5 * uniform(random), y = 4 * uniform(random), z = -8 + 4 * uniform(random);
        for (int k = 0; k < 3; ++k)
            for (const float at : {x, y, z})
                positions.push_back(at + uniform(random));
    }
    const CndOccluderMesh mesh{
        .positions = positions.data(), .vertexCount = 300, .triangleCount = 100};
    for (const uint32_t points : {64u, 32u}) {
        // With 32 points one type is enough: the module makes its pipelines for each.
        const std::vector<CndLight> lights =
            points == 64 ? everyType(seen, 8) : randomSpheres(seen, 20, 7);
        create(seen, lights, false, points);
        CndOccluderInstance instance{.worldFromMesh = {1, 0, 0, 0, 0, 1, 0, 0, 0, 0, 1, 0}};
        CndOccluderId id = 0;
        CndError error{};
        ASSERT_EQ(cndAddOccluderMeshes(own_.lighting, 1, &mesh, &instance.mesh, &error),
                  CND_SUCCESS)
            << error.message;
        ASSERT_EQ(cndAddOccluders(own_.lighting, 1, &instance, &id, &error), CND_SUCCESS)
            << error.message;
        EXPECT_GT(changeByShadows(seen, lights), points == 64 ? 0.01 : 0.001);
    }
}

// The function is that of the probe.
TEST_F(ForwardTest, AsksTheRaysOfTheHost)
{
    const CpuGBuffer seen = gbuffer(3);
    auto kernels = CompiledKernels::create(
        {.functions = CND_HOST_VISIBLE_POINTS_BIT,
         .source = "uvec2 candelabraVisiblePoints(CndVisibilityQuery q)\n"
                   "{ return uvec2(0x9E3779B9u, 0x85EBCA6Bu) * (q.light + 1u); }\n",
         .lightTypes = 1u << CND_LIGHT_SPHERE,
         .shadows = VK_TRUE});
    ASSERT_TRUE(kernels) << kernels.error().message;
    const std::vector<CndLight> lights = randomSpheres(seen, 20, 7);
    create(seen, lights, false, 64, kernels.value().hostKernels({}));
    EXPECT_GT(changeByShadows(seen, lights), 0.1);
}

} // namespace candelabra::test
