// SPDX-License-Identifier: Apache-2.0
// Fuzzes the parsing of results of `candelabra profile`, as `compare` reads them.
#include <cmath>

#include "fuzz/fuzz_target.h"
#include "io/error.h"
#include "measure/profile/run_file.h"
#include "scene/scene_error.h"

namespace candelabra::test
{

Seeds fuzzSeeds()
{
    const std::string run =
        R"({"schema": "candelabra profile 1",
            "provenance": {"device": "d", "driver": "e", "commit": "c"},
            "scene": {"name": "hall"}, "image": {"widthPixels": 64}, "path": "still",
            "variants": [{"settings": {"specular": "conic"}, "time": {"frames": 60,
                "passes": [{"name": "shade_tiles", "minMs": 12, "medianMs": 12.5}],
                "gpu": {"minMs": 13, "medianMs": 14}, "record": {"minMs": 0.4, "medianMs": 0.5},
                "frame": {"minMs": 19, "medianMs": 20},
                "upload": {"minMs": 0.1, "medianMs": 0.1}}}]})";
    return {run, "[" + run + ", " + run + "]"};
}

} // namespace candelabra::test

extern "C" int LLVMFuzzerTestOneInput(const uint8_t* data, size_t size)
{
    using namespace candelabra;
    try {
        for (const app::ProfiledRun& run : app::readRuns(test::fuzzFile(data, size, ".json")))
            for (const app::ProfiledTime& time : run.times)
                for (const double ms : {time.minMs, time.medianMs})
                    test::require(std::isfinite(ms) && ms >= 0, "time of " + time.name);
    } catch (const app::SceneError&) {
    } catch (const app::UsageError&) {
    }
    return 0;
}
