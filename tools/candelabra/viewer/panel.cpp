// SPDX-License-Identifier: Apache-2.0
#include "viewer/panel.h"

#include <algorithm>
#include <array>
#include <cmath>

#include <fmt/format.h>
#include <glm/gtc/color_space.hpp>
#include <imgui.h>

#include "io/table.h"
#include "reference/eye_adaptation.h"
#include "render/heat_map_legend.h"
#include "render/setting_names.h"
#include "scene/light_types.h"
#include "scene/scene_options.h"
#include "viewer/keys.h"
#include "viewer/still_picture.h"

namespace candelabra::app
{
namespace
{

// EV100 at the lower edge of the histogram's first bin, and width of a bin. The histogram starts at
// 2^-12 cd/m^2 and has 8 bins per octave; EV100 = log2(L * 100 / 12.5), with L in cd/m^2.
constexpr float firstBinEv = -12 + 3, evPerBin = 1.0f / 8;

template <typename T, size_t N>
void combo(const char* label, T& value, const Choice<T> (&choices)[N])
{
    if (!ImGui::BeginCombo(label, nameOf(value, choices)))
        return;
    for (const Choice<T>& choice : choices)
        if (ImGui::Selectable(choice.name, value == choice.value))
            value = choice.value;
    ImGui::EndCombo();
}

// Plots the GPU time of the last frames, the newest at the right.
void drawTimeLine(const PanelFigures& figures)
{
    std::vector<float> totals;
    for (const auto& frame : figures.passes) {
        double sum = 0;
        for (const PassTime& pass : frame)
            sum += pass.ms;
        totals.push_back(float(sum));
    }
    const float most = *std::max_element(totals.begin(), totals.end());
    const std::string label = "GPU, 0 to " + threeDigits(double(most)) + " ms";
    ImGui::PlotLines("##times", totals.data(), int(totals.size()), 0, label.c_str(), 0, most,
                     {ImGui::GetContentRegionAvail().x, 3 * ImGui::GetFontSize()});
}

void drawTimes(const PanelFigures& figures)
{
    PassTimes times;
    for (const auto& frame : figures.passes)
        times.add(frame);
    if (!times.frames())
        return;
    drawTimeLine(figures);
    ImGui::Text("of the last %zu frames drawn, %ux%u", times.frames(), figures.drawnSize.width,
                figures.drawnSize.height);
    if (!ImGui::BeginTable("times", 3, ImGuiTableFlags_RowBg))
        return;
    ImGui::TableSetupColumn("GPU pass", ImGuiTableColumnFlags_WidthStretch, 2);
    ImGui::TableSetupColumn("median ms");
    ImGui::TableSetupColumn("p95 ms");
    ImGui::TableHeadersRow();
    const auto row = [](const PassSummary& pass) {
        ImGui::TableNextRow();
        ImGui::TableNextColumn();
        ImGui::TextUnformatted(pass.name.c_str());
        ImGui::TableNextColumn();
        ImGui::TextUnformatted(threeDigits(pass.medianMs).c_str());
        ImGui::TableNextColumn();
        ImGui::TextUnformatted(threeDigits(pass.p95Ms).c_str());
    };
    for (const PassSummary& pass : times.summary())
        row(pass);
    row(times.total());
    ImGui::EndTable();
}

void drawWipe(PanelState& state)
{
    Wipe& wipe = state.wipe;
    ImGui::Checkbox("compare with", &wipe.on);
    if (!wipe.on)
        return;
    ImGui::SliderFloat("wipe", &wipe.at, 0, 1, "%.2f", ImGuiSliderFlags_AlwaysClamp);
    combo("specular##other", wipe.specular, specularChoices);
    combo("culling##other", wipe.culling, cullingChoices);
}

// Draws the line of the wipe and, at its foot, the names of the two ways of shading.
void drawWipeLine(const PanelState& state, float bottom)
{
    const auto name = [](CndSpecularMethod specular, CndCulling culling) {
        const std::string out = specularName(specular);
        return culling == CND_CULLING_BRUTE ? out + ", brute" : out;
    };
    const Wipe& wipe = state.wipe;
    const std::string left = name(state.frame.specular, state.frame.culling);
    const std::string right = name(wipe.specular, wipe.culling);
    const ImVec2 size = ImGui::GetIO().DisplaySize;
    const float x = wipe.at * size.x, y = bottom - 1.5f * ImGui::GetFontSize();
    constexpr ImU32 white = IM_COL32(255, 255, 255, 200);
    ImDrawList* list = ImGui::GetBackgroundDrawList();
    list->AddLine({x, 0}, {x, size.y}, white);
    list->AddText({x - 8 - ImGui::CalcTextSize(left.c_str()).x, y}, white, left.c_str());
    list->AddText({x + 8, y}, white, right.c_str());
}

void drawObject(const SelectedObject& object, const Scene& scene)
{
    const glm::dvec3 size = object.bounds.max - object.bounds.min;
    ImGui::TextWrapped("%s, %s x %s x %s m", object.name.c_str(), threeDigits(size.x).c_str(),
                       threeDigits(size.y).c_str(), threeDigits(size.z).c_str());
    const Material& m = scene.materials[object.material];
    const auto texture = [](const TextureRef& ref) {
        return ref.texture >= 0 ? ", times a texture" : "";
    };
    ImGui::TextWrapped("material %u%s%s", object.material, m.name.empty() ? "" : ": ",
                       m.name.c_str());
    const glm::vec3 srgb = glm::convertLinearToSRGB(glm::clamp(m.baseColor, 0.0f, 1.0f));
    ImGui::ColorButton("##colour", {srgb.x, srgb.y, srgb.z, 1});
    ImGui::SameLine();
    ImGui::TextWrapped("colour %.2f, %.2f, %.2f, linear%s", double(m.baseColor.x),
                       double(m.baseColor.y), double(m.baseColor.z), texture(m.baseColorTexture));
    ImGui::TextWrapped("roughness %.2f, metalness %.2f%s", double(m.perceptualRoughness),
                       double(m.metalness), texture(m.metallicRoughnessTexture));
    if (const float light = std::max({m.emission.x, m.emission.y, m.emission.z}); light > 0)
        ImGui::TextWrapped("shines with %s cd/m^2%s", groupedOrThreeDigits(double(light)).c_str(),
                           texture(m.emissiveTexture));
}

// Draws the list of the scene's cameras. Its preview is the last camera that was chosen, even after
// the view has moved.
void drawCameras(PanelState& state, const Scene& scene)
{
    const auto name = [](const Camera& camera) {
        return camera.name.empty() ? "without a name" : camera.name.c_str();
    };
    if (!ImGui::BeginCombo("camera", name(state.frame.camera)))
        return;
    for (size_t i = 0; i < scene.cameras.size(); ++i) {
        ImGui::PushID(int(i)); // names may be the same
        if (ImGui::Selectable(name(scene.cameras[i])))
            state.wantedCamera = i;
        ImGui::PopID();
    }
    ImGui::EndCombo();
}

void drawMaterials(PanelState& state)
{
    MaterialOverride& m = state.materials;
    // A change is applied when the mouse is released, because it uploads the geometry again.
    state.materialsChosen |= ImGui::Checkbox("one material for everything", &m.on);
    if (!m.on)
        return;
    ImGui::SliderFloat("roughness", &m.perceptualRoughness, 0, 1, "%.2f",
                       ImGuiSliderFlags_AlwaysClamp);
    state.materialsChosen |= ImGui::IsItemDeactivatedAfterEdit();
    ImGui::SliderFloat("metalness", &m.metalness, 0, 1, "%.2f", ImGuiSliderFlags_AlwaysClamp);
    state.materialsChosen |= ImGui::IsItemDeactivatedAfterEdit();
}

// A part of the window, in window units.
struct Area {
    ImVec2 from, to;

