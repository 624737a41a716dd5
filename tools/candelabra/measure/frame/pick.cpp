// SPDX-License-Identifier: Apache-2.0
#include "measure/frame/pick.h"

#include <algorithm>
#include <bitset>
#include <cmath>
#include <cstring>
#include <limits>
#include <map>

#include <fmt/format.h>

#include "candelabra/glm.hpp"
#include "io/table.h"
#include "measure/frame/surfaces.h"
#include "reference/emitter_points.h"
#include "reference/joining.h"
#include "reference/light.h"
#include "reference/truth.h"
#include "reference/visibility.h"
#include "render/readback.h"
#include "scene/light_types.h"
#include "truth/reference_scene.h"

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

reference::Material joinedMaterial(const SeenSurface& seen, const Scene& scene)
{
    return reference::joinLobes(seen.material, glm::dot(seen.point.normal, seen.point.toEye),
                                scene.lobes, scene.energyCompensation);
}

reference::Material diffuseLobe(reference::Material material)
{
    material.f0 = glm::dvec3(0);
    material.specularWeight = 0;
    return material;
}

reference::Material specularLobe(reference::Material material)
{
    material.diffuseAlbedo = glm::dvec3(0);
    return material;
}

glm::dvec3 truthOf(const SeenSurface& seen, const reference::Material& material,
                   const CndLight& light, const Scene& scene, CndSpecularMethod method)
{
    if (cndIsPunctual(light.type))
        return reference::outgoingLuminance(seen.point, material, light, scene.lightOrigin, method);
    return reference::truthLuminance(seen.point, material, light, scene.lightOrigin, pickTolerance)
        .luminance;
}

// What the reference knows about the visibility of lights at one surface.
class ShadowsOfPixel
{
public:
    ShadowsOfPixel(const Scene& scene, const Camera& camera, PixelSize size, PixelPosition pixel,
                   const SeenSurface& seen)
        : scene_(scene),
          model_(toReference(scene, camera, double(size.width) / size.height, false, &instances_)),
          occluders_(model_.objects, model_.triangles),
          surface_(seen.point),
          material_(joinedMaterial(seen, scene))
    {
        // Positions from depths are rounded, and may be below the surface, which would hide all.
        constexpr double nearby = 1e-3;
        const double distance = glm::distance(model_.camera.position, surface_.position);
        const auto hit = reference::tracePixel(model_, size.width, size.height, pixel.x, pixel.y);
        if (hit && glm::distance(hit->surface.position, surface_.position) <= nearby * distance)
            surface_.position = hit->surface.position;
        else // a level of detail
            surface_.position += nearby * distance * surface_.normal;
    }

    void lookAt(const CndLight& light, PickedLight& out) const
    {
        const uint32_t ignored = light.unshadowed ? ~0u : light.unshadowedBy;
        out.visibleDiffuse = visibleShare(light, ignored, diffuseLobe(material_));
        out.visibleSpecular = visibleShare(light, ignored, specularLobe(material_));
        out.occluders = occludersOf(light, ignored);
    }

private:
    double visibleShare(const CndLight& light, uint32_t ignored,
                        const reference::Material& lobe) const
    {
        glm::dvec3 all(0), visible(0);
        reference::LightsOfPixel lights{.lights = {&light, 1},
                                        .ignoredLayers = {&ignored, 1},
                                        .lightOrigin = scene_.lightOrigin,
                                        .relative = pickTolerance};
        reference::addLights(lights, surface_, lobe, all);
        lights.occluders = &occluders_;
        reference::addLights(lights, surface_, lobe, visible);
        return luminanceOf(all) > 0 ? luminanceOf(visible) / luminanceOf(all)
                                    : std::numeric_limits<double>::quiet_NaN();
    }

    std::vector<PickedOccluder> occludersOf(const CndLight& light, uint32_t ignored) const
    {
        constexpr size_t side = 16;
        using Points = std::bitset<side * side>;
        const reference::EmitterPoints emitter(light, scene_.lightOrigin, surface_.position);
        if (emitter.contain())
            return {};
        std::vector<uint32_t> found;
        occluders_.collect(emitter.shaft(), ignored, std::numeric_limits<size_t>::max(), found);
        std::map<std::string, Points> hidden;
        size_t count = 0;
        for (size_t i = 0; i < side * side; ++i) {
            const auto point =
                emitter.at((double(i % side) + 0.5) / side, (double(i / side) + 0.5) / side);
            if (!(point.density > 0 && glm::dot(surface_.normal, point.direction) > 0))
                continue;
            ++count;
            const bool distant = std::isinf(point.distance);
            const reference::LightRay ray{.origin = surface_.position,
                                          .direction = distant ? point.direction
                                                               : point.distance * point.direction,
                                          .end = distant ? point.distance : 1 / (1 + 0x1p-12),
                                          .ignoredLayers = ignored};
            for (const uint32_t& occluder : found)
                if (occluders_.stop(ray, {&occluder, 1}))
                    hidden[nameOf(occluder)].set(i);
        }
        std::vector<PickedOccluder> out;
        for (const auto& [name, points] : hidden)
            out.push_back({name, double(points.count()) / double(count)});
        std::ranges::stable_sort(out, std::ranges::greater(), &PickedOccluder::share);
        return out;
    }

