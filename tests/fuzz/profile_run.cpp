// SPDX-License-Identifier: Apache-2.0
// Results of `candelabra profile`, which `compare` reads.
#include <cmath>

#include "commands/run_file.h"
#include "fuzz/fuzz_target.h"
#include "render/error.h"
#include "scene/load.h"

namespace candelabra::test
{

Seeds fuzzSeeds()
{
    const std::string run =
        R"({"schema": "candelabra profile 1",
            "provenance": {"device": "d", "driver": "e", "commit": "c"},
            "scene": {"name": "hall"}, "image": {"widthPixels": 64}, "path": "still",
            "variants": [{"settings": {"specular": "conic"}, "time": {
                "passes": [{"name": "shade_tiles", "medianMs": 12.5}],
                "gpu": {"medianMs": 14}, "record": {"medianMs": 0.5}, "frame": {"medianMs": 20},
                "setLights": {"medianMs": 0.1}}}]})";
    return {run, "[" + run + ", " + run + "]"};
}

} // namespace candelabra::test

extern "C" int LLVMFuzzerTestOneInput(const uint8_t* data, size_t size)
{
    using namespace candelabra;
    try {
        for (const app::ProfiledRun& run : app::readRuns(test::fuzzFile(data, size, ".json")))
            for (const auto& [name, ms] : run.medianMs)
                test::require(std::isfinite(ms) && ms >= 0, "time of " + name);
    } catch (const app::SceneError&) {
    } catch (const app::UsageError&) {
    }
    return 0;
}
