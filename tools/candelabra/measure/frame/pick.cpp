// SPDX-License-Identifier: Apache-2.0
#include "measure/frame/pick.h"

#include <algorithm>
#include <cstring>

#include <fmt/format.h>

#include "io/table.h"
#include "measure/frame/surfaces.h"
#include "reference/joining.h"
#include "reference/light.h"
#include "reference/truth.h"
#include "render/frame_ring.h"
#include "render/readback.h"
#include "scene/light_types.h"

namespace candelabra::app
{
namespace
{

constexpr double pickTolerance = 1e-6;                         // relative, of a light's truth
constexpr glm::dvec3 luminanceWeights(0.2126, 0.7152, 0.0722); // Rec.709

glm::dvec3 readPixel(const VulkanContext& context, const Renderer& renderer, VkImageLayout layout,
                     PixelPosition pixel)
{
    const std::vector<uint8_t> bytes =
        readTexels(context, renderer.radiance(), VK_IMAGE_ASPECT_COLOR_BIT, layout,
                   {{int32_t(pixel.x), int32_t(pixel.y)}, {1, 1}}, sizeof(glm::vec4));
    glm::vec4 out;
    std::memcpy(&out, bytes.data(), sizeof out);
    return glm::dvec3(out);
}

glm::dvec3 truthOf(const SeenSurface& seen, const CndLight& light, const Scene& scene,
                   CndSpecularMethod method)
{
    const reference::Material material =
        reference::joinLobes(seen.material, glm::dot(seen.point.normal, seen.point.toEye),
                             scene.lobes, scene.energyCompensation);
    if (cndIsPunctual(light.type))
        return reference::outgoingLuminance(seen.point, material, light, scene.lightOrigin, method);
    return reference::truthLuminance(seen.point, material, light, scene.lightOrigin, pickTolerance)
        .luminance;
}

} // namespace

double luminanceOf(const glm::dvec3& radiance)
{
    return glm::dot(radiance, luminanceWeights);
}

glm::dvec3 Pick::sum() const
{
    glm::dvec3 out = unlit;
    for (const PickedLight& light : lights)
        out += light.radiance;
    return out;
}

std::string pickRefusal(CndSpecularMethod specular, CndInfluenceRule influence)
{
    if (specular == CND_SPECULAR_SAMPLED)
        return "the sampled method draws other samples for a light alone";
    if (influence != CND_INFLUENCE_GIVEN)
        return "lights are shown with the radii that they are given, which this frame does not use";
    return "";
}

Pick pickPixel(const VulkanContext& context, Renderer& renderer, const Scene& scene,
               const FrameOptions& frame, PixelPosition pixel)
{
    Pick out{.pixel = pixel};
    FrameOptions options = frame;
    options.reuse = Reuse::None;
    {
        FrameRing ring(context, 1);
        const auto [cmd, slot, reused] = ring.begin();
        renderer.record(cmd, slot, options);
        ring.submit();
        ring.wait();
    }
    out.radiance = readPixel(context, renderer, VK_IMAGE_LAYOUT_TRANSFER_SRC_OPTIMAL, pixel);
    context.submitAndWait([&](VkCommandBuffer cmd) { renderer.recordUnlit(cmd, options); });
    out.unlit = readPixel(context, renderer, VK_IMAGE_LAYOUT_GENERAL, pixel);
    const auto seen = Surfaces(context, renderer, options).at(pixel.x, pixel.y);
    if (!seen)
        return out;
    out.surface = true;
    out.position = seen->point.position;

    std::vector<CndLight> lights;
    lightsAtTime(scene, frame.time, lights);
    const VkRect2D rect{{int32_t(pixel.x), int32_t(pixel.y)}, {1, 1}};
    for (uint32_t i = 0; i < lights.size(); ++i) {
        const CndLight& light = lights[i];
        const glm::dvec3 centre =
            scene.lightOrigin + glm::dvec3(light.position[0], light.position[1], light.position[2]);
        const double distance =
            cndIsDistant(light.type) ? 0 : glm::length(centre - seen->point.position);
        // The margin of 0.1% keeps every light that the device, which rounds the distance, lets
        // contribute.
        if (distance > double(light.influenceRadius) * 1.001 && !cndIsDistant(light.type))
            continue;
        renderer.setLights({light});
        context.submitAndWait([&](VkCommandBuffer cmd) {
            renderer.recordBlack(cmd);
            renderer.recordBruteRect(cmd, options, rect);
        });
        const glm::dvec3 radiance = readPixel(context, renderer, VK_IMAGE_LAYOUT_GENERAL, pixel);
        if (radiance != glm::dvec3(0))
            out.lights.push_back(
                {i, distance, radiance, truthOf(*seen, light, scene, frame.specular)});
    }
    renderer.setLights(lights);
    std::stable_sort(out.lights.begin(), out.lights.end(),
                     [](const PickedLight& a, const PickedLight& b) {
                         return luminanceOf(a.radiance) > luminanceOf(b.radiance);
                     });
    return out;
}

std::string pickText(const Pick& pick, const Scene& scene)
{
    const double all = luminanceOf(pick.radiance);
    const auto shareOf = [&](const glm::dvec3& radiance) {
        return all > 0 ? fmt::format("{:.2f}%", 100 * luminanceOf(radiance) / all) : "";
    };
    std::string out = fmt::format("pixel {},{}", pick.pixel.x, pick.pixel.y);
    if (!pick.surface)
        return out + fmt::format(" shows no surface; luminance {} cd/m^2\n", threeDigits(all));
    out += fmt::format(" at ({:.3f}, {:.3f}, {:.3f}) m, {}\n", pick.position.x, pick.position.y,
                       pick.position.z, counted(pick.lights.size(), "light"));
    Table table({"light", "type", "distance m", "cd/m^2", "share", "truth", "error"});
    glm::dvec3 truth = pick.unlit;
    const auto add = [&](const std::string& name, const std::string& type,
                         const std::string& distance, const glm::dvec3& radiance,
                         const glm::dvec3& exact) {
        const double y = luminanceOf(radiance), of = luminanceOf(exact);
        table.add({name, type, distance, fmt::format("{:.6g}", y), shareOf(radiance),
                   fmt::format("{:.6g}", of),
                   of > 0 ? fmt::format("{:+.3f}%", 100 * (y - of) / of) : ""});
    };
    for (const PickedLight& light : pick.lights) {
        const uint32_t type = scene.lights[light.light].type;
        add(fmt::format("{}", light.light), lightTypeName(type),
            light.distance > 0 ? threeDigits(light.distance) : "", light.radiance, light.truth);
        truth += light.truth;
    }
    table.rule();
    add("without lights", "", "", pick.unlit, pick.unlit);
    add("sum", "", "", pick.sum(), truth);
    out += table.text();
    const glm::dvec3 difference = glm::abs(pick.sum() - pick.radiance);
    return out + fmt::format("the pixel: {:.6g} cd/m^2; the sum differs by {:.1e}\n", all,
                             std::max({difference.x, difference.y, difference.z}));
}

Json toJson(const Pick& pick, const Scene& scene)
{
    const auto json = [](const glm::dvec3& v) { return Json{v.x, v.y, v.z}; };
    Json lights = Json::array();
    for (const PickedLight& light : pick.lights)
        lights.push_back({{"light", light.light},
                          {"type", lightTypeName(scene.lights[light.light].type)},
                          {"distance", light.distance},
                          {"radiance", json(light.radiance)},
                          {"truth", json(light.truth)}});
    return {{"x", pick.pixel.x},
            {"y", pick.pixel.y},
            {"surface", pick.surface},
            {"position", json(pick.position)},
            {"radiance", json(pick.radiance)},
            {"unlit", json(pick.unlit)},
            {"sum", json(pick.sum())},
            {"lights", lights}};
}

} // namespace candelabra::app
