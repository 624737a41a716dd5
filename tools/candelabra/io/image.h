// SPDX-License-Identifier: Apache-2.0
// Reads and writes image files. Floating-point images hold linear values. The functions change
// them only as the header of a file demands. Every file is written under a temporary name beside
// its final one and renamed when it is complete, so no one sees an incomplete file. All functions
// throw ImageError with one sentence that names the file.
#pragma once

#include <cstdint>
#include <span>
#include <stdexcept>
#include <string>
#include <vector>

#include <glm/glm.hpp>

namespace candelabra::app
{

struct ImageError : std::runtime_error {
    using std::runtime_error::runtime_error;
};

struct Image {
    uint32_t width = 0, height = 0; // pixels, 1..16384
    uint32_t channels = 0;          // 1 (grey) or 3 (RGB)
    std::vector<float> pixels;      // width * height * channels, rows from the top
    // Statements of the header about the values that a reader did not apply, one sentence each.
    std::vector<std::string> warnings = {};
};

// An image as a display shows it.
struct DisplayImage {
    uint32_t width = 0, height = 0; // pixels
    std::vector<glm::vec3> pixels;  // sRGB-encoded values in [0, 1], rows from the top
};

// Writes 8-bit RGB. `rgb` holds width * height * 3 display-referred (sRGB-encoded) values, rows
// from the top.
void savePng(const std::string& path, uint32_t width, uint32_t height,
             std::span<const uint8_t> rgb);

// Writes OpenEXR: scanlines of 32-bit float with ZIP compression; channels R, G and B, or Y. Every
// float can be stored, NaN too.
void saveExr(const std::string& path, const Image& image);

// Writes Radiance HDR (RGBE): 8-bit mantissas with a common exponent, for values below 2^127
// (1.7e38). Greater, negative and NaN values cannot be stored: the error names the pixel. Grey
// images become RGB.
void saveHdr(const std::string& path, const Image& image);

// Writes PFM: 32-bit little-endian float, "PF" (RGB) or "Pf" (grey), rows from the bottom. Every
// float can be stored, NaN too.
void savePfm(const std::string& path, const Image& image);

// Returns the extension of a file name, such as ".exr", in lower case.
std::string lowerExtension(const std::string& path);
// Whether the extension is that of display images, .png.
bool isDisplayName(const std::string& path);
// Whether the extension is one that pictures have: .png, .exr, .hdr or .pfm.
bool isPictureName(const std::string& path);

// Writes .exr, .hdr or .pfm, depending on the extension of `path` in upper or lower case. Other
// extensions are errors.
void saveImageByExtension(const std::string& path, const Image& image);

// Readers. Colours of other primaries are converted to Rec. 709 (EXR chromaticities, HDR
// PRIMARIES), and factors that were applied to the values are divided out (HDR EXPOSURE and
// COLORCORR). HDR files give RGB images. EXR files must be single-part scanline files without
// subsampling or lossy compression. Their R, G and B are read; if one of the three is missing, the
// first channel becomes a grey image. What is read must be half or float. Further channels are
// ignored.
Image loadPfm(const std::string& path);
Image loadExr(const std::string& path);
Image loadHdr(const std::string& path);
// Reads .exr, .hdr or .pfm, depending on the extension of `path` in upper or lower case. Other
// extensions are errors.
Image loadImageByExtension(const std::string& path);
// Reads a PNG file, whose values are taken for sRGB. Grey becomes RGB. Pixels must be opaque.
DisplayImage loadPng(const std::string& path);

} // namespace candelabra::app
