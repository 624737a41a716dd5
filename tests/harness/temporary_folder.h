// SPDX-License-Identifier: Apache-2.0
// A folder for the files of one test, which no other test and no other process uses.
#pragma once

#include <cstdint>
#include <filesystem>
#include <fstream>
#include <sstream>
#include <stdexcept>
#include <string>
#include <vector>

#include <gtest/gtest.h>
#include <stdlib.h>

namespace candelabra::test
{

// A folder that exists as long as this object. Test fixtures may derive from it.
class TemporaryFolder
{
public:
    TemporaryFolder()
    {
        std::string name = testing::TempDir() + "candelabra-XXXXXX";
        if (!mkdtemp(name.data()))
            throw std::runtime_error("cannot create " + name);
        folder_ = name;
    }
    ~TemporaryFolder()
    {
        std::error_code ignored;
        std::filesystem::remove_all(folder_, ignored);
    }
    TemporaryFolder(const TemporaryFolder&) = delete;
    TemporaryFolder& operator=(const TemporaryFolder&) = delete;

    // The path of a file, or of the folder.
    std::string path(const std::string& name = "") const { return (folder_ / name).string(); }
    // What a file holds; empty if there is none.
    std::string text(const std::string& name) const
    {
        std::stringstream content;
        content << std::ifstream(folder_ / name, std::ios::binary).rdbuf();
        return content.str();
    }

    // Both write a file, make the folders that it needs, and return its path.
    std::string write(const std::string& name, const std::string& text) const
    {
        return write(name, std::vector<uint8_t>(text.begin(), text.end()));
    }
    std::string write(const std::string& name, const std::vector<uint8_t>& bytes) const
    {
        const std::string file = path(name);
        std::filesystem::create_directories(std::filesystem::path(file).parent_path());
        std::ofstream out(file, std::ios::binary);
        out.write(reinterpret_cast<const char*>(bytes.data()),
                  static_cast<std::streamsize>(bytes.size()));
        if (!out.flush())
            throw std::runtime_error("cannot write " + file);
        return file;
    }

private:
    std::filesystem::path folder_;
};

} // namespace candelabra::test
