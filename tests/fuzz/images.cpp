// SPDX-License-Identifier: Apache-2.0
// Fuzzes the loaders of floating-point images; the first byte chooses the format.
#include "fuzz/fuzz_target.h"
#include "io/image.h"

namespace
{

constexpr const char* extensions[] = {".hdr", ".exr", ".pfm"};

} // namespace

namespace candelabra::test
{

Seeds fuzzSeeds()
{
    Seeds out;
    for (const uint32_t width : {1u, 9u, 33u})
        for (const uint32_t channels : {1u, 3u}) {
            app::Image image{.width = width, .height = 3, .channels = channels};
            for (uint32_t i = 0; i < width * 3 * channels; ++i)
                image.pixels.push_back(float(i / 4) * 0.25f); // contains runs of equal values
            for (size_t format = 0; format < std::size(extensions); ++format) {
                const std::string path = fuzzFile(nullptr, 0, extensions[format]);
                app::saveImageByExtension(path, image);
                out.push_back(char('0' + format) + fileText(path));
            }
        }
    return out;
}

} // namespace candelabra::test

extern "C" int LLVMFuzzerTestOneInput(const uint8_t* data, size_t size)
{
    using namespace candelabra;
    if (!size)
        return 0;
    const char* extension = extensions[data[0] % std::size(extensions)];
    try {
        const app::Image image =
            app::loadImageByExtension(test::fuzzFile(data + 1, size - 1, extension));
        test::require(image.channels == 1 || image.channels == 3, "channels");
        test::require(image.pixels.size() == size_t(image.width) * image.height * image.channels,
                      "number of pixels");
    } catch (const app::ImageError&) {
    }
    return 0;
}
