// SPDX-License-Identifier: Apache-2.0
// Fuzzes the loader of scene descriptions (.json).
#include "json/scene_json.h"
#include "fuzz/fuzz_target.h"
#include "harness/paths.h"
#include "scene/scene_error.h"
#include "unit/scene_invariants.h"

namespace candelabra::test
{

Seeds fuzzSeeds()
{
    return {fileText(dataPath("every_light.json")),
            R"({"camera": {"eye": [0, 1, 4], "target": [0, 0, 0], "fov": 45}, "objects": [],
                "lights": []})"};
}

} // namespace candelabra::test

extern "C" int LLVMFuzzerTestOneInput(const uint8_t* data, size_t size)
{
    using namespace candelabra;
    try {
        const app::Scene scene = app::loadSceneJson(test::fuzzFile(data, size, ".json"));
        const std::string broken = test::brokenInvariant(scene);
        test::require(broken.empty(), broken);
    } catch (const app::SceneError&) {
    }
    return 0;
}
