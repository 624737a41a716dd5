// SPDX-License-Identifier: Apache-2.0
// Text inside the SVG and HTML that the program writes.
#pragma once

#include <string>

namespace candelabra::app
{

// With what XML and HTML give a meaning to (& < > ") as entities: for text and quoted attributes.
std::string escaped(const std::string& text);

} // namespace candelabra::app
