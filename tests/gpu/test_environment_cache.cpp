// SPDX-License-Identifier: Apache-2.0
// Tests that environments from the cache are those that the device prepares, bit for bit.
#include <algorithm>
#include <cmath>
#include <filesystem>
#include <fstream>

#include <unistd.h>

#include "harness/gpu_fixture.h"
#include "render/check.h"
#include "render/scene_environment.h"

using namespace candelabra;
using namespace candelabra::app;

namespace
{

using Bytes = std::vector<uint8_t>;

class EnvironmentCache : public test::GpuTest
{
protected:
    void TearDown() override
    {
        GpuTest::TearDown();
        std::filesystem::remove_all(folder_);
    }
    // A sky whose colours differ everywhere.
    static SceneEnvironment sky(uint32_t width, float brightness = 1)
    {
        SceneEnvironment out{.radiance = {.width = width, .height = width / 2, .channels = 3}};
        for (uint32_t i = 0; i < width * (width / 2) * 3; ++i)
            out.radiance.pixels.push_back(brightness * (1.5f + std::sin(float(i) * 0.37f)));
        return out;
    }
    // Returns what shading would read.
    Bytes prepared(const SceneEnvironment& environment, const CacheFolder& cache) const
    {
        const Environment out = uploadEnvironment(context(), environment, {.cache = cache});
        const CndEnvironmentMapInfo info = take(out.mapInfo());
        const gpu::Buffer bytes =
            gpu::createBuffer(device(), "prepared map", info.size, VK_BUFFER_USAGE_TRANSFER_DST_BIT,
                              gpu::MemoryUse::Readback);
        context().submitAndWait([&](VkCommandBuffer cmd) {
            take(out.recordMapSave(cmd, {.buffer = bytes.get(), .size = info.size}));
        });
        const auto all = bytes.as<const uint8_t>();
        return {all.begin(), all.end()};
    }
    std::vector<std::filesystem::path> files() const
    {
        std::vector<std::filesystem::path> out;
        for (const auto& entry : std::filesystem::directory_iterator(folder_))
            out.push_back(entry.path());
        return out;
    }

    const std::string folder_ =
        testing::TempDir() + "candelabra_environment_cache_test_" + std::to_string(::getpid());
};

} // namespace

TEST_F(EnvironmentCache, HasTheBitsThatTheDevicePrepares)
{
    const CacheFolder cache(folder_);
    const SceneEnvironment first = sky(64);
    const Bytes fresh = prepared(first, {});
    EXPECT_FALSE(std::filesystem::exists(folder_));
    EXPECT_EQ(prepared(first, cache), fresh); // is stored
    ASSERT_EQ(files().size(), 1u);
    EXPECT_EQ(prepared(first, cache), fresh); // is found
    // That it is found, not computed again, is seen by storing something else.
    const std::string name = files()[0].filename().string();
    Bytes other = fresh;
    other[0] ^= 1;
    cache.store(name, other);
    EXPECT_EQ(prepared(first, cache), other);
    // What has another size, or is damaged, is computed and stored again.
    cache.store(name, std::span(fresh).first(fresh.size() - 16));
    EXPECT_EQ(prepared(first, cache), fresh);
    EXPECT_EQ(cache.find(name), fresh);
    for (const size_t at : {size_t(0), fresh.size() / 2, fresh.size() + 3}) {
        std::fstream file(files()[0], std::ios::in | std::ios::out | std::ios::binary);
        file.seekg(std::streamoff(at));
        const char byte = char(file.get());
        file.seekp(std::streamoff(at));
        file.put(char(byte ^ 4));
        file.close();
        EXPECT_FALSE(cache.find(name));
        EXPECT_EQ(prepared(first, cache), fresh) << at;
        EXPECT_EQ(cache.find(name), fresh) << at;
    }
    EXPECT_EQ(files().size(), 1u);
}

TEST_F(EnvironmentCache, TellsImagesApart)
{
    const CacheFolder cache(folder_);
    SceneEnvironment changed = sky(64);
    changed.radiance.pixels.back() += 1e-6f;
    SceneEnvironment turned = sky(64);
    std::swap(turned.radiance.width, turned.radiance.height); // the same values in another order
    size_t count = 0;
    for (const SceneEnvironment& environment :
         {sky(64), sky(64, 2), changed, turned, sky(128), sky(512)}) {
        const Bytes cold = prepared(environment, cache);
        EXPECT_EQ(files().size(), ++count);
        EXPECT_EQ(prepared(environment, cache), cold);
    }
    SceneEnvironment brighter = sky(64); // the factor and the rotation are applied when shading
    brighter.scale = 7;
    brighter.rotation = 1;
    prepared(brighter, cache);
    EXPECT_EQ(files().size(), count);
}
