// SPDX-License-Identifier: Apache-2.0
#include "viewer/selection.h"

#include <imgui.h>

#include "scene/light_types.h"
#include "viewer/panel.h"

namespace candelabra::app
{
namespace
{

// Draws in window units what `view` projects to the pixels of the picture.
class Lines
{
public:
    explicit Lines(const Projection& view)
        : view_(view),
          list_(ImGui::GetBackgroundDrawList()),
          scale_(ImGui::GetIO().DisplayFramebufferScale),
          width_(ImGui::GetFontSize() / 13)
    {
    }
    // Lines are bright with a dark rim, so that they are seen on everything.
    void draw(const std::vector<std::vector<glm::dvec3>>& polylines, ImU32 colour)
    {
        for (const bool rim : {true, false})
            for (const auto& polyline : polylines) {
                const std::vector<glm::dvec2> ends = view_.segments(polyline);
                for (size_t i = 0; i + 1 < ends.size(); i += 2)
                    list_->AddLine(at(ends[i]), at(ends[i + 1]),
                                   rim ? IM_COL32(0, 0, 0, 160) : colour,
                                   (rim ? 3.5f : 1.5f) * width_);
            }
    }
    void name(const std::vector<std::vector<glm::dvec3>>& polylines, const std::string& text,
              ImU32 colour)
    {
        std::optional<ImVec2> corner; // the upper right one of the lines
        for (const auto& polyline : polylines)
            for (const glm::dvec2& end : view_.segments(polyline)) {
                const ImVec2 p = at(end);
                corner = corner ? ImVec2(std::max(corner->x, p.x), std::min(corner->y, p.y)) : p;
            }
        if (!corner)
            return;
        // The name stays in the window even if the lines leave it.
        const ImVec2 place{corner->x + 4 * width_,
                           std::max(corner->y - ImGui::GetFontSize(), 0.0f)};
        list_->AddText({place.x + 1, place.y + 1}, IM_COL32(0, 0, 0, 255), text.c_str());
        list_->AddText(place, colour, text.c_str());
    }

private:
    ImVec2 at(const glm::dvec2& pixel) const
    {
        return {float(pixel.x) / scale_.x, float(pixel.y) / scale_.y};
    }

    const Projection& view_;
    ImDrawList* list_;
    ImVec2 scale_; // pixels per window unit
    float width_;
};

} // namespace

std::vector<glm::dvec3> cornersOf(const Bounds& bounds)
{
    std::vector<glm::dvec3> out;
    for (int corner = 0; corner < 8; ++corner)
        out.emplace_back(corner & 1 ? bounds.max.x : bounds.min.x,
                         corner & 2 ? bounds.max.y : bounds.min.y,
                         corner & 4 ? bounds.max.z : bounds.min.z);
    return out;
}

void drawSelection(const PanelState& state, const Projection& view,
                   const std::optional<CndLight>& light, const glm::dvec3& lightOrigin,
                   const std::optional<LightHandles>& handles)
{
    constexpr ImU32 lightColour = IM_COL32(90, 255, 130, 255);
    constexpr ImU32 objectColour = IM_COL32(120, 200, 255, 255);
    Lines lines(view);
    if (light) {
        const auto outline = outlineOf(*light, lightOrigin, view);
        lines.draw(outline, lightColour);
        lines.name(handles ? std::vector(1, handles->outlineOf(2)) : outline,
                   "light " + std::to_string(*state.editor.selected), lightColour);
    } else if (state.object) {
        const std::vector<glm::dvec3> corners = cornersOf(state.object->bounds);
        std::vector<std::vector<glm::dvec3>> edges;
        for (size_t i = 0; i < corners.size(); ++i)
            for (const size_t bit : {1, 2, 4})
                if (!(i & bit))
                    edges.push_back({corners[i], corners[i | bit]});
        lines.draw(edges, objectColour);
        lines.name(edges, state.object->name, objectColour);
    }
}

void drawHandles(const LightHandles& handles, const Projection& view,
                 std::optional<uint32_t> active)
{
    Lines lines(view);
    for (const uint32_t handle : LightHandles::all) {
        const int bright = handle == active ? 255 : 200, dark = handle == active ? 160 : 60;
        const auto part = [&](uint32_t axis) { return handle & axis ? bright : dark; };
        lines.draw({handles.outlineOf(handle)}, IM_COL32(part(1), part(2), part(4), 255));
    }
}

Camera beforeOccluders(Camera fitted, const glm::dvec3& front, RayCaster& rays)
{
    const double away = glm::dot(front - fitted.position, fitted.forward);
    const double gap = std::max(1e-3 * away, 1e-3); // because `front` may be on a surface
    const auto hit = rays.cast({front - gap * fitted.forward, -fitted.forward});
    if (!hit || gap + hit->distance >= away)
        return fitted;
    const double room = gap + hit->distance;
    fitted.position = front - 0.9 * room * fitted.forward;
    fitted.nearPlane = std::min(fitted.nearPlane, 0.05 * room);
    return fitted;
}

} // namespace candelabra::app
