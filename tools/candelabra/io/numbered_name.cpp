// SPDX-License-Identifier: Apache-2.0
#include "io/numbered_name.h"

#include <optional>

#include <fmt/format.h>

#include "io/error.h"

namespace candelabra::app
{
namespace
{

struct Place {
    size_t start, end; // in the name
    size_t digits;     // at least
};

// Finds %d, %0Nd or %0NNd, from `start` on.
std::optional<Place> findPlace(const std::string& name, size_t start = 0)
{
    for (size_t at = name.find('%', start); at != std::string::npos; at = name.find('%', at + 1)) {
        size_t end = at + 1, digits = 0;
        if (end < name.size() && name[end] == '0')
            for (++end; end < name.size() && end < at + 4 && name[end] >= '0' && name[end] <= '9';
                 ++end)
                digits = 10 * digits + size_t(name[end] - '0');
        if (end < name.size() && name[end] == 'd')
            return Place{at, end + 1, digits};
    }
    return std::nullopt;
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
    return name.substr(0, place->start) + fmt::format("{:0{}}", number, place->digits) +
           name.substr(place->end);
}

std::string namedInstead(const std::string& name, const std::string& word)
{
    const std::optional<Place> place = findPlace(name);
    return place ? name.substr(0, place->start) + word + name.substr(place->end) : name;
}

} // namespace candelabra::app
