// SPDX-License-Identifier: Apache-2.0
// Rows of a truth image in a file that says what they are: shards of a computation that was split,
// and entries of the cache. One line of JSON, then float32 RGB, little-endian.
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
    double tolerance = 0;               // relative
    uint32_t index = 1, count = 1;      // shard `index` of `count`, from 1
    uint64_t unconverged = 0;           // contributions that missed the tolerance
    std::vector<float> pixels;          // 3 * width for each of rows()
    std::vector<uint32_t> rows() const; // index - 1, index - 1 + count, ... below height
};

// Complete or not at all. Throws ImageError.
void saveTruthShard(const std::string& path, const TruthShard& shard);

// Throws ImageError, one sentence naming the file, for anything that saveTruthShard did not write:
// a wrong size, a damaged value, another version.
TruthShard loadTruthShard(const std::string& path);

// The image of all shards, in any order. Throws ImageError naming the file that is of another
// scene, size, tolerance or number of shards, that is given twice, or the shard that is missing.
Image mergeTruthShards(std::span<const std::string> paths, std::span<const TruthShard> shards);

} // namespace candelabra::app
