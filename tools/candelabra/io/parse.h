// SPDX-License-Identifier: Apache-2.0
// Text to numbers, whole strings only and independent of the locale.
#pragma once

#include <cstdint>
#include <optional>
#include <string>
#include <string_view>
#include <vector>

namespace candelabra::app
{

// Decimal digits only; empty when it is not one or too large.
std::optional<uint32_t> parseUnsigned(std::string_view text);
// A finite number; "inf" and "nan" are none.
std::optional<double> parseNumber(std::string_view text);
// Finite numbers separated by commas, at least one.
std::optional<std::vector<double>> parseNumbers(std::string_view text);
// "a,b" -> a, b; as many as there are commas, and one more.
std::vector<std::string> splitAtCommas(const std::string& text);
// "1280x720": both at least 1.
struct PixelSize {
    uint32_t width = 0, height = 0;
};
std::optional<PixelSize> parseSize(std::string_view text);

} // namespace candelabra::app
