// SPDX-License-Identifier: Apache-2.0
// Escapes text for the SVG and HTML that the program writes.
#pragma once

#include <string>

namespace candelabra::app
{

// Replaces & < > and " by entities, so that `text` can be put between tags and in quoted
// attributes.
std::string escaped(const std::string& text);

} // namespace candelabra::app
