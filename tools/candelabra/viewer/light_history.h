// SPDX-License-Identifier: Apache-2.0
// LightHistory: the edits of a scene's lights, to be undone and redone.
#pragma once

#include <cstddef>
#include <optional>
#include <vector>

#include "scene/scene.h"

namespace candelabra::app
{

// One light before and after an edit. It was added if there is none before, and removed if there is
// none after.
struct LightEdit {
    uint32_t light = 0; // index in the scene
    std::optional<CndLight> before, after;
    // The motion of an added or removed light; empty if no light of the scene moved then.
    std::optional<LightMotion> motion{};
};

class LightHistory
{
public:
    // Only so many of the last steps can be undone.
    static constexpr size_t mostSteps = 1000;

    // The next edit begins a new step. Changes of one light without this call between them are one
    // step, as when the user drags a slider or holds a key.
    void beginStep() { open_ = false; }
    // Remembers an edit that has been made, and forgets what was undone.
    void add(const LightEdit& edit);

    bool canUndo() const { return next_ > 0; }
    bool canRedo() const { return next_ < steps_.size(); }
    // Returns a number for what the lights are now: undoing an edit brings back the number before.
    uint64_t state() const { return next_ ? steps_[next_ - 1].state : forgotten_; }
    // Undo or redo a step, which there must be. They return the edit that was made with `scene`.
    LightEdit undo(Scene& scene);
    LightEdit redo(Scene& scene);

private:
    struct Step {
        LightEdit edit;
        uint64_t state = 0; // after the edit
    };
    std::vector<Step> steps_;
    uint64_t states_ = 0, forgotten_ = 0; // the last number, and that before the first step
    size_t next_ = 0;                     // the steps from here on are undone
    bool open_ = false;
};

} // namespace candelabra::app
