// SPDX-License-Identifier: Apache-2.0
// Fuzzes the parsing of option values: cameras, sizes, numbers.
#include <cmath>

#include "fuzz/fuzz_target.h"
#include "io/error.h"
#include "io/parse.h"
#include "render/camera.h"

namespace candelabra::test
{

Seeds fuzzSeeds()
{
    return {"0,1,2,3,4,5", "1e3,-2.5,0.25,0,0,0,60", "front", "1",   "1280x720",
            "16384x1",     "1e-5,4294967295",        "-0.0",  "0x10"};
}

} // namespace candelabra::test

extern "C" int LLVMFuzzerTestOneInput(const uint8_t* data, size_t size)
{
    using namespace candelabra;
    const std::string text(data, data + size);
    if (const auto number = app::parseNumber(text))
        test::require(std::isfinite(*number), "a number that is none");
    if (const auto numbers = app::parseNumbers(text))
        for (const double number : *numbers)
            test::require(std::isfinite(number), "a list with a number that is none");
    if (const auto parsed = app::parseSize(text))
        test::require(parsed->width && parsed->height, "a size of nothing");
    (void)app::parseUnsigned(text);
    app::Scene scene;
    scene.cameras = {{.name = "front"}, {.name = "above"}};
    try {
        const app::Camera camera = app::selectCamera(scene, text);
        test::require(std::abs(glm::length(camera.forward) - 1) < 1e-6, "forward is not unit");
        test::require(std::isfinite(glm::length(camera.position)), "position");
        test::require(camera.verticalFov > 0 && camera.verticalFov < 3.15, "field of view");
    } catch (const app::UsageError&) {
    }
    return 0;
}
