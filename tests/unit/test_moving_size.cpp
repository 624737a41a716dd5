// SPDX-License-Identifier: Apache-2.0
// Tests when the viewer draws at half width and height.
#include <algorithm>
#include <cmath>
#include <utility>

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

// Draws a picture in pieces. Returns how many they are, and the time in s of the longest. The rows
// of its lower half take `row` s each, those of the upper half a tenth of it.
std::pair<int, double> drawPieces(PieceRows& rows, uint32_t height, double row)
{
    int count = 0;
    double longest = 0;
    for (uint32_t first = 0, end = 0; first < height; first = end, ++count) {
        end = rows.endOf(first, height);
        double seconds = 0;
        for (uint32_t y = first; y < end; ++y)
            seconds += y < height / 2 ? row / 10 : row;
        rows.took(seconds);
        longest = std::max(longest, seconds);
    }
    return {count, longest};
}

TEST(PieceRows, TakeAboutAsLongAsTheyShould)
{
    for (const uint32_t height : {1u, 7u, 540u, 720u, 2160u})
        for (const double row : {1e-7, 1e-4, 1e-3, 4e-3}) {
            SCOPED_TRACE(testing::Message() << height << " rows, " << row << " s each");
            PieceRows rows;
            for (int i = 0; i < 12; ++i)
                drawPieces(rows, height, row);
            const auto [count, longest] = drawPieces(rows, height, row);
            EXPECT_LE(longest, 1.1 * PieceRows::pieceTime);
            // They are not much shorter than they may be.
            EXPECT_LE(count, std::ceil(2.5 * height * row / PieceRows::pieceTime) + 1);
        }
}

TEST(PieceRows, BecomeShorterAtOnceAndLongerAfterAWholePicture)
{
    PieceRows rows;
    for (int i = 0; i < 12; ++i)
        drawPieces(rows, 720, 1e-3);
    EXPECT_EQ(rows.endOf(0, 720), 48u);
    rows.took(1);
    EXPECT_EQ(rows.endOf(48, 720), 72u);
    // Pictures that are begun again and again tell little.
    for (int i = 0; i < 5; ++i) {
        rows.took(1e-3);
        EXPECT_EQ(rows.endOf(0, 720), 24u);
    }
    drawPieces(rows, 720, 1e-3);
    EXPECT_EQ(rows.endOf(0, 720), 48u);
}

} // namespace
