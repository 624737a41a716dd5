// SPDX-License-Identifier: Apache-2.0
// Steps of the raster pass. Its C++ interface throws what the C ABI of the modules would report.
#include <array>
#include <iterator>

#include "gpu/failure.h"
#include "mock/host_steps.h"

namespace candelabra::test
{
namespace
{

constexpr uint32_t frameWidth = 64, frameHeight = 48;

// Static, so that nothing of it is allocated while the heap fails.
constexpr gbuffer::Vertex meshVertices[] = {
    {.position = {0, 0, -2}, .normal = {0, 0, 1}, .tangent = {1, 0, 0, 1}},
    {.position = {1, 0, -2}, .normal = {0, 0, 1}, .tangent = {1, 0, 0, 1}},
    {.position = {0, 1, -2}, .normal = {0, 0, 1}, .tangent = {1, 0, 0, 1}}};
constexpr uint32_t meshTriangle[] = {0, 1, 2};
constexpr uint8_t texels[4 * 4 * 4] = {};

// Creates a scene of a textured mesh, a plane and a ball.
gbuffer::Geometry makeGeometry(const gpu::Device& device)
{
    const gbuffer::Mesh mesh{meshVertices, meshTriangle};
    const gbuffer::Texture texture{.width = 4, .height = 4, .rgba = texels};
    gbuffer::Material material;
    material.baseColorTexture.texture = 0;
    gbuffer::Instance instance{};
    for (int i = 0; i < 4; ++i)
        instance.worldFromObject[5 * i] = 1;
    using Type = gbuffer::AnalyticObject::Type;
    const gbuffer::AnalyticObject objects[] = {{.type = Type::Plane},
                                               {.type = Type::Ball, .point = {0, 0, -5}}};
    return {device,
            {.meshes = {&mesh, 1},
             .materials = {&material, 1},
             .textures = {&texture, 1},
             .instances = {&instance, 1},
             .analyticObjects = objects}};
}

// Sets `count` emitters of each shape.
CndResult setEmitters(Host& h, uint32_t count, CndError* error)
{
    constexpr CndLightType types[] = {CND_LIGHT_SPHERE,         CND_LIGHT_TUBE,
                                      CND_LIGHT_RECTANGLE,      CND_LIGHT_DISC,
                                      CND_LIGHT_DISTANT_SPHERE, CND_LIGHT_POLYGON};
    static constexpr CndPolygon corners{3, {{-1, -1}, {1, -1}, {0, 1}}};
    std::array<CndLight, 120> lights;
    for (size_t i = 0; i < lights.size(); ++i)
        lights[i] = {.type = uint32_t(types[i % std::size(types)]),
                     .position = {0, 0, -3},
                     .radius = 0.1f,
                     .direction = {0, 0, -1},
                     .axisU = {1, 0, 0},
                     .axisV = {0, 1, 0},
                     .polygon = &corners};
    constexpr double origin[3] = {};
    return gpu::guard(error, [&] {
        h.raster->setEmitters({lights.data(), count * std::size(types)}, origin);
    });
}

CndResult record(Host& h, CndError*)
{
    gbuffer::FrameInputs in{.camera = MockVulkan::camera(),
                            .attachments = h.targets->attachments(),
                            .width = frameWidth,
                            .height = frameHeight};
    h.raster->record(MockVulkan::commandBuffer(), *h.geometry, in);
    return CND_SUCCESS;
}

} // namespace

const std::vector<Step>& rasterSteps()
{
    static const std::vector<Step> all = {
        {"create raster pass", false,
         [](Host& h, CndError* error) {
             return gpu::guard(error, [&] {
                 h.rasterDevice = std::make_unique<gpu::Device>(h.device, gpu::rasterPass);
                 h.raster = std::make_unique<gbuffer::GBuffer>(
                     *h.rasterDevice, gbuffer::GBufferDesc{.timestamps = true});
             });
         }},
        {"create targets", false,
         [](Host& h, CndError* error) {
             return gpu::guard(error, [&] {
                 h.targets = std::make_unique<gbuffer::Targets>(gbuffer::createTargets(
                     *h.rasterDevice, CND_GBUFFER_FULL, frameWidth, frameHeight));
             });
         }},
        {"create geometry", false,
         [](Host& h, CndError* error) {
             return gpu::guard(error, [&] {
                 auto geometry = std::make_unique<gbuffer::Geometry>(makeGeometry(*h.rasterDevice));
                 h.raster->prepare(*geometry);
                 h.geometry = std::move(geometry);
             });
         }},
        {"upload geometry", true,
         [](Host& h, CndError*) {
             h.geometry->recordUpload(MockVulkan::commandBuffer());
             return CND_SUCCESS;
         }},
        {"release staging", false,
         [](Host& h, CndError*) {
             h.geometry->releaseStaging();
             return CND_SUCCESS;
         }},
        {"set emitters", false, [](Host& h, CndError* error) { return setEmitters(h, 1, error); }},
        {"record", true, record},
        {"set more emitters", false,
         [](Host& h, CndError* error) { return setEmitters(h, 20, error); }},
        {"record more emitters", true, record},
        {"raster statistics", false,
         [](Host& h, CndError*) {
             CndKernelTime times[CND_MAX_KERNEL_TIMES];
             uint32_t count = 0;
             // times() reports only that it failed, not how.
             return h.raster->times(0, times, count) ? CND_SUCCESS : gpu::resultOf(h.vulkan.error);
         }},
    };
    return all;
}

} // namespace candelabra::test
