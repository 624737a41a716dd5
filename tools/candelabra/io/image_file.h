// SPDX-License-Identifier: Apache-2.0
// Reads and writes whole files, for the image formats. All functions throw ImageError.
#pragma once

#include <cstdint>
#include <span>
#include <string>
#include <string_view>
#include <vector>

#include "io/image.h"

namespace candelabra::app
{

// Throw with a message such as "cannot write out/x.png: REASON".
[[noreturn]] void failWrite(const std::string& path, const std::string& reason);
[[noreturn]] void failRead(const std::string& path, const std::string& reason);

// The name under which `path` is written until it is complete.
std::string temporaryName(const std::string& path);
// Creates `path`, or replaces it, with these bytes. If that fails, `path` is as it was before.
void writeFileAtomically(const std::string& path, std::span<const uint8_t> bytes);

// Returns why writeFileAtomically could not create a file at `path`, or an empty text if it could.
// Does not check whether there is room for the file. Leaves everything as it is.
std::string writeRefusal(const std::string& path);

// Reads a file of at most 4 GiB. Fails on pointers of Git LFS.
std::vector<uint8_t> readImageFile(const std::string& path);

// Throws unless both sides of the image are 1..16384, it has 1 or 3 channels, and Image::pixels has
// the size that follows from them. `path` is the file that is to be written.
void requireImage(const std::string& path, const Image& image);

// The beginning of a pointer of Git LFS, which a clone without Git LFS contains, and the message
// about it.
constexpr std::string_view lfsPointerStart = "version https://git-lfs";
constexpr std::string_view lfsPointerText =
    "is a pointer of Git LFS, not the file itself; \"git lfs pull\" fetches it";

constexpr uint32_t maxImageSize = 16384; // pixels, of width and of height

} // namespace candelabra::app
