// SPDX-License-Identifier: Apache-2.0
#include "viewer/light_editor.h"

#include <algorithm>
#include <cmath>
#include <cstring>

#include <imgui.h>
#include <imgui_internal.h> // whether a number is typed

#include "io/table.h"
#include "scene/cone.h"
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

bool hasField(const CndLight& light, CndLightFieldBits field)
{
    return (cndLightFields(light.type) & field) != 0;
}

// Tells whether the light's radius is the sine of an angle.
bool isSun(const CndLight& light)
{
    return cndIsDistant(light.type) && hasField(light, CND_LIGHT_FIELD_RADIUS_BIT);
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

// Tells everyone that the selected light was changed.
void changed(LightEditor& editor, const CndLight& before, const CndLight& after)
{
    editor.history.add({.light = *editor.selected, .before = before, .after = after});
    editor.changed = true;
}

void append(Scene& scene, LightEditor& editor, const CndLight& light, const LightMotion& motion)
{
    scene.lights.push_back(light);
    if (!scene.lightMotions.empty())
        scene.lightMotions.push_back(motion);
    editor.selected = uint32_t(scene.lights.size()) - 1;
    editor.history.beginStep();
    LightEdit edit{.light = *editor.selected, .after = light};
    if (!scene.lightMotions.empty())
        edit.motion = motion;
    editor.history.add(edit);
    editor.changed = true;
}

// Returns what an edit did to its light.
std::string described(const LightEdit& edit)
{
    const std::string light = "light " + std::to_string(edit.light);
    if (!edit.before)
        return light + " added";
    if (!edit.after)
        return light + " removed";
    const CndLight &a = *edit.before, &b = *edit.after;
    const auto differ = [](const auto& x, const auto& y) {
        return std::memcmp(&x, &y, sizeof x) != 0;
    };
    return light + (a.type != b.type                         ? " has another type"
                    : differ(a.position, b.position)         ? " moved"
                    : a.radius != b.radius                   ? " has another size"
                    : a.influenceRadius != b.influenceRadius ? " has another influence radius"
                    : differ(a.direction, b.direction)       ? " turned"
                    : differ(a.emission, b.emission)         ? " has another brightness or colour"
                                                             : " has another shape");
}

// Selects the light of an edit that has been made, if it is still there.
void selectEdited(LightEditor& editor, const LightEdit& edit)
{
    editor.selected.reset();
    if (edit.after)
        editor.selected = edit.light;
    editor.changed = true;
}

// Edits the direction as two angles, so that it stays a unit vector.
bool directionWidget(CndLight& light)
{
    const glm::vec3 d = glm::normalize(toVec3(light.direction));
    float angles[2] = {glm::degrees(std::atan2(d.x, d.z)),
                       glm::degrees(std::asin(std::clamp(d.y, -1.0f, 1.0f)))};
    const bool edited = ImGui::DragFloat2("direction, deg", angles, 0.5f, -180, 180, "%.1f");
    if (ImGui::IsItemHovered())
        ImGui::SetTooltip("azimuth from +z towards +x, and elevation");
    if (!edited)
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
    outer = std::max(outer, 0.1f);
    setCone(glm::radians(double(inner)), glm::radians(double(outer)), light);
    return true;
}

// A number that can be dragged, written with commas as people do. While it is typed, it has digits
// alone, which can be read back.
bool dragNumber(const char* label, float& value, float lowest, float highest,
                const std::string& unit)
{
    const ImGuiIO& io = ImGui::GetIO();
    const bool typed =
        ImGui::TempInputIsActive(ImGui::GetID(label)) || io.KeyCtrl || io.MouseDoubleClicked[0];
    const std::string format = (typed ? "%.9g" : groupedOrThreeDigits(double(value))) + unit;
    return ImGui::DragFloat(label, &value, std::max(value * 0.01f, 1e-3f), lowest, highest,
                            format.c_str(), ImGuiSliderFlags_AlwaysClamp);
}

// Edits the luminous power, which is `lumens` now, in lm or in W.
bool powerWidget(CndLight& light, float lumens, bool& watts)
{
    const float perUnit = watts ? cndLuminousPowerFromWatts(1) : 1;
    const float widget = ImGui::CalcItemWidth(), unit = 4 * ImGui::GetFontSize();
    float value = lumens / perUnit;
    ImGui::SetNextItemWidth(widget - unit - ImGui::GetStyle().ItemInnerSpacing.x);
    const bool edited = dragNumber("##power", value, 1e-5f, 1e9f, "");
    if (edited)
        assign(light.emission,
               toVec3(light.emission) * (value * perUnit / std::max(lumens, 1e-6f)));
    ImGui::SameLine(0, ImGui::GetStyle().ItemInnerSpacing.x);
    ImGui::SetNextItemWidth(unit);
    if (ImGui::BeginCombo("power", watts ? "W" : "lm")) {
        if (ImGui::Selectable("lm", !watts))
            watts = false;
        if (ImGui::Selectable("W, as light of 555 nm (683 lm/W)", watts))
            watts = true;
        ImGui::EndCombo();
    }
    return edited;
}

bool emissionWidgets(CndLight& light, bool& watts)
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
    if (const std::optional<glm::vec3> power = powerOf(light))
        edited |= powerWidget(light, std::max({power->x, power->y, power->z}), watts);
    float value = largest;
    const char* unit =
        cndIsPunctual(light.type) ? cndIsDistant(light.type) ? "lx" : "cd" : "cd/m^2";
    const char* name = cndIsPunctual(light.type)
                           ? cndIsDistant(light.type) ? "illuminance" : "intensity"
                           : "luminance";
    if (dragNumber(name, value, 1e-3f, 1e12f, std::string(" ") + unit)) {
        assign(light.emission, toVec3(light.emission) * (value / largest));
        edited = true;
    }
    return edited;
}