    float width() const { return to.x - from.x; }
    float height() const { return to.y - from.y; }
};

float padding()
{
    return ImGui::GetStyle().WindowPadding.x;
}

// The width of the help without a scroll bar.
float helpWidth()
{
    float keys = 0, what = 0;
    for (const KeyHelp& help : keyHelp) {
        keys = std::max(keys, ImGui::CalcTextSize(help.keys).x);
        what = std::max(what, ImGui::CalcTextSize(help.what).x);
    }
    what = std::max(what, ImGui::CalcTextSize(fieldHelp).x - keys);
    return keys + what + 4 * ImGui::GetStyle().CellPadding.x + 2 * padding();
}

void drawHelp(PanelState& state, const Area& area)
{
    ImGui::SetNextWindowPos({0.5f * (area.from.x + area.to.x), area.from.y}, ImGuiCond_Always,
                            {0.5f, 0});
    ImGui::SetNextWindowSizeConstraints({0, 0}, {area.width(), area.height()});
    constexpr ImGuiWindowFlags flags =
        ImGuiWindowFlags_AlwaysAutoResize | ImGuiWindowFlags_NoCollapse | ImGuiWindowFlags_NoMove |
        ImGuiWindowFlags_HorizontalScrollbar | ImGuiWindowFlags_NoSavedSettings;
    if (ImGui::Begin("keys and mouse", &state.help, flags)) {
        if (ImGui::BeginTable("keys", 2, ImGuiTableFlags_RowBg | ImGuiTableFlags_SizingFixedFit)) {
            for (const KeyHelp& help : keyHelp) {
                ImGui::TableNextRow();
                ImGui::TableNextColumn();
                ImGui::TextUnformatted(help.keys);
                ImGui::TableNextColumn();
                ImGui::TextUnformatted(help.what);
            }
            ImGui::EndTable();
        }
        ImGui::TextUnformatted(fieldHelp);
    }
    ImGui::End();
}

// Shows the result of the user's last request for a while, in a corner where nothing else is.
void drawNote(PanelState& state, const PanelFigures& figures, const Area& area)
{
    const double shown = std::max(4.0, double(figures.note.size()) / 12); // s, time to read it
    const double now = ImGui::GetTime();
    if (state.shownNote != figures.note) {
        state.shownNote = figures.note;
        state.noteTime = now;
    }
    state.noteLeft = figures.note.empty() ? 0 : state.noteTime + shown - now;
    if (state.noteLeft <= 0)
        return;
    ImDrawList* list = ImGui::GetBackgroundDrawList();
    const float wrap = area.width() - 2 * padding();
    const ImVec2 size = ImGui::CalcTextSize(figures.note.c_str(), nullptr, false, wrap);
    const ImVec2 at{area.to.x - padding() - size.x, area.to.y - padding() - size.y};
    list->AddRectFilled({at.x - padding(), at.y - padding()}, area.to, IM_COL32(20, 20, 20, 200),
                        ImGui::GetStyle().WindowRounding);
    list->AddText(nullptr, 0, at, IM_COL32(255, 255, 255, 255), figures.note.c_str(), nullptr,
                  wrap);
}

void drawLights(PanelState& state, const PanelFigures& figures)
{
    const CndLightingStats& s = figures.lighting;
    if (s.tileCount && state.frame.culling == CND_CULLING_CLUSTERED)
        ImGui::TextWrapped("list entries per tile: %.1f, longest list: %u%s",
                           double(s.listEntries) / double(s.tileCount), s.maxListLength,
                           s.unlistedClusters ? " (some clusters have no list)" : "");
    ImGui::Text("%s", counted(figures.lights, "light").c_str());
    ImGui::SameLine();
    if (ImGui::SmallButton("half"))
        state.wantedLights = std::max(figures.lights / 2, 1u);
    ImGui::SameLine();
    if (ImGui::SmallButton("double"))
        state.wantedLights = std::min(figures.lights * 2, maxLights);
    if (figures.moving)
        ImGui::Checkbox("move lights", &state.animate);
    ImGui::Checkbox("show lights as emitters", &state.frame.lightsVisible);
    ImGui::Checkbox("levels of detail", &state.frame.levels);
    combo("specular", state.frame.specular, specularChoices);
    combo("culling", state.frame.culling, cullingChoices);
    if (state.frame.culling == CND_CULLING_CLUSTERED)
        combo("heat map", state.frame.heatMap, heatMapChoices);
    else
        state.frame.heatMap = HeatMap::None;
    if (state.frame.heatMap == HeatMap::Shadow && !state.frame.shadows)
        state.frame.heatMap = HeatMap::None; // there are none to show
}

void drawHistogram(const CndExposureStats& stats)
{
    std::array<float, CND_HISTOGRAM_BINS> heights{};
    for (size_t i = 0; i < heights.size(); ++i)
        heights[i] = std::sqrt(float(stats.histogram[i])); // keeps small counts visible
    const float width = ImGui::GetContentRegionAvail().x;
    const ImVec2 corner = ImGui::GetCursorScreenPos();
    const float height = 6 * ImGui::GetFontSize();
    ImGui::PlotHistogram("##histogram", heights.data(), int(heights.size()), 0, nullptr, 0, FLT_MAX,
                         {width, height});
    const auto mark = [&](float ev, ImU32 colour) {
        const float x = (ev - firstBinEv) / (evPerBin * CND_HISTOGRAM_BINS);
        if (x >= 0 && x <= 1)
            ImGui::GetWindowDrawList()->AddLine({corner.x + x * width, corner.y},
                                                {corner.x + x * width, corner.y + height}, colour,
                                                2);
    };
    mark(stats.targetEv100, IM_COL32(90, 200, 255, 255));
    mark(stats.adaptedEv100, IM_COL32(255, 160, 60, 255));
    ImGui::Text("luminance, EV100 %.0f to %.0f", double(firstBinEv),
                double(firstBinEv + evPerBin * CND_HISTOGRAM_BINS));
    ImGui::TextWrapped("EV100: target %.2f (blue), in use %.2f (orange)", double(stats.targetEv100),
                       double(stats.adaptedEv100));
}

// Draws the weights of centre-weighted metering as a grey image with the aspect ratio of `picture`.
// Brighter places count more.
void drawMetering(const PixelSize& picture)
{
    constexpr uint32_t columns = 48;
    const float width = ImGui::GetContentRegionAvail().x;
    const float height = width * float(picture.height) / float(picture.width);
    const uint32_t rows = std::clamp(uint32_t(columns * height / width), 1u, 4 * columns);
    const ImVec2 corner = ImGui::GetCursorScreenPos();
    const float across = width / columns, down = height / float(rows);
    for (uint32_t y = 0; y < rows; ++y)
        for (uint32_t x = 0; x < columns; ++x) {
            const uint32_t weight = reference::centreWeight(x, y, columns, rows); // 1..15
            const ImU32 grey = weight * 17;
            const ImVec2 at{corner.x + float(x) * across, corner.y + float(y) * down};
            ImGui::GetWindowDrawList()->AddRectFilled(at, {at.x + across, at.y + down},
                                                      IM_COL32(grey, grey, grey, 255));
        }
    ImGui::Dummy({width, height});
    ImGui::TextUnformatted("metering weights: 15 (white) to 1 (dark)");
}

void drawPick(PanelState& state, const Pick& pick, const Scene& scene)
{
    ImGui::Text("pixel %u,%u", pick.pixel.x, pick.pixel.y);
    if (!pick.surface) {
        ImGui::TextUnformatted("no surface is visible there");
        return;
    }
    const double all = luminanceOf(pick.radiance);
    ImGui::TextWrapped("at (%.2f, %.2f, %.2f) m, %s cd/m^2, %s", pick.position.x, pick.position.y,
                       pick.position.z, groupedOrThreeDigits(all).c_str(),
                       counted(pick.lights.size(), "light").c_str());
    constexpr ImGuiTableFlags flags = ImGuiTableFlags_RowBg | ImGuiTableFlags_ScrollY;
    const float line = ImGui::GetTextLineHeightWithSpacing();
    const float height = line * float(std::min<size_t>(pick.lights.size() + 2, 12));
    if (!ImGui::BeginTable("picked", 4, flags, {0, height}))
        return;
    for (const char* title : {"light", "cd/m^2", "share", "error"})
        ImGui::TableSetupColumn(title);
    ImGui::TableHeadersRow();
    for (const PickedLight& light : pick.lights) {
        if (light.light >= scene.lights.size()) // this light was removed after the pick
            continue;
        const double y = luminanceOf(light.radiance), truth = luminanceOf(light.truth);
        ImGui::TableNextRow();
        ImGui::TableNextColumn();
        const std::string name =
            std::to_string(light.light) + " " + lightTypeLabel(scene.lights[light.light].type);
        if (ImGui::Selectable(name.c_str(), state.editor.selected == light.light,
                              ImGuiSelectableFlags_SpanAllColumns))
            state.editor.selected = light.light;
        ImGui::TableNextColumn();
        ImGui::TextUnformatted(groupedOrThreeDigits(y).c_str());
        ImGui::TableNextColumn();
        ImGui::Text("%.1f%%", all > 0 ? 100 * y / all : 0);
        ImGui::TableNextColumn();
        if (truth > 0)
            ImGui::Text("%+.3f%%", 100 * (y - truth) / truth);
    }
    ImGui::EndTable();
}

void drawExposure(PanelState& state, const PanelFigures& figures)
{
    CndExposureSettings& e = state.frame.exposure;
    bool manual = e.manual;
    if (ImGui::Checkbox("manual exposure", &manual)) {
        e.manual = manual;
        e.manualEv100 = figures.exposure.adaptedEv100;
    }
    if (e.manual) {
        ImGui::SliderFloat("EV100", &e.manualEv100, firstBinEv, 23, "%.2f");
    } else {
        drawHistogram(figures.exposure);
        bool centre = e.metering == CND_METERING_CENTRE_WEIGHTED;
        if (ImGui::Checkbox("centre-weighted", &centre))
            e.metering = centre ? CND_METERING_CENTRE_WEIGHTED : CND_METERING_AVERAGE;
        if (centre && figures.size.width && figures.size.height)
            drawMetering(figures.size);
        ImGui::SliderFloat("low percentile", &e.lowPercentile, 0, 0.45f, "%.2f");
        ImGui::SliderFloat("high percentile", &e.highPercentile, 0.55f, 1, "%.2f");
        ImGui::SliderFloat("adapt to brighter", &e.speedUp, 0.1f, 20, "%.1f 1/s");
        ImGui::SliderFloat("adapt to darker", &e.speedDown, 0.1f, 20, "%.1f 1/s");
    }
    ImGui::SliderFloat("compensation", &e.compensation, -8, 8, "%+.1f EV");
    ImGui::SliderFloat("middle grey", &e.middleGrey, 0.05f, 0.5f, "%.3f",
                       ImGuiSliderFlags_AlwaysClamp);
    combo("tone map", e.toneMap, toneMapChoices);
    bool dither = e.dither;
    ImGui::Checkbox("dither", &dither);
    e.dither = dither;
    ImGui::Checkbox("smooth edges while moving", &state.frame.edgeFilter);
    combo("size while moving", state.whileMoving, whileMovingChoices);
    ImGui::SliderFloat("bloom", &state.frame.bloom, 0, 0.2f, "%.3f", ImGuiSliderFlags_AlwaysClamp);
}

// The size of the panel, in heights of a line of text.
constexpr float panelWidth = 24.6f, leastHeight = 49;

// The height of the legend of the heat map in the lower left corner, or 0.
float legendHeight(const PanelState& state, const PanelFigures& figures)
{
    if (state.frame.heatMap == HeatMap::None || !figures.size.height)
        return 0;
    const Legend legend = heatMapLegend(state.frame.heatMap, figures.size, heatMapScaleEnd(0));
    return float(legend.height) * ImGui::GetIO().DisplaySize.y / float(figures.size.height);
}

std::string stateOfPicture(const PanelFigures& figures)
{
    if (figures.complete)
        return figures.summed ? fmt::format("still: {} samples per pixel; nothing is drawn until "
                                            "something changes",
                                            figures.summed)
                              : "still: nothing is drawn until something changes";
    if (figures.summed)
        return fmt::format("still: {} of {} samples are summed", figures.summed, pictureSamples);
    if (figures.drawnSize == figures.size)
        return "drawn frame by frame";
    return fmt::format("drawn frame by frame with {}x{} pixels", figures.drawnSize.width,
                       figures.drawnSize.height);
}

// Draws what is in the panel. `room` is how high it may be, in heights of a line of text: sections
// that are tall begin open only if they fit.
void drawSections(PanelState& state, const PanelFigures& figures, Scene& scene, float room)
{
    constexpr ImGuiTreeNodeFlags open = ImGuiTreeNodeFlags_DefaultOpen;
    ImGui::PushItemWidth(-9.7f * ImGui::GetFontSize()); // leaves room for the longest name
    drawCameras(state, scene);
    if (state.object && ImGui::CollapsingHeader("Object", open))
        drawObject(*state.object, scene);
    if (ImGui::CollapsingHeader("Light editor", open))
        drawLightEditor(scene, state.editor);
    if (figures.picked && ImGui::CollapsingHeader("Pixel", open))
        drawPick(state, *figures.picked, scene);
    if (ImGui::CollapsingHeader("Lights", open))
        drawLights(state, figures);
    if (ImGui::CollapsingHeader("Exposure", room > 100 ? open : ImGuiTreeNodeFlags_None))
        drawExposure(state, figures);
    if (ImGui::CollapsingHeader("A/B"))
        drawWipe(state);
    if (ImGui::CollapsingHeader("Materials"))
        drawMaterials(state);
    if (ImGui::CollapsingHeader("Times", room > 138 ? open : ImGuiTreeNodeFlags_None))
        drawTimes(figures);
    ImGui::PopItemWidth();
    ImGui::TextWrapped("%s, %ux%u, %s", figures.scene.c_str(), figures.size.width,
                       figures.size.height, figures.device.c_str());
    ImGui::TextWrapped("%s", stateOfPicture(figures).c_str());
    ImGui::TextWrapped("%s drawn, the last two %s ms apart",
                       counted(figures.frames, "frame").c_str(),
                       threeDigits(figures.wallMs).c_str());
    ImGui::Text("camera %.1f m/s", figures.speed);
    ImGui::TextUnformatted("F2: keys and mouse");
}

// Draws the panel at the left of `area` and returns the rest of that.
Area drawMainWindow(PanelState& state, const PanelFigures& figures, Scene& scene, Area area)
{
    const float em = ImGui::GetFontSize(), width = std::min(panelWidth * em, area.width());
    const float gap = area.from.x;
    const bool tight = state.help && area.width() - width - gap < helpWidth();
    const bool small = 3 * width > area.width() + 2 * gap || area.to.y < leastHeight * em - gap;
    // The user may open a panel that begins collapsed, unless it would cover the help.
    if (tight || state.collapsed != (tight || small))
        ImGui::SetNextWindowCollapsed(tight || small);
    state.collapsed = tight || small;
    ImGui::SetNextWindowPos(area.from);
    ImGui::SetNextWindowSizeConstraints({width, 0}, {width, area.height()});
    ImGui::SetNextWindowBgAlpha(0.85f);
    // The title is all that a collapsed panel shows. Dear ImGui takes the text after ### for the
    // panel's name, which stays the same while the rest of the title changes.
    const std::string title = fmt::format(
        "{}, {}, {}, F2: keys###candelabra", figures.scene, counted(figures.lights, "light"),
        figures.complete ? "still" : threeDigits(figures.wallMs) + " ms");
    const bool open = ImGui::Begin(title.c_str(), nullptr,
                                   ImGuiWindowFlags_AlwaysAutoResize | ImGuiWindowFlags_NoMove);
    if (open)
        drawSections(state, figures, scene, area.height() / em);
    ImGui::End();
    if (open)
        area.from.x += width + gap;
    else
        area.from.y += 2 * em + gap;
    return area;
}

} // namespace

void drawPanel(PanelState& state, const PanelFigures& figures, Scene& scene)
{
    const ImVec2 window = ImGui::GetIO().DisplaySize;
    const float gap = padding(), legend = legendHeight(state, figures);
    state.noteLeft = 0;
    Area area{{gap, gap}, {window.x - gap, window.y - gap - (legend > 0 ? legend + gap : 0)}};
    if (state.wipe.on)
        drawWipeLine(state, area.to.y);
    if (state.visible)
        area = drawMainWindow(state, figures, scene, area);
    if (state.help)
        drawHelp(state, area);
    else
        drawNote(state, figures, area);
}

} // namespace candelabra::app
