// SPDX-License-Identifier: Apache-2.0
#include "viewer/moving_size.h"

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

} // namespace candelabra::app
