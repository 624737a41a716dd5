// SPDX-License-Identifier: Apache-2.0
// Tests CacheFolder in a folder of the test's own.
#include <cstdlib>
#include <filesystem>
#include <fstream>

#include <gtest/gtest.h>
#include <unistd.h>

#include "io/cache_folder.h"

using namespace candelabra::app;

namespace
{

using Bytes = std::vector<uint8_t>;

class CacheFolderTest : public testing::Test
{
protected:
    void TearDown() override { std::filesystem::remove_all(base_); }

    std::string file(const std::string& name) const { return folder_ + "/" + name; }
    Bytes read(const std::string& name) const
    {
        std::ifstream in(file(name), std::ios::binary);
        return Bytes((std::istreambuf_iterator<char>(in)), {});
    }
    void write(const std::string& name, const Bytes& bytes) const
    {
        std::ofstream out(file(name), std::ios::binary);
        out.write(reinterpret_cast<const char*>(bytes.data()), std::streamsize(bytes.size()));
    }
    size_t files() const
    {
        return size_t(std::distance(std::filesystem::directory_iterator(folder_), {}));
    }
    // Makes a file look as if it had been used so many seconds ago.
    void age(const std::string& name, int seconds) const
    {
        std::filesystem::last_write_time(file(name), std::filesystem::file_time_type::clock::now() -
                                                         std::chrono::seconds(seconds));
    }

    const std::string base_ =
        testing::TempDir() + "candelabra_cache_folder_test_" + std::to_string(::getpid());
    const std::string folder_ = base_ + "/deep/er";
};

} // namespace

TEST_F(CacheFolderTest, FindsWhatWasStored)
{
    const CacheFolder cache(folder_);
    EXPECT_FALSE(cache.find("a"));
    EXPECT_FALSE(std::filesystem::exists(folder_));
    cache.store("a", Bytes{1, 2, 3});
    cache.store("empty", Bytes{});
    cache.store("a", Bytes{4, 5});
    EXPECT_EQ(cache.find("a"), (Bytes{4, 5}));
    EXPECT_EQ(cache.find("empty"), Bytes{});
    EXPECT_FALSE(cache.find("b"));
    EXPECT_EQ(files(), 2u);
}

TEST_F(CacheFolderTest, DoesNotTrustWhatItDidNotStore)
{
    const CacheFolder cache(folder_);
    cache.store("a", Bytes{1, 2, 3});
    const Bytes good = read("a");
    for (size_t at = 0; at < good.size(); ++at) {
        Bytes bad = good;
        bad[at] ^= 0x10;
        write("a", bad);
        EXPECT_FALSE(cache.find("a")) << "byte " << at;
        write("a", Bytes(good.begin(), good.begin() + std::ptrdiff_t(at)));
        EXPECT_FALSE(cache.find("a")) << at << " bytes are left";
    }
    Bytes longer = good;
    longer.push_back(0);
    write("a", longer);
    EXPECT_FALSE(cache.find("a"));
    write("b", good); // of another name
    EXPECT_FALSE(cache.find("b"));
    std::filesystem::remove(file("a"));
    std::filesystem::create_directory(file("a"));
    EXPECT_FALSE(cache.find("a"));
    cache.store("a", Bytes{7}); // fails without an error
    EXPECT_FALSE(cache.find("a"));
    write("c", good);
    cache.store("c", Bytes{8});
    EXPECT_EQ(cache.find("c"), Bytes{8});
}

TEST_F(CacheFolderTest, RemovesWhatHasNotBeenUsedForLongest)
{
    const CacheFolder cache(folder_, 400);
    for (const char* name : {"a", "b", "c"})
        cache.store(name, Bytes(100));
    EXPECT_EQ(files(), 3u);
    age("a", 300);
    age("b", 200);
    age("c", 100);
    EXPECT_TRUE(cache.find("a")); // now the last one used
    cache.store("d", Bytes(100));
    EXPECT_FALSE(cache.find("b"));
    for (const char* name : {"a", "c", "d"})
        EXPECT_TRUE(cache.find(name)) << name;
    cache.store("large", Bytes(400)); // larger than all together may be
    EXPECT_EQ(files(), 3u);
    cache.store("most", Bytes(384));
    EXPECT_TRUE(cache.find("most"));
    EXPECT_EQ(files(), 1u);
}

TEST_F(CacheFolderTest, KeepsNothingWithoutAFolder)
{
    const CacheFolder none;
    EXPECT_FALSE(none.keeps());
    none.store("a", Bytes{1});
    EXPECT_FALSE(none.find("a"));
    std::filesystem::create_directories(folder_);
    write("file", {});
    const CacheFolder below(file("file")); // a folder of this name cannot be made
    below.store("a", Bytes{1});
    EXPECT_FALSE(below.find("a"));
    EXPECT_EQ(files(), 1u);
}

TEST_F(CacheFolderTest, StandardFoldersAreThoseOfXdg)
{
    const auto variable = [](const char* name) {
        const char* value = std::getenv(name);
        return std::string(value ? value : "");
    };
    const std::string cache = variable("XDG_CACHE_HOME"), home = variable("HOME");
    setenv("XDG_CACHE_HOME", "/x", 1);
    setenv("HOME", "/h", 1);
    EXPECT_EQ(standardCacheFolder("part"), "/x/candelabra/part");
    setenv("XDG_CACHE_HOME", "relative", 1);
    EXPECT_EQ(standardCacheFolder("part"), "/h/.cache/candelabra/part");
    unsetenv("XDG_CACHE_HOME");
    EXPECT_EQ(standardCacheFolder("part"), "/h/.cache/candelabra/part");
    setenv("HOME", "relative", 1);
    EXPECT_EQ(standardCacheFolder("part"), "");
    unsetenv("HOME");
    EXPECT_EQ(standardCacheFolder("part"), "");
    setenv("HOME", home.c_str(), 1);
    if (!cache.empty())
        setenv("XDG_CACHE_HOME", cache.c_str(), 1);
}
