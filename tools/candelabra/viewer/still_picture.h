// SPDX-License-Identifier: Apache-2.0
// StillPicture decides what the next frame of the viewer draws. While something changes, each frame
// has one sample. When nothing changes any more and the exposure has adapted, the next frames are
// the samples of one smooth picture, as of `render --aa`. After these nothing is drawn.
#pragma once

#include <optional>
#include <vector>

#include "render/renderer.h"

namespace candelabra::app
{

// All settings that decide what the viewer shows.
struct PictureSettings {
    FrameOptions left;                 // of the whole picture if there is no wipe
    std::optional<FrameOptions> right; // of what is right of the wipe's line

    bool operator==(const PictureSettings&) const = default;
};

// Returns whether frames with these settings are summed. Those with a heat map, which shows single
// pixels, and those of CND_INFLUENCE_BY_ERROR, which follow the exposure of the frame before, are
// not.
bool isSummed(const FrameOptions& frame);

class StillPicture
{
public:
    // The sum is made with the target exposure. It begins when the exposure in use differs from the
    // target by at most so many EV, which changes 8-bit values by at most one.
    static constexpr float mostEvLeft = 0.01f;

    // `slots`: frames in flight.
    explicit StillPicture(uint32_t slots) : drawnIn_(slots) {}

    // Call it before each frame. The picture begins again if the settings differ from those of the
    // previous frame. Settings that affect neither the lit image nor its exposure (sample, noise,
    // time step, and the time if no light moves) must be the same in all calls.
    void show(const PictureSettings& settings);
    // Begins again, because lights, surfaces or the size have changed.
    void change();
    // Tells by how many EV the exposure of the last frame of a slot, which has finished, differs
    // from its target: the larger difference of both sides of a wipe.
    void measured(uint32_t slot, float evLeft);

    // Returns the sample to draw, or nothing if the picture is complete.
    std::optional<FrameSample> next() const;
    // The sample that next() returned is recorded in a slot.
    void drawn(uint32_t slot);
    // The slot's frame is without a picture, or its statistics are lost.
    void forget(uint32_t slot) { drawnIn_[slot].reset(); }

    bool isFresh() const { return !drawnSince_; } // no frame was drawn since the last change
    bool isComplete() const { return !next(); }
    uint64_t version() const { return version_; } // another one after each change
    uint32_t summed() const { return summed_; }   // samples in the sum so far
    // Tells whether the slot's last frame shows the picture as it was in the last call of show(),
    // and whether both sides of a wipe are in it.
    bool isCurrent(uint32_t slot) const { return drawnIn_[slot] == version_; }
    bool hasTwoSides(uint32_t slot) const { return isCurrent(slot) && settings_->right; }

private:
    std::optional<PictureSettings> settings_;
    uint64_t version_ = 0; // counts changes
    std::vector<std::optional<uint64_t>> drawnIn_;
    bool drawnSince_ = false, adapted_ = false;
    uint32_t summed_ = 0;
};

} // namespace candelabra::app