bool shapeWidgets(CndLight& light)
{
    bool edited = false;
    if (hasField(light, CND_LIGHT_FIELD_RADIUS_BIT)) {
        const bool sun = isSun(light);
        float radius = light.radius;
        if (ImGui::DragFloat(sun ? "sine of radius" : "radius", &radius,
                             std::max(radius * 0.01f, smallestRadius), smallestRadius,
                             sun ? 1.0f : largestRadius, sun ? "%.5f" : "%.4f m",
                             ImGuiSliderFlags_AlwaysClamp)) {
            changeRadius(light, radius);
            edited = true;
        }
    }
    if (hasField(light, CND_LIGHT_FIELD_DIRECTION_BIT))
        edited |= directionWidget(light);
    if (hasField(light, CND_LIGHT_FIELD_CONE_BIT))
        edited |= coneWidgets(light);
    if (hasField(light, CND_LIGHT_FIELD_POLYGON_BIT)) {
        int corners = int(light.polygon->cornerCount);
        if (ImGui::SliderInt("corners", &corners, 3, CND_MAX_CORNERS, "%d",
                             ImGuiSliderFlags_AlwaysClamp)) {
            changeCorners(light, uint32_t(corners));
            edited = true;
        }
    }
    if (hasField(light, CND_LIGHT_FIELD_TWO_SIDED_BIT)) {
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
    append(scene, editor, light, {});
}

void duplicateLight(Scene& scene, LightEditor& editor)
{
    const CndLight* light = selectedLight(scene, editor);
    if (!light)
        return;
    CndLight copy = *light;
    if (!cndIsDistant(copy.type)) // far enough to see two, near enough to see both
        copy.position[0] += std::max(3 * cndEmitterBoundingRadius(&copy), 0.3f);
    append(scene, editor, copy,
           scene.lightMotions.empty() ? LightMotion{} : scene.lightMotions[*editor.selected]);
}

void removeLight(Scene& scene, LightEditor& editor)
{
    if (!selectedLight(scene, editor))
        return;
    const auto at = std::ptrdiff_t(*editor.selected);
    LightEdit edit{.light = *editor.selected, .before = scene.lights[*editor.selected]};
    if (!scene.lightMotions.empty())
        edit.motion = scene.lightMotions[*editor.selected];
    editor.history.beginStep();
    editor.history.add(edit);
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

bool moveLight(Scene& scene, LightEditor& editor, const glm::vec3& metres)
{
    CndLight* light = selectedLight(scene, editor);
    if (!light || cndIsDistant(light->type))
        return false;
    const CndLight before = *light;
    assign(light->position, toVec3(light->position) + metres);
    changed(editor, before, *light);
    return true;
}

bool scaleLightRadius(Scene& scene, LightEditor& editor, float factor)
{
    CndLight* light = selectedLight(scene, editor);
    if (!light || !hasField(*light, CND_LIGHT_FIELD_RADIUS_BIT))
        return false;
    const CndLight before = *light;
    changeRadius(*light, light->radius * factor);
    changed(editor, before, *light);
    return true;
}

std::string undoEdit(Scene& scene, LightEditor& editor)
{
    if (!editor.history.canUndo())
        return "there is no edit to undo";
    LightEdit edit = editor.history.undo(scene);
    selectEdited(editor, edit);
    std::swap(edit.before, edit.after); // what was undone, not what was made of it
    return "undone: " + described(edit);
}

std::string redoEdit(Scene& scene, LightEditor& editor)
{
    if (!editor.history.canRedo())
        return "there is no edit to redo";
    const LightEdit edit = editor.history.redo(scene);
    selectEdited(editor, edit);
    return "redone: " + described(edit);
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

namespace
{

bool button(const char* label, bool possible)
{
    ImGui::BeginDisabled(!possible);
    const bool pressed = ImGui::SmallButton(label);
    ImGui::EndDisabled();
    return pressed && possible;
}

void editorButtons(Scene& scene, LightEditor& editor)
{
    if (button("add", true))
        editor.wantsNew = true;
    ImGui::SameLine();
    const bool some = selectedLight(scene, editor) != nullptr;
    if (button("duplicate", some))
        duplicateLight(scene, editor);
    ImGui::SameLine();
    if (button("remove", some))
        removeLight(scene, editor);
    ImGui::SameLine();
    if (button("undo", editor.history.canUndo()))
        undoEdit(scene, editor);
    ImGui::SameLine();
    if (button("redo", editor.history.canRedo()))
        redoEdit(scene, editor);
    if (button("<", !scene.lights.empty()))
        selectLight(scene, editor, -1);
    ImGui::SameLine();
    if (button(">", !scene.lights.empty()))
        selectLight(scene, editor, 1);
    ImGui::SameLine();
}

bool lightWidgets(CndLight& light, bool& watts)
{
    bool edited = false;
    if (ImGui::BeginCombo("type", lightTypeLabel(light.type).c_str())) {
        for (uint32_t i = 0; i < CND_LIGHT_TYPE_COUNT; ++i)
            if (ImGui::Selectable(lightTypeLabel(i).c_str(), light.type == i) && light.type != i) {
                changeType(light, CndLightType(i));
                edited = true;
            }
        ImGui::EndCombo();
    }
    edited |= emissionWidgets(light, watts);
    if (!cndIsDistant(light.type))
        edited |= ImGui::DragFloat3("position, m", light.position, 0.02f, -1e7f, 1e7f, "%.2f",
                                    ImGuiSliderFlags_AlwaysClamp);
    edited |= shapeWidgets(light);
    if (!cndIsDistant(light.type))
        edited |= dragNumber("influence radius", light.influenceRadius,
                             std::max(cndEmitterBoundingRadius(&light) * influenceMargin, 0.01f),
                             1e6f, " m");
    return edited;
}

} // namespace

void drawLightEditor(Scene& scene, LightEditor& editor)
{
    if (editor.locked)
        ImGui::TextWrapped("%s", editorLocked);
    ImGui::BeginDisabled(editor.locked);
    editorButtons(scene, editor);
    if (CndLight* light = selectedLight(scene, editor)) {
        ImGui::Text("light %u of %zu", *editor.selected, scene.lights.size());
        const CndLight before = *light;
        if (lightWidgets(*light, editor.watts))
            changed(editor, before, *light);
    } else {
        ImGui::TextUnformatted("click a light, or press Tab");
    }
    ImGui::EndDisabled();
}

} // namespace candelabra::app
