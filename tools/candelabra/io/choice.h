// SPDX-License-Identifier: Apache-2.0
// Values with names, for options of the command line and for results.
#pragma once

#include <span>
#include <string>

#include <fmt/format.h>

#include "io/error.h"

namespace candelabra::app
{

template <typename T>
struct Choice {
    const char* name;
    T value;
};

// Returns the names as text: "one, two, three".
template <typename T>
std::string names(std::span<const Choice<T>> choices)
{
    std::string out;
    for (const Choice<T>& choice : choices)
        out += (out.empty() ? "" : ", ") + std::string(choice.name);
    return out;
}

// Returns the value that `text` names. Throws a UsageError that lists the names if there is none.
template <typename T, size_t N>
T choose(const std::string& option, const std::string& text, const Choice<T> (&choices)[N])
{
    for (const Choice<T>& choice : choices)
        if (text == choice.name)
            return choice.value;
    throw UsageError(fmt::format("{} \"{}\": choose one of {}", option, text,
                                 names<T>(std::span<const Choice<T>>(choices))));
}

template <typename T, size_t N>
const char* nameOf(T value, const Choice<T> (&choices)[N])
{
    for (const Choice<T>& choice : choices)
        if (choice.value == value)
            return choice.name;
    return "unknown";
}

} // namespace candelabra::app
