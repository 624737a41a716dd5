// SPDX-License-Identifier: Apache-2.0
// Every fuzzer defines a function that processes one input, and valid inputs to start from.
// The function is called by libFuzzer's driver (preset fuzz) or by mutations.cpp.
#pragma once

#include <cstddef>
#include <cstdint>
#include <cstdlib>
#include <filesystem>
#include <fstream>
#include <iostream>
#include <string>
#include <vector>

#include <unistd.h>

// Returns 0. An exception that it throws, or a fault that a sanitizer finds, is a finding.
extern "C" int LLVMFuzzerTestOneInput(const uint8_t* data, size_t size);

namespace candelabra::test
{

using Seeds = std::vector<std::string>;
Seeds fuzzSeeds();

// Writes the input to a file for loaders that read files, and returns its path, which is specific
// to this process.
inline std::string fuzzFile(const uint8_t* data, size_t size, const std::string& extension)
{
    static const std::string folder = [] {
        const auto path = std::filesystem::temp_directory_path() /
                          ("candelabra_fuzz_" + std::to_string(getpid()));
        std::filesystem::create_directories(path);
        std::atexit([] {
            std::filesystem::remove_all(std::filesystem::temp_directory_path() /
                                        ("candelabra_fuzz_" + std::to_string(getpid())));
        });
        return path.string();
    }();
    const std::string path = folder + "/input" + extension;
    std::ofstream(path, std::ios::binary)
        .write(reinterpret_cast<const char*>(data), std::streamsize(size));
    return path;
}

inline std::string fileText(const std::string& path)
{
    std::ifstream file(path, std::ios::binary);
    return {std::istreambuf_iterator<char>(file), {}};
}

inline void require(bool holds, const std::string& what)
{
    if (holds)
        return;
    std::cerr << "broken: " << what << "\n";
    std::abort();
}

} // namespace candelabra::test
