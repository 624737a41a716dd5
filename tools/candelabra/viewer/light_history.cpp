// SPDX-License-Identifier: Apache-2.0
#include "viewer/light_history.h"

#include <cstring>
#include <utility>

namespace candelabra::app
{
namespace
{

bool sameLight(const std::optional<CndLight>& a, const std::optional<CndLight>& b)
{
    return a && b && std::memcmp(&*a, &*b, sizeof(CndLight)) == 0;
}

void applyEdit(Scene& scene, const LightEdit& edit)
{
    const auto at = std::ptrdiff_t(edit.light);
    if (edit.before && edit.after) {
        scene.lights[edit.light] = *edit.after;
    } else if (edit.after) {
        scene.lights.insert(scene.lights.begin() + at, *edit.after);
        if (edit.motion)
            scene.lightMotions.insert(scene.lightMotions.begin() + at, *edit.motion);
    } else {
        scene.lights.erase(scene.lights.begin() + at);
        if (!scene.lightMotions.empty())
            scene.lightMotions.erase(scene.lightMotions.begin() + at);
    }
}

} // namespace

void LightHistory::add(const LightEdit& edit)
{
    steps_.resize(next_);
    LightEdit* last = steps_.empty() ? nullptr : &steps_.back().edit;
    const bool change = edit.before && edit.after;
    if (change && open_ && last && last->light == edit.light && last->before && last->after)
        last->after = edit.after;
    else
        steps_.push_back({edit});
    steps_.back().state = ++states_;
    open_ = true;
    if (sameLight(steps_.back().edit.before,
                  steps_.back().edit.after)) { // nothing is left of the step
        steps_.pop_back();
        open_ = false;
    }
    if (steps_.size() > mostSteps) {
        forgotten_ = steps_.front().state;
        steps_.erase(steps_.begin());
    }
    next_ = steps_.size();
}

LightEdit LightHistory::undo(Scene& scene)
{
    LightEdit edit = steps_[--next_].edit;
    std::swap(edit.before, edit.after);
    open_ = false;
    applyEdit(scene, edit);
    return edit;
}

LightEdit LightHistory::redo(Scene& scene)
{
    const LightEdit edit = steps_[next_++].edit;
    open_ = false;
    applyEdit(scene, edit);
    return edit;
}

} // namespace candelabra::app