    // The name of the smallest named node that holds the instance, and the number of the instance.
    std::string nameOf(uint32_t occluder) const
    {
        if (occluder >= model_.triangles.size())
            return fmt::format("object {}", occluder - model_.triangles.size());
        const uint32_t instance = instances_[occluder];
        const SceneNode* node = nullptr;
        for (const SceneNode& n : scene_.nodes)
            if (!n.name.empty() && instance >= n.instances.first &&
                instance < n.instances.first + n.instances.count &&
                (!node || n.instances.count < node->instances.count))
                node = &n;
        return node ? fmt::format("{} (instance {})", node->name, instance)
                    : fmt::format("instance {}", instance);
    }

    const Scene& scene_;
    std::vector<uint32_t> instances_; // of the triangles of model_
    reference::Scene model_;
    reference::Occluders occluders_;
    reference::SurfacePoint surface_;
    reference::Material material_;
};

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

std::string pickRefusal(const FrameOptions& frame)
{
    if (frame.specular == CND_SPECULAR_SAMPLED)
        return "the sampled method draws other samples for a light alone";
    if (frame.influence.rule != CND_INFLUENCE_GIVEN)
        return "lights are shown with the radii that they are given, which this frame does not use";
    return "";
}

Pick pickPixel(const VulkanContext& context, Renderer& renderer, const Scene& scene,
               const FrameOptions& frame, PixelPosition pixel)
{
    Pick out{.pixel = pixel};
    FrameOptions options = frame;
    options.reuse = Reuse::None;
    context.submitAndWait([&](VkCommandBuffer cmd) { renderer.record(cmd, 0, options); });
    out.radiance = readPixel(context, renderer, VK_IMAGE_LAYOUT_TRANSFER_SRC_OPTIMAL, pixel);
    context.submitAndWait([&](VkCommandBuffer cmd) { renderer.recordUnlit(cmd, options); });
    out.unlit = readPixel(context, renderer, VK_IMAGE_LAYOUT_GENERAL, pixel);
    const auto seen = Surfaces(context, renderer, options).at(pixel.x, pixel.y);
    if (!seen)
        return out;
    out.surface = true;
    out.position = seen->point.position;
    out.shadows = frame.shadows > 0;
    std::optional<ShadowsOfPixel> shadows;
    if (out.shadows)
        shadows.emplace(scene, frame.camera, renderer.size(), pixel, *seen);
    const reference::Material material = joinedMaterial(*seen, scene);
    const auto truth = [&](const reference::Material& lobes, const CndLight& light) {
        return truthOf(*seen, lobes, light, scene, frame.specular);
    };

    std::vector<CndLight> lights;
    lightsAtTime(scene, frame.time, lights);
    const VkRect2D rect{{int32_t(pixel.x), int32_t(pixel.y)}, {1, 1}};
    for (uint32_t i = 0; i < lights.size(); ++i) {
        const CndLight& light = lights[i];
        const glm::dvec3 centre = scene.lightOrigin + glm::dvec3(toGlm(light.position));
        const double distance =
            cndIsDistant(light.type) ? 0 : glm::length(centre - seen->point.position);
        // The margin of 0.1% keeps every light that the device, which rounds the distance, lets
        // contribute.
        if (distance > double(light.influenceRadius) * 1.001 && !cndIsDistant(light.type))
            continue;
        renderer.setLights({light});
        const auto draw = [&](uint32_t points) {
            FrameOptions alone = options;
            alone.shadows = points;
            context.submitAndWait([&](VkCommandBuffer cmd) {
                renderer.recordBlack(cmd);
                renderer.recordBruteRect(cmd, alone, rect);
            });
            return readPixel(context, renderer, VK_IMAGE_LAYOUT_GENERAL, pixel);
        };
        PickedLight picked{.light = i, .distance = distance, .unshadowed = draw(0)};
        if (picked.unshadowed == glm::dvec3(0))
            continue;
        if (shadows) {
            picked.radiance = draw(options.shadows);
            shadows->lookAt(light, picked);
            if (picked.visibleDiffuse > 0)
                picked.truth += picked.visibleDiffuse * truth(diffuseLobe(material), light);
            if (picked.visibleSpecular > 0)
                picked.truth += picked.visibleSpecular * truth(specularLobe(material), light);
        } else {
            picked.radiance = picked.unshadowed;
            picked.truth = truth(material, light);
        }
        out.lights.push_back(picked);
    }
    renderer.setLights(lights);
    std::ranges::stable_sort(out.lights, [](const PickedLight& a, const PickedLight& b) {
        const double la = luminanceOf(a.radiance), lb = luminanceOf(b.radiance);
        return la != lb ? la > lb : luminanceOf(a.unshadowed) > luminanceOf(b.unshadowed);
    });
    return out;
}

