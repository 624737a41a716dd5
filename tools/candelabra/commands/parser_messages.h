// SPDX-License-Identifier: Apache-2.0
// Sentences in place of the messages of the parser of command lines, CLI11.
#pragma once

#include <string>

#include <CLI/CLI.hpp>

namespace candelabra::app
{

// Says what is wrong with arguments that `app` could not parse.
std::string parserSentence(const CLI::App& app, const CLI::ParseError& error);

} // namespace candelabra::app
