// SPDX-License-Identifier: Apache-2.0
// Folders of files that can be computed anew. Such a file may be lost at any time, is never trusted
// unless it is exactly what was stored, and failing to store it is no error.
#pragma once

#include <cstdint>
#include <optional>
#include <span>
#include <string>
#include <vector>

namespace candelabra::app
{

// Returns $XDG_CACHE_HOME/candelabra/PART or $HOME/.cache/candelabra/PART, which need not exist. If
// neither variable holds an absolute path, returns an empty text. `part` says what the files are.
std::string standardCacheFolder(const std::string& part);

class CacheFolder
{
public:
    // A cache that keeps nothing and finds nothing.
    CacheFolder() = default;
    // `folder` is created when something is stored; if it is empty, the cache keeps nothing. The
    // files in it have at most `mostBytes` together: when something is stored, those that have not
    // been used for longest are removed. Nothing else may be kept in the folder.
    explicit CacheFolder(std::string folder, uint64_t mostBytes = uint64_t(1) << 30)
        : folder_(std::move(folder)), mostBytes_(mostBytes)
    {
    }

    bool keeps() const { return !folder_.empty(); }
    // Returns what was last stored under a name, or nothing if that is not there or is damaged.
    // Names are those of files.
    std::optional<std::vector<uint8_t>> find(const std::string& name) const;
    // Stores the bytes, which other processes find entirely or not at all. Does nothing if they
    // would take more than the folder may hold, or if the file cannot be written.
    void store(const std::string& name, std::span<const uint8_t> bytes) const;

private:
    void removeOldest() const;

    std::string folder_;
    uint64_t mostBytes_ = 0;
};

} // namespace candelabra::app
