// SPDX-License-Identifier: Apache-2.0
// Files that hold rows of a truth image, which is integrated in double precision. They are the
// shards of a computation that was split into several. A file is one line of JSON that describes
// it, followed by the pixels as 32-bit float RGB, little-endian.
#pragma once

#include <cstdint>
#include <span>
#include <string>
#include <vector>

#include "io/image.h"

namespace candelabra::app
{

struct TruthShard {
    uint64_t scene = 0; // hash of everything that decides the pixels' exact values
    uint32_t width = 0, height = 0;
    double tolerance = 0;          // relative error allowed in the integration
    uint32_t index = 1, count = 1; // shard `index` of `count`, from 1
    uint64_t unconverged = 0;      // contributions that missed the tolerance
    std::vector<float> pixels;     // RGB, 3 * width values for each of rows()
    // The rows of the image that this shard holds: index - 1, index - 1 + count, ... below height.
    std::vector<uint32_t> rows() const;
};

// Writes the file, complete or not at all. Throws ImageError.
void saveTruthShard(const std::string& path, const TruthShard& shard);

// Throws ImageError with one sentence that names the file if saveTruthShard did not write it like
// that: its size is wrong, a value is damaged, or it has another version.
TruthShard loadTruthShard(const std::string& path);

// Puts the image together from all its shards, which may come in any order. Throws ImageError if a
// file belongs to another scene, size, tolerance or number of shards than the first, if a shard is
// given twice, or if one is missing; the message names the file or the missing shard.
Image mergeTruthShards(std::span<const std::string> paths, std::span<const TruthShard> shards);

} // namespace candelabra::app
