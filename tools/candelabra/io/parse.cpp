// SPDX-License-Identifier: Apache-2.0
#include "io/parse.h"

#include <algorithm>
#include <charconv>
#include <cmath>

namespace candelabra::app
{
namespace
{

template <typename T>
std::optional<T> parseWhole(std::string_view text)
{
    T value{};
    const char* end = text.data() + text.size();
    const auto [stopped, error] = std::from_chars(text.data(), end, value);
    if (error != std::errc{} || stopped != end)
        return std::nullopt;
    return value;
}

} // namespace

std::optional<uint32_t> parseUnsigned(std::string_view text)
{
    return parseWhole<uint32_t>(text);
}

std::optional<double> parseNumber(std::string_view text)
{
    if (text.size() > 1 && text[0] == '+' && text[1] != '-') // from_chars accepts no plus sign
        text.remove_prefix(1);
    const auto value = parseWhole<double>(text);
    return value && std::isfinite(*value) ? value : std::nullopt;
}

std::vector<std::string> splitAtCommas(std::string_view text)
{
    std::vector<std::string> out;
    for (size_t start = 0; start <= text.size();) {
        const size_t end = std::min(text.find(',', start), text.size());
        out.emplace_back(text.substr(start, end - start));
        start = end + 1;
    }
    return out;
}

std::optional<std::vector<double>> parseNumbers(std::string_view text)
{
    std::vector<double> out;
    for (const std::string& part : splitAtCommas(text)) {
        const auto value = parseNumber(part);
        if (!value)
            return std::nullopt;
        out.push_back(*value);
    }
    return out;
}

std::optional<PixelSize> parseSize(std::string_view text)
{
    const size_t x = text.find('x');
    if (x == std::string_view::npos)
        return std::nullopt;
    const auto width = parseUnsigned(text.substr(0, x));
    const auto height = parseUnsigned(text.substr(x + 1));
    if (!width || !height || !*width || !*height)
        return std::nullopt;
    return PixelSize{*width, *height};
}

} // namespace candelabra::app
