// SPDX-License-Identifier: Apache-2.0
// For libFuzzer, whose driver does not know fuzzSeeds(): writes them as the files of a corpus.
//   fuzz_X --write-seeds=DIRECTORY
#include "fuzz/fuzz_target.h"

extern "C" int LLVMFuzzerInitialize(int* argc, char*** argv)
{
    const std::string option = "--write-seeds=", given = *argc == 2 ? (*argv)[1] : "";
    if (!given.starts_with(option))
        return 0;
    const std::string folder = given.substr(option.size());
    std::filesystem::create_directories(folder);
    int index = 0;
    for (const std::string& seed : candelabra::test::fuzzSeeds()) {
        const std::string path = folder + "/seed-" + std::to_string(index++);
        std::ofstream file(path, std::ios::binary);
        file << seed;
        candelabra::test::require(file.flush().good(), "cannot write " + path);
    }
    std::exit(0);
}
