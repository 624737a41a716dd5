// SPDX-License-Identifier: Apache-2.0
// Whole files in and out, for the image formats. Errors: ImageError.
#pragma once

#include <cstdint>
#include <span>
#include <string>
#include <vector>

#include "io/image.h"

namespace candelabra::app
{

// "cannot write out/x.png: REASON"
[[noreturn]] void failWrite(const std::string& path, const std::string& reason);
[[noreturn]] void failRead(const std::string& path, const std::string& reason);

// What `path` is called until it is whole.
std::string temporaryName(const std::string& path);
// Creates or replaces `path` with these bytes, all or nothing.
void writeFileAtomically(const std::string& path, std::span<const uint8_t> bytes);

std::vector<uint8_t> readImageFile(const std::string& path); // at most 4 GiB

// Sizes 1..16384, channels 1 or 3, as many pixels as that makes.
void requireImage(const std::string& path, const Image& image);

constexpr uint32_t maxImageSize = 16384; // pixels a side

} // namespace candelabra::app
