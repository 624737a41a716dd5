// SPDX-License-Identifier: Apache-2.0
// Image files. Floating-point images keep linear values as they are; no function changes them.
// Every file is written beside its final name and renamed when complete, so that no half file is
// ever seen. Errors: ImageError, one sentence naming the file.
#pragma once

#include <cstdint>
#include <span>
#include <stdexcept>
#include <string>
#include <vector>

namespace candelabra::app
{

struct ImageError : std::runtime_error {
    using std::runtime_error::runtime_error;
};

struct Image {
    uint32_t width = 0, height = 0; // pixels, 1..16384
    uint32_t channels = 0;          // 1 (grey) or 3 (RGB)
    std::vector<float> pixels;      // width * height * channels, rows from the top
};

// The bytes of a PNG file of 8-bit RGB, as savePng writes it; `name` stands for it in errors.
std::vector<uint8_t> encodePng(const std::string& name, uint32_t width, uint32_t height,
                               std::span<const uint8_t> rgb);

// 8-bit RGB, `rgb` = width * height * 3 display-referred (sRGB-encoded) values, rows from the top.
void savePng(const std::string& path, uint32_t width, uint32_t height,
             std::span<const uint8_t> rgb);

// OpenEXR, scanlines, 32-bit float, ZIP compression; channels R, G, B or Y. Any float, also NaN.
void saveExr(const std::string& path, const Image& image);

// Radiance RGBE: 8-bit mantissas with a common exponent, at most 1.7e38 (2^127). Negative, infinite
// and NaN values cannot be stored and are errors naming the pixel. Grey images become RGB.
void saveHdr(const std::string& path, const Image& image);

// PFM: 32-bit little-endian float, "PF" or "Pf", rows from the bottom. Any float, also NaN.
void savePfm(const std::string& path, const Image& image);

// .exr, .hdr or .pfm by the extension of `path`, upper or lower case; others are errors.
void saveImageByExtension(const std::string& path, const Image& image);

// Readers. HDR: RGB. EXR: single-part scanline files of half or float channels;
// those without R, G and B give their first channel as grey, others are dropped.
Image loadPfm(const std::string& path);
Image loadExr(const std::string& path);
Image loadHdr(const std::string& path);
// .exr, .hdr or .pfm by the extension of `path`, upper or lower case; others are errors.
Image loadImageByExtension(const std::string& path);

} // namespace candelabra::app
