// SPDX-License-Identifier: Apache-2.0
#include "viewer/moving_size.h"

#include <algorithm>
#include <limits>
#include <utility>

namespace candelabra::app
{

void MovingSize::advance(double seconds, bool moves, WhileMoving choice)
{
    // With two frames in flight, the time between the starts of two frames is what the frame before
    // them took. A single slow or quick frame tells nothing.
    if (litFrames_ >= 2) {
        slower_ = seconds > slowFrame ? slower_ + 1 : 0;
        quicker_ = seconds < quickShare * slowFrame ? quicker_ + 1 : 0;
        if (slower_ >= 2)
            slow_ = true;
        else if (quicker_ >= 2)
            slow_ = false;
    }
    stillSeconds_ = moves ? 0 : stillSeconds_ + seconds;
    stillFrames_ = moves ? 0 : stillFrames_ + 1;
    const bool wanted = choice == WhileMoving::Half || (choice == WhileMoving::Auto && slow_);
    const bool still = stillSeconds_ >= stillTime && stillFrames_ >= stillFrames;
    half_ = wanted && !still && (half_ || moves);
}

void MovingSize::drew(bool lit)
{
    litFrames_ = lit ? litFrames_ + 1 : 0;
}

uint32_t PieceRows::endOf(uint32_t first, uint32_t height)
{
    constexpr uint32_t tile = 8; // Two pieces that share a row of tiles would both cull its lights.
    if (first == 0) {
        if (whole_)
            rows_ = std::max(rows_, uint32_t(std::min(slowest_, 2.0 * rows_)));
        slowest_ = std::numeric_limits<double>::max();
    }
    rows_ = std::max(rows_ / tile * tile, tile);
    drawn_ = std::min(rows_, height - first);
    whole_ = first + drawn_ == height;
    return first + drawn_;
}

void PieceRows::took(double seconds)
{
    const uint32_t drawn = std::exchange(drawn_, 0);
    if (2 * drawn < rows_) // The time of a short last piece says little about the others.
        return;
    const double fits = drawn * pieceTime / std::max(seconds, 1e-6);
    slowest_ = std::min(slowest_, fits);
    rows_ = uint32_t(std::clamp(fits, 0.5 * rows_, double(rows_)));
}

} // namespace candelabra::app
