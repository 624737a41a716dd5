// SPDX-License-Identifier: Apache-2.0
// Tests when the viewer draws at half width and height.
#include <gtest/gtest.h>

#include "viewer/moving_size.h"

using namespace candelabra::app;

namespace
{

constexpr double slowTime = 1.5 * MovingSize::slowFrame, quickTime = 0.5 * MovingSize::slowFrame;

// Draws frames that take so long at full size. Returns whether the last one was drawn at half.
bool isHalfAfter(MovingSize& size, int frames, double seconds, bool moves,
                 WhileMoving choice = WhileMoving::Auto)
{
    for (int i = 0; i < frames; ++i) {
        size.advance(seconds, moves, choice);
        size.drew(!size.isHalf());
    }
    return size.isHalf();
}

TEST(MovingSize, IsHalfOnlyWhileASlowDeviceMoves)
{
    MovingSize size;
    EXPECT_FALSE(isHalfAfter(size, 10, quickTime, true));
    EXPECT_FALSE(isHalfAfter(size, 10, slowTime, false));
    EXPECT_TRUE(isHalfAfter(size, 1, slowTime, true));   // known to be slow from its still frames
    EXPECT_TRUE(isHalfAfter(size, 50, quickTime, true)); // frames at half size tell nothing
    EXPECT_TRUE(isHalfAfter(size, 1, 0.01, false));      // a moment of rest
    EXPECT_FALSE(isHalfAfter(size, 30, 0.01, false));
    EXPECT_FALSE(isHalfAfter(size, 10, quickTime, false)); // now it is quick
    EXPECT_FALSE(isHalfAfter(size, 10, quickTime, true));
    EXPECT_TRUE(isHalfAfter(size, 10, slowTime, true));
}

TEST(MovingSize, DoesNotFollowSingleFrames)
{
    MovingSize size;
    isHalfAfter(size, 5, quickTime, true);
    for (int i = 0; i < 5; ++i) {
        EXPECT_FALSE(isHalfAfter(size, 1, 1, true)); // such as while a file is saved
        EXPECT_FALSE(isHalfAfter(size, 1, quickTime, true));
    }
    // Between both limits a device stays what it is.
    const double between = (0.5 + 0.5 * MovingSize::quickShare) * MovingSize::slowFrame;
    EXPECT_FALSE(isHalfAfter(size, 10, between, true));
    EXPECT_TRUE(isHalfAfter(size, 10, slowTime, true));
    isHalfAfter(size, 30, between, false);
    EXPECT_FALSE(size.isHalf());
    EXPECT_TRUE(isHalfAfter(size, 1, between, true));
}

TEST(MovingSize, FramesThatReuseTheImageTellNothing)
{
    MovingSize size;
    isHalfAfter(size, 10, slowTime, false);
    for (int i = 0; i < 10; ++i) {
        size.advance(0.001, false, WhileMoving::Auto);
        size.drew(false);
    }
    size.advance(0.001, true, WhileMoving::Auto);
    EXPECT_TRUE(size.isHalf());
}

TEST(MovingSize, FollowsTheChoice)
{
    MovingSize size;
    EXPECT_TRUE(isHalfAfter(size, 1, quickTime, true, WhileMoving::Half));
    EXPECT_FALSE(isHalfAfter(size, 30, quickTime, false, WhileMoving::Half));
    EXPECT_FALSE(isHalfAfter(size, 20, slowTime, true, WhileMoving::Full));
    EXPECT_EQ(halfOf({5, 4}), (candelabra::app::PixelSize{3, 2}));
}

} // namespace
