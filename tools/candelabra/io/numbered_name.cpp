// SPDX-License-Identifier: Apache-2.0
#include "io/numbered_name.h"

#include <optional>

#include <fmt/format.h>

#include "io/error.h"
#include "io/parse.h"

namespace candelabra::app
{
namespace
{

struct Place {
    size_t start, end; // in the name
    std::string width; // the digits between % and d
};

// Finds %d, or % and d with digits between them, from `start` on.
std::optional<Place> findPlace(const std::string& name, size_t start = 0)
{
    for (size_t at = name.find('%', start); at != std::string::npos; at = name.find('%', at + 1)) {
        const size_t end = name.find_first_not_of("0123456789", at + 1);
        if (end != std::string::npos && name[end] == 'd')
            return Place{at, end + 1, name.substr(at + 1, end - at - 1)};
    }
    return std::nullopt;
}

// Reads the least number of digits from the width of a place. Returns nothing if it is no 0N.
std::optional<uint32_t> digitsOf(const Place& place)
{
    constexpr size_t most = 3; // characters: N is at most 99
    if (place.width.empty())
        return 0;
    if (place.width[0] != '0' || place.width.size() > most)
        return std::nullopt;
    return parseUnsigned(place.width);
}

} // namespace

bool isNumbered(const std::string& name)
{
    return findPlace(name).has_value();
}

std::string numberedName(const std::string& option, const std::string& name, uint32_t number)
{
    const std::optional<Place> place = findPlace(name);
    if (!place)
        throw UsageError(option + " " + name +
                         ": the name needs a place for the number of the frame, such as %04d");
    if (findPlace(name, place->end))
        throw UsageError(option + " " + name + ": the name has two places for a number");
    const std::optional<uint32_t> digits = digitsOf(*place);
    if (!digits)
        throw UsageError(option + " " + name + ": the place for the number is %" + place->width +
                         "d, but must be %d or have the form of %04d");
    return name.substr(0, place->start) + fmt::format("{:0{}}", number, *digits) +
           name.substr(place->end);
}

} // namespace candelabra::app
