// SPDX-License-Identifier: Apache-2.0
// Cuts over several frames: they repeat, do not jump or flicker, and rise only after all pixels
// have been seen, in images of any size.
#include "gpu/influence_harness.h"
#include "harness/full_tests.h"

namespace candelabra::test
{
namespace
{

// Returns the number of frames in which every pixel of a square is seen once.
constexpr uint32_t period(uint32_t spacing)
{
    return spacing * spacing;
}

TEST_F(InfluenceTest, HistoriesRepeatAndNeitherJumpNorFlicker)
{
    const CpuGBuffer g = surfaces();
    create(g, brightAndDim(g));
    CndInfluence influence{
        .rule = CND_INFLUENCE_BY_ERROR, .maxError = 8.0f / 255, .exposure = exposureFor(uncut())};
    std::vector<float> cuts; // illuminance after exposure
    const auto frames = [&](bool white, uint32_t count) {
        base_ = white ? 2 / influence.exposure : 0;
        for (uint32_t i = 0; i < count; ++i)
            cuts.push_back(draw(influence).cutBelow * influence.exposure);
    };
    constexpr uint32_t all = period(gpu::INFLUENCE_MIN_SPACING);
    frames(true, all); // in these frames no light can be seen
    for (size_t i = 1; i < cuts.size(); ++i)
        EXPECT_LE(cuts[i], cuts[i - 1]) << i;
    const float settled = cuts.back();
    EXPECT_GT(settled, 0);
    // One frame in which less may be missing: cuts fall at once, and stay for a whole period.
    const std::vector<glm::vec4> before = readRadiance(images_);
    frames(false, 1);
    const float fallen = cuts.back();
    EXPECT_LT(fallen, settled);
    frames(true, all - 1);
    EXPECT_EQ(cuts.back(), fallen);
    frames(true, all + gpu::INFLUENCE_BINS);
    EXPECT_EQ(cuts.back(), settled);
    for (size_t i = all + 1; i < cuts.size(); ++i)
        EXPECT_LE(cuts[i], cuts[i - 1] * 1.415f) << i;
    EXPECT_TRUE(sameBits(readRadiance(images_), before));

    // Another error starts a new history, and so does going back to the first: the bits are the
    // same.
    base_ = 0;
    influence.maxError *= 2;
    draw(influence);
    influence.maxError /= 2;
    EXPECT_GT(draw(influence).cutBelow, 0);
    const std::vector<glm::vec4> first = readRadiance(images_);
    EXPECT_TRUE(sameBits(run(g, brightAndDim(g), {.influence = influence}).radiance, first));
}

// An image with so many 8x8 squares that 16x16 squares are used: cuts rise only after a full period
// of 256 frames (instead of 64) in which no frame cut less.
TEST_F(InfluenceTest, CutsOfLargeImagesRiseOnceAllPixelsWereSeen)
{
    CndCamera camera;
    setPerspective(camera, 1.0, 4.0, 0.1);
    CpuGBuffer g = randomGBuffer(1032, 256, camera, 0, 11);
    ASSERT_GT(g.width / 8 * (g.height / 8), gpu::INFLUENCE_MAX_SAMPLES);
    for (uint32_t i = 0; i < g.width * g.height; ++i)
        if (i % g.width >= 32 || i / g.width >= 32)
            g.depth[i] = g.clearDepth;
    std::vector<CndLight> lights = brightAndDim(g);
    lights.resize(20);
    create(g, lights);
    const CndInfluence influence{
        .rule = CND_INFLUENCE_BY_ERROR, .maxError = 8.0f / 255, .exposure = exposureFor(uncut())};
    const float white = 2 / influence.exposure;
    base_ = white;
    const float settled = draw(influence).cutBelow;
    base_ = 0;
    const float fallen = draw(influence).cutBelow;
    EXPECT_LT(fallen, settled);
    base_ = white;
    // The first period contains a frame that cut less, the second contains none.
    constexpr uint32_t rises = 2 * period(16);
    const uint32_t frames = fullTests() ? rises : 2 * period(8) + 20;
    for (uint32_t i = 2; i < frames; ++i)
        ASSERT_EQ(draw(influence).cutBelow, fallen) << i;
    if (frames == rises) {
        EXPECT_GT(draw(influence).cutBelow, fallen);
    }
}

// More pixels than a history starts with: the following frames continue where it ended.
TEST_F(InfluenceTest, HistoriesOfHugeImagesBeginWithAPart)
{
    CpuGBuffer g = surfaces();
    CpuGBuffer huge{.width = 1056, .height = 1024, .camera = g.camera};
    ASSERT_GT(huge.width / 16 * (huge.height / 16), gpu::INFLUENCE_MAX_SAMPLES);
    const size_t pixels = size_t(huge.width) * huge.height;
    huge.depth.assign(pixels, huge.clearDepth);
    huge.normalRoughness.resize(pixels);
    huge.albedo.resize(pixels);
    huge.specular.resize(pixels);
    // The only surface: in the first 32x32 square, pixel (0, 1) is the 257th that is seen.
    static_assert(gpu::INFLUENCE_MAX_ROUNDS == 256);
    CpuGBuffer one{.camera = g.camera};
    addPixel(one, {.depth = depthAt(g.camera, 5), .albedo = glm::vec3(0.5f)});
    huge.depth[huge.width] = one.depth[0];
    huge.normalRoughness[huge.width] = one.normalRoughness[0];
    huge.albedo[huge.width] = one.albedo[0];
    const glm::dvec3 p = viewPosition(huge, 0, 1);
    CndLight light{.type = CND_LIGHT_SPHERE, .radius = 0.1f, .influenceRadius = 5};
    for (int axis = 0; axis < 3; ++axis)
        light.position[axis] = float(p[axis]) + (axis == 2 ? 1.0f : 0.0f);
    std::fill_n(light.emission, 3, 100.0f);
    create(huge, {light});
    const CndInfluence influence{
        .rule = CND_INFLUENCE_BY_ERROR, .maxError = 1.0f / 255, .exposure = 0.01f};
    const float unseen = draw(influence).cutBelow;
    EXPECT_FLOAT_EQ(unseen * influence.exposure,
                    std::exp2(0.5f * (gpu::INFLUENCE_BINS - 1 - gpu::INFLUENCE_COARSE_BINS) +
                              gpu::INFLUENCE_FINEST));
    EXPECT_LT(draw(influence).cutBelow, unseen);
    EXPECT_GT(glm::length(glm::dvec3(readRadiance(images_)[huge.width])), 0);
}

TEST_F(InfluenceTest, ListsAreKeptWithTheirRadii)
{
    const CpuGBuffer g = surfaces();
    create(g, brightAndDim(g));
    const CndInfluence influence{
        .rule = CND_INFLUENCE_BY_ERROR, .maxError = 8.0f / 255, .exposure = exposureFor(uncut())};
    const CndLightingStats made = draw(influence);
    const std::vector<glm::vec4> image = readRadiance(images_);
    EXPECT_EQ(skipped(made, "measure_influence"), "");
    // Measuring continues.
    const CndLightingStats again = draw(influence, true);
    EXPECT_EQ(skipped(again, "measure_influence"), "");
    EXPECT_EQ(skipped(again, "cluster_lists"), "");
    EXPECT_EQ(again.cutBelow, made.cutBelow);
    EXPECT_TRUE(sameBits(readRadiance(images_), image));
    EXPECT_EQ(skipped(draw({}, true), "cluster_lists"), "");
    EXPECT_EQ(skipped(draw({}, true), "measure_influence"), "not asked for");
}

} // namespace
} // namespace candelabra::test
