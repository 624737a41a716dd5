// SPDX-License-Identifier: Apache-2.0
// Parses numbers. The whole text must be a number, and the locale makes no difference.
#pragma once

#include <cstdint>
#include <optional>
#include <string>
#include <string_view>
#include <vector>

namespace candelabra::app
{

// A number of decimal digits. Empty if the text has anything else, or does not fit into 32 bits.
std::optional<uint32_t> parseUnsigned(std::string_view text);
// A finite number. Empty for everything else, such as "inf" and "nan".
std::optional<double> parseNumber(std::string_view text);
// Finite numbers separated by commas, at least one.
std::optional<std::vector<double>> parseNumbers(std::string_view text);
// Splits "a,b" into "a" and "b". There is always one part more than there are commas.
std::vector<std::string> splitAtCommas(std::string_view text);
struct PixelSize {
    uint32_t width = 0, height = 0;

    bool operator==(const PixelSize&) const = default;
};
// A size such as "1280x720"; both numbers must be at least 1.
std::optional<PixelSize> parseSize(std::string_view text);

} // namespace candelabra::app
