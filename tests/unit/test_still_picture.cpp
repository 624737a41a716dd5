// SPDX-License-Identifier: Apache-2.0
// Tests when the viewer sums samples of its picture, and when it draws nothing.
#include <gtest/gtest.h>

#include "viewer/still_picture.h"

using namespace candelabra;
using namespace candelabra::app;

namespace
{

// A viewer without a window: it draws one frame after the other in two slots.
struct StillViewer {
    StillPicture picture{2};
    PictureSettings settings;
    float evLeft = 0; // in every frame that is drawn from now on
    std::array<std::optional<float>, 2> inSlot;
    uint32_t slot = 0;

    // Returns the sample that the next frame draws.
    std::optional<FrameSample> frame()
    {
        slot = 1 - slot;
        if (inSlot[slot])
            picture.measured(slot, *inSlot[slot]);
        picture.show(settings);
        const auto sample = picture.next();
        if (sample) {
            picture.drawn(slot);
            inSlot[slot] = evLeft;
        } else {
            picture.forget(slot);
            inSlot[slot].reset();
        }
        return sample;
    }
    // Draws frames of one sample and returns how many until the sum began.
    uint32_t framesUntilSum()
    {
        for (uint32_t frames = 0; frames < 100; ++frames)
            if (const auto sample = frame(); !sample || sample->count > 1)
                return frames;
        return 100;
    }
    // Draws the rest of the sum, and returns the number of its samples.
    uint32_t restOfSum()
    {
        uint32_t samples = 1;
        while (const auto sample = frame()) {
            EXPECT_EQ(*sample, (FrameSample{samples, pictureSamples}));
            ++samples;
        }
        return samples;
    }
};

TEST(StillPicture, IsSummedAndThenNoLongerDrawn)
{
    StillViewer viewer;
    EXPECT_FALSE(viewer.picture.isComplete());
    // The statistics of the first frame are there when its slot is used again.
    EXPECT_EQ(viewer.framesUntilSum(), 2u);
    EXPECT_EQ(viewer.restOfSum(), pictureSamples);
    for (int i = 0; i < 5; ++i)
        EXPECT_FALSE(viewer.frame());
    EXPECT_TRUE(viewer.picture.isComplete());
    EXPECT_EQ(viewer.picture.summed(), pictureSamples);
}

TEST(StillPicture, BeginsAnewAfterAnyChange)
{
    StillViewer viewer;
    const auto expectAnew = [&](const char* what) {
        const auto sample = viewer.frame();
        ASSERT_TRUE(sample) << what;
        EXPECT_EQ(*sample, FrameSample{}) << what;
        // Statistics of frames before the change do not count.
        EXPECT_EQ(viewer.framesUntilSum(), 1u) << what;
        EXPECT_EQ(viewer.picture.summed(), 1u) << what;
    };
    expectAnew("the beginning");
    viewer.settings.left.camera.position.x += 1;
    expectAnew("a camera while samples are summed");
    viewer.restOfSum();
    viewer.settings.left.exposure.compensation += 0.5f;
    expectAnew("a setting of exposure");
    viewer.settings.left.influence.maxError = 0.25f;
    expectAnew("a setting of influence");
    viewer.settings.right = viewer.settings.left;
    expectAnew("a wipe");
    viewer.restOfSum();
    viewer.picture.change();
    expectAnew("lights");
}

TEST(StillPicture, KnowsWhichFramesShowTwoSides)
{
    StillPicture picture(2);
    PictureSettings settings;
    const auto frame = [&](uint32_t slot) {
        picture.show(settings);
        picture.drawn(slot);
    };
    frame(0);
    frame(1);
    EXPECT_FALSE(picture.hasTwoSides(0));
    settings.right = FrameOptions{};
    EXPECT_FALSE(picture.hasTwoSides(0)); // the second side was not drawn yet
    frame(0);
    EXPECT_TRUE(picture.hasTwoSides(0));
    EXPECT_FALSE(picture.hasTwoSides(1));
    settings.right.reset();
    frame(1);
    EXPECT_FALSE(picture.hasTwoSides(0));
    EXPECT_FALSE(picture.hasTwoSides(1));
}

TEST(StillPicture, WaitsUntilTheEyeHasAdapted)
{
    StillViewer viewer;
    viewer.evLeft = -2 * StillPicture::mostEvLeft;
    EXPECT_EQ(viewer.framesUntilSum(), 100u);
    viewer.evLeft = -0.5f * StillPicture::mostEvLeft;
    EXPECT_EQ(viewer.framesUntilSum(), 2u);
    // Samples see other pixels and so other targets. The sum continues.
    viewer.evLeft = 1;
    EXPECT_EQ(viewer.restOfSum(), pictureSamples);
}

TEST(StillPicture, IsNotSummedWhereSinglePixelsCount)
{
    StillViewer viewer;
    viewer.settings.left.heatMap = HeatMap::PixelClass;
    EXPECT_EQ(viewer.framesUntilSum(), 2u);
    EXPECT_TRUE(viewer.picture.isComplete());
    EXPECT_EQ(viewer.picture.summed(), 0u);
    // The other side of a wipe has no heat map.
    viewer.settings.right = FrameOptions{};
    EXPECT_EQ(viewer.framesUntilSum(), 2u);
    EXPECT_EQ(viewer.restOfSum(), pictureSamples);
    EXPECT_FALSE(isSummed({.influence = {.rule = CND_INFLUENCE_BY_ERROR}}));
}

} // namespace
