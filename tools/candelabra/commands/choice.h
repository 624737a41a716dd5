// SPDX-License-Identifier: Apache-2.0
// Options whose values are words.
#pragma once

#include <span>
#include <string>

#include <CLI/CLI.hpp>
#include <fmt/format.h>

#include "render/error.h"

namespace candelabra::app
{

template <typename T>
struct Choice {
    const char* name;
    T value;
};

template <typename T>
std::string names(std::span<const Choice<T>> choices)
{
    std::string out;
    for (const Choice<T>& choice : choices)
        out += (out.empty() ? "" : ", ") + std::string(choice.name);
    return out;
}

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

template <typename T, size_t N>
void addChoice(CLI::App& command, const std::string& option, std::string& text,
               const Choice<T> (&choices)[N], const std::string& what)
{
    command.add_option(option, text, what + ": " + names<T>(std::span<const Choice<T>>(choices)))
        ->type_name("NAME")
        ->capture_default_str();
}

} // namespace candelabra::app
