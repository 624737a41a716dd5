// SPDX-License-Identifier: Apache-2.0
// Fuzzes the reader of truth image shards.
#include "fuzz/fuzz_target.h"
#include "truth/truth_file.h"

namespace candelabra::test
{

Seeds fuzzSeeds()
{
    app::TruthShard shard{.scene = 0x1234567890abcdef,
                          .width = 4,
                          .height = 5,
                          .tolerance = 1e-4,
                          .index = 2,
                          .count = 3};
    shard.pixels.assign(shard.rows().size() * 12, 0.5f);
    const std::string path = fuzzFile(nullptr, 0, ".truth");
    app::saveTruthShard(path, shard);
    return {fileText(path)};
}

} // namespace candelabra::test

extern "C" int LLVMFuzzerTestOneInput(const uint8_t* data, size_t size)
{
    using namespace candelabra;
    try {
        const app::TruthShard shard = app::loadTruthShard(test::fuzzFile(data, size, ".truth"));
        test::require(shard.pixels.size() == shard.rows().size() * shard.width * 3,
                      "number of pixels");
    } catch (const app::ImageError&) {
    }
    return 0;
}