namespace
{

std::string occludersText(const std::vector<PickedOccluder>& occluders)
{
    constexpr size_t most = 2;
    std::string out;
    for (size_t i = 0; i < std::min(most, occluders.size()); ++i)
        out +=
            fmt::format("{}{} {:.0f}%", i ? ", " : "", occluders[i].name, 100 * occluders[i].share);
    return out;
}

} // namespace

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
    std::vector<Column> columns{"light", "type", "distance m", "cd/m^2", "share", "truth", "error"};
    if (pick.shadows)
        columns.insert(columns.end(), {"V diffuse", "V specular", Column::words("hidden most by")});
    Table table(columns);
    glm::dvec3 truth = pick.unlit;
    const auto add = [&](const std::string& name, const std::string& type,
                         const std::string& distance, const glm::dvec3& radiance,
                         const glm::dvec3& exact, const PickedLight* light = nullptr) {
        const double y = luminanceOf(radiance), of = luminanceOf(exact);
        const double percent = 100 * (y - of) / of;
        const double error = std::abs(percent) < 0.0005 ? 0 : percent; // instead of "-0.000%"
        std::vector<std::string> cells{name,
                                       type,
                                       distance,
                                       fmt::format("{:.6g}", y),
                                       shareOf(radiance),
                                       fmt::format("{:.6g}", of),
                                       of > 0 ? fmt::format("{:+.3f}%", error) : ""};
        if (pick.shadows) {
            const auto shown = [&](double v) {
                return light && !std::isnan(v) ? fmt::format("{:.4f}", v) : "";
            };
            cells.push_back(shown(light ? light->visibleDiffuse : 0));
            cells.push_back(shown(light ? light->visibleSpecular : 0));
            cells.push_back(light ? occludersText(light->occluders) : "");
        }
        table.add(cells);
    };
    for (const PickedLight& light : pick.lights) {
        const uint32_t type = scene.lights[light.light].type;
        add(fmt::format("{}", light.light), lightTypeName(type),
            light.distance > 0 ? threeDigits(light.distance) : "", light.radiance, light.truth,
            &light);
        truth += light.truth;
    }
    table.rule();
    add("without lights", "", "", pick.unlit, pick.unlit);
    add("sum", "", "", pick.sum(), truth);
    if (pick.shadows)
        table.note("V is the visible share of each lobe, by the reference in double precision; "
                   "shares of what hides a light are those of 256 points of it.");
    out += table.text();
    const glm::dvec3 difference = glm::abs(pick.sum() - pick.radiance);
    return out + fmt::format("the pixel: {:.6g} cd/m^2; the sum differs by {:.1e}\n", all,
                             std::max({difference.x, difference.y, difference.z}));
}

Json toJson(const Pick& pick, const Scene& scene)
{
    const auto json = [](const glm::dvec3& v) { return Json{v.x, v.y, v.z}; };
    Json lights = Json::array();
    for (const PickedLight& light : pick.lights) {
        lights.push_back({{"light", light.light},
                          {"type", lightTypeName(scene.lights[light.light].type)},
                          {"distance", light.distance},
                          {"radiance", json(light.radiance)},
                          {"truth", json(light.truth)}});
        if (!pick.shadows)
            continue;
        Json occluders = Json::array();
        for (const PickedOccluder& occluder : light.occluders)
            occluders.push_back({{"name", occluder.name}, {"share", occluder.share}});
        lights.back()["shadows"] = {{"unshadowedRadiance", json(light.unshadowed)},
                                    {"visibleDiffuse", light.visibleDiffuse},
                                    {"visibleSpecular", light.visibleSpecular},
                                    {"occluders", occluders}};
    }
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
