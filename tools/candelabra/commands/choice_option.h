// SPDX-License-Identifier: Apache-2.0
// Options whose values are names.
#pragma once

#include <string>

#include <CLI/CLI.hpp>

#include "io/choice.h"

namespace candelabra::app
{

// Adds an option with a choice of names. The names are appended to the description.
template <typename T, size_t N>
void addChoice(CLI::App& command, const std::string& option, std::string& text,
               const Choice<T> (&choices)[N], const std::string& what)
{
    command.add_option(option, text, what + ": " + names<T>(std::span<const Choice<T>>(choices)))
        ->type_name("NAME")
        ->capture_default_str();
}

} // namespace candelabra::app
