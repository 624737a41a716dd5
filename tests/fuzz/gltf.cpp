// SPDX-License-Identifier: Apache-2.0
// Fuzzes the glTF 2.0 loader, text and binary, and the cameras that are made for what it loads.
#include "gltf/gltf.h"
#include "fuzz/fuzz_target.h"
#include "load/auto_cameras.h"
#include "scene/scene_error.h"
#include "unit/broken_scene_cases.h"
#include "unit/gltf_builder.h"
#include "unit/gltf_compressed.h"
#include "unit/scene_invariants.h"

namespace candelabra::test
{

Seeds fuzzSeeds()
{
    Seeds out;
    GltfBuilder webp = completeGltf();
    webp.json["images"][0]["bufferView"] = webp.view(smallWebP());
    for (const GltfBuilder& builder :
         {triangleScene(), completeGltf(), webp, meshoptGrid(4),
          dracoGrid(4, DracoMethod::Sequential), dracoGrid(4, DracoMethod::Edgebreaker)}) {
        out.push_back(builder.text());
        const Bytes glb = builder.glb();
        out.emplace_back(glb.begin(), glb.end());
    }
    return out;
}

} // namespace candelabra::test

extern "C" int LLVMFuzzerTestOneInput(const uint8_t* data, size_t size)
{
    using namespace candelabra;
    const bool binary = size >= 4 && std::string(data, data + 4) == "glTF";
    try {
        app::Scene scene = app::loadGltf(test::fuzzFile(data, size, binary ? ".glb" : ".gltf"), {});
        app::addAutomaticCameras(scene, 16.0 / 9);
        const std::string broken = test::brokenInvariant(scene);
        test::require(broken.empty(), broken);
    } catch (const app::SceneError&) {
    }
    return 0;
}
