// SPDX-License-Identifier: Apache-2.0
#include "io/cache_folder.h"

#include <algorithm>
#include <array>
#include <cstdlib>
#include <cstring>
#include <filesystem>

#include <spdlog/spdlog.h>

#include "io/hash.h"
#include "io/image_file.h"

namespace candelabra::app
{
namespace
{

// A file ends with this number, then the hash of its name and contents.
constexpr uint64_t mark = 0x3165686361636e64; // "dncache1", first byte last
using Ending = std::array<uint64_t, 2>;

Ending endingOf(const std::string& name, std::span<const uint8_t> bytes)
{
    Hash hash;
    hash.add(std::span<const char>(name));
    hash.add(bytes);
    return {mark, hash.value()};
}

} // namespace

std::string standardCacheFolder(const std::string& part)
{
    // The XDG Base Directory Specification has paths that are not absolute ignored.
    const char* cache = std::getenv("XDG_CACHE_HOME");
    if (cache && cache[0] == '/')
        return std::string(cache) + "/candelabra/" + part;
    const char* home = std::getenv("HOME");
    if (home && home[0] == '/')
        return std::string(home) + "/.cache/candelabra/" + part;
    return {};
}

std::optional<std::vector<uint8_t>> CacheFolder::find(const std::string& name) const
{
    const std::string path = folder_ + "/" + name;
    std::error_code ignored;
    if (!keeps() || !std::filesystem::exists(path, ignored))
        return std::nullopt;
    const uintmax_t size = std::filesystem::file_size(path, ignored);
    if (ignored || size > mostBytes_)
        return std::nullopt;
    std::vector<uint8_t> bytes;
    try {
        bytes = readImageFile(path);
    } catch (const std::exception& error) { // ImageError, or no memory
        spdlog::debug("cache: {}", error.what());
        return std::nullopt;
    }
    Ending found;
    if (bytes.size() < sizeof found)
        return std::nullopt;
    std::memcpy(&found, &bytes[bytes.size() - sizeof found], sizeof found);
    bytes.resize(bytes.size() - sizeof found);
    if (found != endingOf(name, bytes)) {
        spdlog::debug("cache: {} is not what was stored", path);
        return std::nullopt;
    }
    std::filesystem::last_write_time(path, std::filesystem::file_time_type::clock::now(), ignored);
    return bytes;
}

void CacheFolder::store(const std::string& name, std::span<const uint8_t> bytes) const
{
    if (!keeps() || bytes.size() + sizeof(Ending) > mostBytes_)
        return;
    try {
        const Ending ending = endingOf(name, bytes);
        std::vector<uint8_t> file(bytes.size() + sizeof ending);
        std::copy(bytes.begin(), bytes.end(), file.begin());
        std::memcpy(&file[bytes.size()], &ending, sizeof ending);
        std::filesystem::create_directories(folder_);
        writeFileAtomically(folder_ + "/" + name, file);
        removeOldest();
    } catch (const std::exception& error) { // of the file system, or ImageError
        spdlog::debug("cache: {}", error.what());
    }
}

void CacheFolder::removeOldest() const
{
    namespace fs = std::filesystem;
    struct File {
        fs::path path;
        fs::file_time_type used;
        uint64_t bytes;
    };
    // Other processes may remove files meanwhile.
    std::error_code gone, notTold;
    std::vector<File> files;
    uint64_t sum = 0;
    for (const fs::directory_entry& entry : fs::directory_iterator(folder_)) {
        const File file{entry.path(), entry.last_write_time(notTold), entry.file_size(gone)};
        if (gone || notTold)
            continue;
        files.push_back(file);
        sum += file.bytes;
    }
    std::sort(files.begin(), files.end(),
              [](const File& a, const File& b) { return a.used < b.used; });
    for (const File& file : files) {
        if (sum <= mostBytes_)
            return;
        if (fs::remove(file.path, gone))
            sum -= file.bytes;
    }
}

} // namespace candelabra::app
