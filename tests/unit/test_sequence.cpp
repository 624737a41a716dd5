// SPDX-License-Identifier: Apache-2.0
// Tests what sequences of pictures are made of: places of samples in a pixel, numbered names, and
// paths of the camera.
#include <set>

#include <gtest/gtest.h>

#include "io/error.h"
#include "io/numbered_name.h"
#include "render/accumulation.h"
#include "render/camera.h"
#include "render/camera_path.h"

using namespace candelabra::app;

TEST(FrameSamples, FillThePixelEvenly)
{
    EXPECT_EQ(sampleOffset({}), glm::dvec2(0));
    for (const uint32_t count : {2u, 3u, 16u, 100u, 256u}) {
        std::set<double> xs, ys;
        for (uint32_t i = 0; i < count; ++i) {
            const glm::dvec2 at = sampleOffset({i, count});
            EXPECT_LT(std::max(std::abs(at.x), std::abs(at.y)), 0.5);
            xs.insert(at.x);
            ys.insert(at.y);
        }
        EXPECT_EQ(xs.size(), count);
        EXPECT_EQ(ys.size(), count);
    }
    // All 5 shapes of 16 equal rectangles have one of 16 points each, and the mean is the centre.
    for (uint32_t columns = 1; columns <= 16; columns *= 2) {
        std::set<std::pair<int, int>> cells;
        glm::dvec2 sum(0);
        for (uint32_t i = 0; i < 16; ++i) {
            const glm::dvec2 at = sampleOffset({i, 16});
            cells.insert({int((at.x + 0.5) * columns), int((at.y + 0.5) * (16 / columns))});
            sum += at;
        }
        EXPECT_EQ(cells.size(), 16u) << columns;
        EXPECT_EQ(sum, glm::dvec2(0));
    }
}

// A point that a camera sees at the centre of a pixel moves by the offset in the other direction.
TEST(FrameSamples, ShiftPerspectiveAndOrthographicImages)
{
    for (const bool orthographic : {false, true}) {
        const Camera camera{.position = {1, 2, 3}, .orthographic = orthographic, .farPlane = 100};
        const PixelSize size{200, 100};
        const auto pixelOf = [&](const CndCamera& c, const glm::dvec4& view) {
            glm::dvec4 clip(0);
            for (int column = 0; column < 4; ++column)
                for (int row = 0; row < 4; ++row)
                    clip[row] += c.clipFromView[4 * column + row] * view[column];
            return (glm::dvec2(clip) / clip.w * 0.5 + 0.5) * glm::dvec2(size.width, size.height);
        };
        const glm::dvec4 point(0.1, 0.2, -4, 1);
        CndCamera shifted = makeCamera(camera, 2);
        const glm::dvec2 before = pixelOf(shifted, point);
        const FrameSample sample{3, 16};
        shiftBySample(shifted, sample, size);
        const glm::dvec2 moved = pixelOf(shifted, point) - before;
        EXPECT_NEAR(glm::length(moved + sampleOffset(sample)), 0, 1e-4) << orthographic;
    }
}

TEST(NumberedName, HasOnePlace)
{
    EXPECT_EQ(numberedName("-o", "a/f.%04d.png", 7), "a/f.0007.png");
    EXPECT_EQ(numberedName("-o", "%d", 12), "12");
    EXPECT_EQ(numberedName("-o", "50%_%02d%", 123), "50%_123%");
    EXPECT_EQ(numberedName("-o", "%0d", 5), "5");
    EXPECT_EQ(numberedName("-o", "%012d", 5), "000000000005");
    for (const char* without : {"f.png", "100%.png", "%s", "%", "%0", "%04"})
        EXPECT_FALSE(isNumbered(without)) << without;
    for (const char* wrong : {"%4d.png", "f%0000d", "f%00000000000000000004d", "%0%4d"}) {
        EXPECT_TRUE(isNumbered(wrong)) << wrong;
        EXPECT_THROW(numberedName("-o", wrong, 0), UsageError) << wrong;
    }
    EXPECT_THROW(numberedName("-o", "f.png", 0), UsageError);
    EXPECT_THROW(numberedName("-o", "%d-%d.png", 0), UsageError);
}

TEST(CameraPath, TurnsOnceAroundTheVertical)
{
    const Camera first{.position = {0, 0, 10}};
    EXPECT_EQ(cameraAt(first, CameraPath::Still, 3, 5), first);
    const Camera turned = cameraAt(first, CameraPath::Turn, 1, 4);
    EXPECT_EQ(turned.position, first.position);
    EXPECT_NEAR(glm::distance(turned.forward, glm::dvec3(-1, 0, 0)), 0, 1e-12);
}
