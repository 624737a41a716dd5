// SPDX-License-Identifier: Apache-2.0
#include "truth/truth_file.h"

#include <algorithm>
#include <cstring>

#include <fmt/format.h>
#include <nlohmann/json.hpp>

#include "io/hash.h"
#include "io/image_file.h"

namespace candelabra::app
{

namespace
{

constexpr const char* format = "candelabra truth 1";
constexpr size_t maxHeader = 4096; // bytes

std::string pixelHash(const TruthShard& shard)
{
    Hash hash;
    hash.add(std::span<const float>(shard.pixels));
    return fmt::format("{:016x}", hash.value());
}

uint64_t fromHex(const std::string& text)
{
    return std::stoull(text, nullptr, 16);
}

// Throws exceptions of nlohmann::json or of std::stoull for members that are missing or malformed.
TruthShard parseHeader(const nlohmann::json& header, const std::string& path)
{
    if (header.at("format") != format)
        failRead(path, "is not a truth file of this version");
    TruthShard shard;
    shard.scene = fromHex(header.at("scene"));
    shard.width = header.at("widthPixels");
    shard.height = header.at("heightPixels");
    shard.tolerance = header.at("tolerance");
    shard.index = header.at("shard");
    shard.count = header.at("shards");
    shard.unconverged = header.at("unconverged");
    return shard;
}

} // namespace

std::vector<uint32_t> TruthShard::rows() const
{
    std::vector<uint32_t> out;
    for (uint32_t row = index - 1; row < height; row += count)
        out.push_back(row);
    return out;
}

void saveTruthShard(const std::string& path, const TruthShard& shard)
{
    const nlohmann::ordered_json header = {{"format", format},
                                           {"scene", fmt::format("{:016x}", shard.scene)},
                                           {"widthPixels", shard.width},
                                           {"heightPixels", shard.height},
                                           {"tolerance", shard.tolerance},
                                           {"shard", shard.index},
                                           {"shards", shard.count},
                                           {"unconverged", shard.unconverged},
                                           {"pixels", pixelHash(shard)}};
    const std::string line = header.dump() + "\n";
    std::vector<uint8_t> bytes(line.size() + shard.pixels.size() * sizeof(float));
    std::memcpy(bytes.data(), line.data(), line.size());
    if (!shard.pixels.empty()) // a shard without rows has no address to copy from
        std::memcpy(bytes.data() + line.size(), shard.pixels.data(),
                    shard.pixels.size() * sizeof(float));
    writeFileAtomically(path, bytes);
}

TruthShard loadTruthShard(const std::string& path)
{
    const std::vector<uint8_t> bytes = readImageFile(path);
    const auto limit = bytes.begin() + std::ptrdiff_t(std::min(bytes.size(), maxHeader));
    const auto end = std::find(bytes.begin(), limit, uint8_t('\n'));
    if (end == limit)
        failRead(path, "is not a truth file");
    TruthShard shard;
    std::string pixels;
    try {
        const auto header = nlohmann::json::parse(bytes.begin(), end);
        shard = parseHeader(header, path);
        pixels = header.at("pixels");
    } catch (const ImageError&) {
        throw;
    } catch (const std::exception&) {
        failRead(path, "is not a truth file");
    }
    const bool sizes = shard.width >= 1 && shard.width <= maxImageSize && shard.height >= 1 &&
                       shard.height <= maxImageSize && shard.index >= 1 &&
                       shard.index <= shard.count && shard.count <= maxImageSize;
    if (!sizes)
        failRead(path, "its header has a size or a number of shards that is out of range");
    const size_t count = 3 * shard.rows().size() * shard.width;
    if (size_t(bytes.end() - end) != 1 + count * sizeof(float))
        failRead(path, "is cut short, or is longer than its header says");
    shard.pixels.resize(count);
    if (count)
        std::memcpy(shard.pixels.data(), &*end + 1, count * sizeof(float));
    if (pixelHash(shard) != pixels)
        failRead(path, "is damaged: its pixels are not those that were written");
    return shard;
}

Image mergeTruthShards(std::span<const std::string> paths, std::span<const TruthShard> shards)
{
    const TruthShard& first = shards[0];
    Image image{first.width, first.height, 3,
                std::vector<float>(size_t{3} * first.width * first.height)};
    std::vector<const std::string*> owner(first.count, nullptr);
    for (size_t i = 0; i < shards.size(); ++i) {
        const TruthShard& shard = shards[i];
        const auto refuse = [&](const std::string& reason) {
            throw ImageError(paths[i] + ": cannot be merged: " + reason);
        };
        if (shard.scene != first.scene)
            refuse("it belongs to another scene, camera or choice of pixels and shadows than " +
                   paths[0]);
        if (shard.width != first.width || shard.height != first.height)
            refuse(fmt::format("its image has {}x{} pixels, that of {} has {}x{}", shard.width,
                               shard.height, paths[0], first.width, first.height));
        if (shard.tolerance != first.tolerance)
            refuse(fmt::format("its tolerance is {:g}, that of {} is {:g}", shard.tolerance,
                               paths[0], first.tolerance));
        if (shard.count != first.count)
            refuse(fmt::format("it is one of {} shards, {} is one of {}", shard.count, paths[0],
                               first.count));
        if (owner[shard.index - 1])
            refuse(fmt::format("{} is shard {} as well", *owner[shard.index - 1], shard.index));
        owner[shard.index - 1] = &paths[i];
        const float* source = shard.pixels.data();
        for (const uint32_t row : shard.rows()) {
            std::copy_n(source, 3 * shard.width, &image.pixels[size_t{3} * shard.width * row]);
            source += 3 * shard.width;
        }
    }
    const auto missing = std::ranges::find(owner, nullptr);
    if (missing != owner.end())
        throw ImageError(fmt::format("{}: cannot be merged: shard {} of {} is missing", paths[0],
                                     missing - owner.begin() + 1, first.count));
    return image;
}

} // namespace candelabra::app
