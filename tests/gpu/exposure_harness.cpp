// SPDX-License-Identifier: Apache-2.0
#include "gpu/exposure_harness.h"
#include "gpu/fill_image.h"
#include "harness/constants.h"

#include <cmath>
#include <limits>

namespace candelabra::test
{
namespace
{

float specialValue(std::mt19937& random)
{
    const float sign = random() % 4 ? 1.0f : -1.0f;
    const auto edge = [&] {
        return std::ldexp(1.0f + float(random() % 8) / 8, int(random() % 32) - 12);
    };
    switch (random() % 8) {
    case 0:
        return sign * 0.0f;
    case 1:
        return sign * infinity;
    case 2:
        return sign * std::numeric_limits<float>::quiet_NaN();
    case 3:
        return sign * std::ldexp(float(uniform(random)), -127); // denormal
    case 4:
        return sign * std::numeric_limits<float>::max();
    case 5:
        return edge();
    case 6:
        return std::nextafter(edge(), random() % 2 ? 0.0f : infinity);
    default:
        return -edge();
    }
}

} // namespace

double uniform(std::mt19937& random)
{
    return double(random()) / 4294967296.0;
}

float wildValue(std::mt19937& random)
{
    if (random() % 5 == 0)
        return specialValue(random);
    return float(std::pow(10.0, -10 + 20 * uniform(random)));
}

Picture wildPicture(uint32_t width, uint32_t height, uint32_t seed)
{
    std::mt19937 random(seed);
    Picture p{width, height, {}};
    p.rgba.reserve(size_t(4) * width * height);
    for (size_t i = 0; i < size_t(width) * height; ++i) {
        // Grey pixels reach every bin; where channels differ by decades, one of them decides.
        const float grey = wildValue(random);
        const bool coloured = random() % 2;
        for (int c = 0; c < 3; ++c)
            p.rgba.push_back(coloured ? wildValue(random) : grey);
        p.rgba.push_back(infinity); // alpha is ignored
    }
    return p;
}

Picture greyPicture(uint32_t width, uint32_t height, const std::vector<float>& values)
{
    Picture p{width, height, {}};
    for (const float value : values)
        p.rgba.insert(p.rgba.end(), {value, value, value, 1});
    return p;
}

Picture flatPicture(uint32_t width, uint32_t height, float value)
{
    return greyPicture(width, height, std::vector<float>(size_t(width) * height, value));
}

CndExposureSettings plainSettings()
{
    CndExposureSettings settings{};
    cndDefaultExposureSettings(&settings);
    settings.metering = CND_METERING_AVERAGE;
    settings.dither = VK_FALSE;
    return settings;
}

CndExposureSettings manualSettings(float ev100, CndToneMap curve)
{
    CndExposureSettings settings = plainSettings();
    settings.manual = VK_TRUE;
    settings.manualEv100 = ev100;
    settings.toneMap = curve;
    return settings;
}

void ExposureTest::SetUp()
{
    GpuTest::SetUp();
    if (IsSkipped() || HasFatalFailure())
        return;
    const CndExposureDesc desc{
        .structSize = sizeof desc, .framesInFlight = slotCount, .timestamps = VK_TRUE};
    CndError error{};
    ASSERT_EQ(cndCreateExposure(&deviceDesc(), &desc, &exposure_, &error), CND_SUCCESS)
        << error.message;
}

void ExposureTest::TearDown()
{
    cndDestroyExposure(exposure_);
    GpuTest::TearDown();
}

gpu::Image ExposureTest::toDevice(const Picture& picture) const
{
    gpu::Image image = gpu::createImage(
        device(), "test radiance", VK_FORMAT_R32G32B32A32_SFLOAT, picture.width, picture.height,
        VK_IMAGE_USAGE_SAMPLED_BIT | VK_IMAGE_USAGE_TRANSFER_DST_BIT, VK_IMAGE_ASPECT_COLOR_BIT);
    const gpu::Buffer source = upload("test radiance data", picture.rgba);
    context().submitAndWait([&](VkCommandBuffer cmd) {
        fillImage(cmd, source, image.image.get(), picture.width, picture.height);
    });
    return image;
}

gpu::Image ExposureTest::createDisplay(uint32_t width, uint32_t height) const
{
    gpu::Image image = gpu::createImage(
        device(), "test display", VK_FORMAT_R8G8B8A8_UNORM, width, height,
        VK_IMAGE_USAGE_STORAGE_BIT | VK_IMAGE_USAGE_TRANSFER_SRC_BIT, VK_IMAGE_ASPECT_COLOR_BIT);
    context().submitAndWait([&](VkCommandBuffer cmd) {
        transition(cmd, image.image.get(), VK_IMAGE_ASPECT_COLOR_BIT, VK_IMAGE_LAYOUT_UNDEFINED,
                   VK_IMAGE_LAYOUT_GENERAL);
    });
    return image;
}

CndExposureFrame ExposureTest::frameOf(const gpu::Image& radiance,
                                       const CndExposureSettings& settings) const
{
    return {.structSize = sizeof(CndExposureFrame),
            .width = radiance.width,
            .height = radiance.height,
            .radiance = radiance.view.get(),
            .reset = VK_TRUE,
            .settings = settings};
}

void ExposureTest::record(VkCommandBuffer cmd, const CndExposureFrame& frame) const
{
    CndError error{};
    EXPECT_EQ(cndRecordExposure(exposure_, cmd, &frame, &error), CND_SUCCESS) << error.message;
}

CndExposureStats ExposureTest::stats(uint32_t slot) const
{
    CndExposureStats result{.structSize = sizeof(CndExposureStats)};
    EXPECT_EQ(cndGetExposureStats(exposure_, slot, &result), CND_SUCCESS);
    return result;
}

CndExposureStats ExposureTest::run(const CndExposureFrame& frame) const
{
    context().submitAndWait([&](VkCommandBuffer cmd) { record(cmd, frame); });
    return stats(frame.frameSlot);
}

CndExposureStats ExposureTest::measure(const Picture& picture,
                                       const CndExposureSettings& settings) const
{
    const gpu::Image radiance = toDevice(picture);
    return run(frameOf(radiance, settings));
}

std::vector<uint8_t> ExposureTest::display(const Picture& picture,
                                           const CndExposureSettings& settings, uint32_t seed) const
{
    const gpu::Image radiance = toDevice(picture);
    const gpu::Image target = createDisplay(picture.width, picture.height);
    CndExposureFrame frame = frameOf(radiance, settings);
    frame.display = target.view.get();
    frame.ditherSeed = seed;
    run(frame);
    std::vector<uint8_t> bytes;
    for (const std::byte b :
         readImage(target, VK_IMAGE_ASPECT_COLOR_BIT, VK_IMAGE_LAYOUT_GENERAL, 4))
        bytes.push_back(uint8_t(b));
    return bytes;
}

} // namespace candelabra::test
