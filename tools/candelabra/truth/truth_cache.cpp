// SPDX-License-Identifier: Apache-2.0
#include "truth/truth_cache.h"

#include <cstdlib>
#include <filesystem>

#include <fmt/format.h>
#include <spdlog/spdlog.h>

namespace candelabra::app
{

TruthCache TruthCache::standard()
{
    // The XDG Base Directory Specification has paths that are not absolute ignored.
    const char* cache = std::getenv("XDG_CACHE_HOME");
    if (cache && cache[0] == '/')
        return TruthCache(std::string(cache) + "/candelabra/truth");
    const char* home = std::getenv("HOME");
    if (home && home[0] == '/')
        return TruthCache(std::string(home) + "/.cache/candelabra/truth");
    return {};
}

std::string TruthCache::file(const TruthShard& shard) const
{
    return fmt::format("{}/{:016x}-{}x{}-{:g}-{}of{}.truth", directory_, shard.scene, shard.width,
                       shard.height, shard.tolerance, shard.index, shard.count);
}

bool TruthCache::find(TruthShard& wanted) const
{
    std::error_code ignored;
    if (directory_.empty() || !std::filesystem::exists(file(wanted), ignored))
        return false;
    try {
        TruthShard found = loadTruthShard(file(wanted));
        if (found.scene != wanted.scene || found.width != wanted.width ||
            found.height != wanted.height || found.tolerance != wanted.tolerance ||
            found.index != wanted.index || found.count != wanted.count)
            return false;
        wanted = std::move(found);
        return true;
    } catch (const ImageError& error) {
        spdlog::warn("warning: cache: {}", error.what());
        return false;
    }
}

void TruthCache::store(const TruthShard& shard) const
{
    if (directory_.empty())
        return;
    try {
        std::filesystem::create_directories(directory_);
        saveTruthShard(file(shard), shard);
    } catch (const std::exception& error) {
        spdlog::warn("warning: cache: {}", error.what());
    }
}

} // namespace candelabra::app
