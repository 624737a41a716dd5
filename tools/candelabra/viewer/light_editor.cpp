// SPDX-License-Identifier: Apache-2.0
#include "viewer/light_editor.h"

#include <algorithm>
#include <array>
#include <cmath>

#include <imgui.h>

#include "scene/light_types.h"
#include "scene/polygons.h"

namespace candelabra::app
{
namespace
{

// Limits of a radius that is edited, in metres; that of a distant sphere is a sine of at most 1.
constexpr float smallestRadius = 1e-4f, largestRadius = 1e3f;
// An influence radius has to be greater than the bounding radius of the emitter.
constexpr float influenceMargin = 1.01f;

bool has(const CndLight& light, CndLightFieldBits field)
{
    return (cndLightFields(light.type) & field) != 0;
}

// Whether the light's radius is the sine of an angle.
bool isSun(const CndLight& light)
{
    return cndIsDistant(light.type) && has(light, CND_LIGHT_FIELD_RADIUS_BIT);
}

glm::vec3 toVec3(const float (&v)[3])
{
    return {v[0], v[1], v[2]};
}

void assign(float (&out)[3], const glm::vec3& v)
{
    for (int i = 0; i < 3; ++i)
        out[i] = v[i];
}

// Luminous power in lm per colour channel. Lights that are infinitely far away have none.
std::optional<glm::vec3> powerOf(const CndLight& light)
{
    float power[3];
    if (cndLuminousPowerOfLight(&light, power, nullptr) != CND_SUCCESS)
        return {};
    return glm::vec3(power[0], power[1], power[2]);
}

void setPower(CndLight& light, const std::optional<glm::vec3>& power)
{
    CndLight unit = light;
    assign(unit.emission, glm::vec3(1));
    const std::optional<glm::vec3> perUnit = powerOf(unit);
    if (power && perUnit)
        assign(light.emission, *power / *perUnit);
}

void widenInfluence(CndLight& light)
{
    light.influenceRadius =
        std::max(light.influenceRadius, cndEmitterBoundingRadius(&light) * influenceMargin);
}

CndLight* selectedLight(Scene& scene, const LightEditor& editor)
{
    return editor.selected && *editor.selected < scene.lights.size()
               ? &scene.lights[*editor.selected]
               : nullptr;
}

// Edits the direction as two angles, so that it stays a unit vector.
bool directionWidget(CndLight& light)
{
    const glm::vec3 d = glm::normalize(toVec3(light.direction));
    float angles[2] = {glm::degrees(std::atan2(d.x, d.z)),
                       glm::degrees(std::asin(std::clamp(d.y, -1.0f, 1.0f)))};
    if (!ImGui::DragFloat2("azimuth, elevation", angles, 0.5f, -180, 180, "%.1f deg"))
        return false;
    const float azimuth = glm::radians(angles[0]);
    const float elevation = glm::radians(std::clamp(angles[1], -89.9f, 89.9f));
    assign(light.direction, {std::sin(azimuth) * std::cos(elevation), std::sin(elevation),
                             std::cos(azimuth) * std::cos(elevation)});
    return true;
}

bool coneWidgets(CndLight& light)
{
    float inner = glm::degrees(light.innerConeAngle), outer = glm::degrees(light.outerConeAngle);
    if (!ImGui::DragFloatRange2("cone", &inner, &outer, 0.2f, 0, 90, "%.1f deg", nullptr,
                                ImGuiSliderFlags_AlwaysClamp))
        return false;
    outer = std::max(outer, 1.0f);
    light.outerConeAngle = glm::radians(outer);
    // The cosines of the two angles must differ.
    light.innerConeAngle = glm::radians(std::clamp(inner, 0.0f, outer - 0.5f));
    return true;
}

bool emissionWidgets(CndLight& light)
{
    const glm::vec3 emission = toVec3(light.emission);
    const float largest = std::max({emission.x, emission.y, emission.z, 1e-6f});
    glm::vec3 colour = emission / largest;
    bool edited = false;
    if (ImGui::ColorEdit3("colour", &colour.x, ImGuiColorEditFlags_Float)) {
        const float peak = std::max({colour.x, colour.y, colour.z, 1e-3f});
        assign(light.emission, glm::max(colour, 0.0f) / peak * largest);
        edited = true;
    }
    if (const std::optional<glm::vec3> power = powerOf(light)) {
        float lumens = std::max({power->x, power->y, power->z});
        if (ImGui::DragFloat("power", &lumens, std::max(lumens * 0.01f, 0.1f), 0.01f, 1e9f,
                             "%.4g lm", ImGuiSliderFlags_AlwaysClamp)) {
            assign(light.emission, toVec3(light.emission) *
                                       (lumens / std::max({power->x, power->y, power->z, 1e-6f})));
            edited = true;
        }
        return edited;
    }
    float value = largest;
    const bool sun = isSun(light);
    if (ImGui::DragFloat(sun ? "luminance" : "illuminance", &value, value * 0.01f, 1e-3f, 1e12f,
                         sun ? "%.4g cd/m^2" : "%.4g lx", ImGuiSliderFlags_AlwaysClamp)) {
        assign(light.emission, toVec3(light.emission) * (value / largest));
        edited = true;
    }
    return edited;
}

bool shapeWidgets(CndLight& light)
{
    bool edited = false;
    if (has(light, CND_LIGHT_FIELD_RADIUS_BIT)) {
        const bool sun = isSun(light);
        float radius = light.radius;
        if (ImGui::DragFloat(sun ? "sine of angular radius" : "radius", &radius,
                             std::max(radius * 0.01f, smallestRadius), smallestRadius,
                             sun ? 1.0f : largestRadius, sun ? "%.5f" : "%.4f m",
                             ImGuiSliderFlags_AlwaysClamp)) {
            changeRadius(light, radius);
            edited = true;
        }
    }
    if (has(light, CND_LIGHT_FIELD_DIRECTION_BIT))
        edited |= directionWidget(light);
    if (has(light, CND_LIGHT_FIELD_CONE_BIT))
        edited |= coneWidgets(light);
    if (has(light, CND_LIGHT_FIELD_POLYGON_BIT)) {
        int corners = int(light.polygon->cornerCount);
        if (ImGui::SliderInt("corners", &corners, 3, CND_MAX_CORNERS, "%d",
                             ImGuiSliderFlags_AlwaysClamp)) {
            changeCorners(light, uint32_t(corners));
            edited = true;
        }
    }
    if (has(light, CND_LIGHT_FIELD_TWO_SIDED_BIT)) {
        bool twoSided = light.twoSided;
        if (ImGui::Checkbox("two-sided", &twoSided)) {
            const std::optional<glm::vec3> power = powerOf(light);
            light.twoSided = twoSided;
            setPower(light, power);
            edited = true;
        }
    }
    return edited;
}

} // namespace

void addLight(Scene& scene, LightEditor& editor, const glm::dvec3& position, const NewLight& made)
{
    CndLight light{.type = CND_LIGHT_SPHERE,
                   .radius = std::clamp(made.radius, smallestRadius, largestRadius),
                   .influenceRadius = made.influenceRadius};
    assign(light.position, glm::vec3(position - scene.lightOrigin));
    light.direction[1] = -1;
    assign(light.emission, glm::vec3(cndSphereLuminanceFromPower(made.power, light.radius)));
    widenInfluence(light);
    scene.lights.push_back(light);
    if (!scene.lightMotions.empty())
        scene.lightMotions.emplace_back();
    editor.selected = uint32_t(scene.lights.size()) - 1;
    editor.changed = true;
}

void removeLight(Scene& scene, LightEditor& editor)
{
    if (!selectedLight(scene, editor))
        return;
    const auto at = std::ptrdiff_t(*editor.selected);
    scene.lights.erase(scene.lights.begin() + at);
    if (!scene.lightMotions.empty())
        scene.lightMotions.erase(scene.lightMotions.begin() + at);
    editor.selected.reset();
    editor.changed = true;
}

void selectLight(const Scene& scene, LightEditor& editor, int step)
{
    const int64_t count = int64_t(scene.lights.size());
    if (!count)
        return;
    const int64_t from = editor.selected ? int64_t(*editor.selected) : step > 0 ? -1 : count;
    editor.selected = uint32_t(((from + step) % count + count) % count);
}

void moveLight(Scene& scene, LightEditor& editor, const glm::vec3& metres)
{
    CndLight* light = selectedLight(scene, editor);
    if (!light || cndIsDistant(light->type))
        return;
    assign(light->position, toVec3(light->position) + metres);
    editor.changed = true;
}

void scaleLightRadius(Scene& scene, LightEditor& editor, float factor)
{
    CndLight* light = selectedLight(scene, editor);
    if (!light || !has(*light, CND_LIGHT_FIELD_RADIUS_BIT))
        return;
    changeRadius(*light, light->radius * factor);
    editor.changed = true;
}

void changeRadius(CndLight& light, float radius)
{
    const bool sun = isSun(light);
    const std::optional<glm::vec3> power = powerOf(light);
    const float old = light.radius;
    light.radius = std::clamp(radius, smallestRadius, sun ? 1.0f : largestRadius);
    setPower(light, power);
    if (sun) // keeps the illuminance
        assign(light.emission,
               toVec3(light.emission) * (old / light.radius) * (old / light.radius));
    widenInfluence(light);
}

void changeCorners(CndLight& light, uint32_t corners)
{
    const std::optional<glm::vec3> power = powerOf(light);
    light.polygon = regularPolygon(corners);
    setPower(light, power);
    widenInfluence(light);
}

void changeType(CndLight& light, CndLightType type)
{
    const std::optional<glm::vec3> power = powerOf(light);
    const glm::vec3 emission = toVec3(light.emission);
    const glm::vec3 colour = emission / std::max({emission.x, emission.y, emission.z, 1e-6f});
    light.type = type;
    light.radius = isSun(light) ? CND_SUN_SINE : std::clamp(light.radius, 0.02f, 1.0f);
    if (glm::length(toVec3(light.direction)) < 0.5f)
        assign(light.direction, {0, -1, 0});
    assign(light.axisU, {0.5f, 0, 0});
    assign(light.axisV, {0, 0, 0.3f}); // the rectangle faces down, along axisU x axisV
    light.polygon = lightTypeInfo(type).lamp.polygon;
    light.innerConeAngle = 0.3f;
    light.outerConeAngle = 0.6f;
    if (!(light.influenceRadius > 0))
        light.influenceRadius = 12;
    constexpr float noon = 20'000; // lx
    assign(light.emission, colour * noon);
    if (isSun(light))
        assign(light.emission, colour * (noon / (3.14159265f * light.radius * light.radius)));
    setPower(light, power ? power : std::optional(colour * 1500.0f));
    widenInfluence(light);
}

void drawLightEditor(Scene& scene, LightEditor& editor)
{
    if (ImGui::SmallButton("<"))
        selectLight(scene, editor, -1);
    ImGui::SameLine();
    if (ImGui::SmallButton(">"))
        selectLight(scene, editor, 1);
    ImGui::SameLine();
    CndLight* light = selectedLight(scene, editor);
    if (!light) {
        ImGui::TextUnformatted("no light selected: Tab selects, N adds one");
        return;
    }
    ImGui::Text("light %u", *editor.selected);
    ImGui::SameLine();
    if (ImGui::SmallButton("remove")) {
        removeLight(scene, editor);
        return;
    }
    bool edited = false;
    if (ImGui::BeginCombo("type", lightTypeLabel(light->type).c_str())) {
        for (uint32_t i = 0; i < CND_LIGHT_TYPE_COUNT; ++i)
            if (ImGui::Selectable(lightTypeLabel(i).c_str(), light->type == i)) {
                changeType(*light, CndLightType(i));
                edited = true;
            }
        ImGui::EndCombo();
    }
    if (!cndIsDistant(light->type)) {
        edited |= ImGui::DragFloat3("position", light->position, 0.02f, 0, 0, "%.2f m");
        edited |=
            ImGui::DragFloat("influence", &light->influenceRadius, 0.05f,
                             std::max(cndEmitterBoundingRadius(light) * influenceMargin, 0.01f),
                             1e6f, "%.2f m", ImGuiSliderFlags_AlwaysClamp);
    }
    edited |= shapeWidgets(*light);
    edited |= emissionWidgets(*light);
    editor.changed |= edited;
}

} // namespace candelabra::app
