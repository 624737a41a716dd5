// SPDX-License-Identifier: Apache-2.0
// Pieces of a page of results. The page is one HTML file that needs no other file, follows the
// light or dark colours of the browser, and is well-formed XML.
#pragma once

#include <string>
#include <vector>

#include "io/image.h"

namespace candelabra::app
{

// The beginning of a page up to and including the heading, and its end, with the script that makes
// sliders work.
std::string pageHead(const std::string& title);
std::string pageEnd();

std::string preformatted(const std::string& text);
// A line that names the command with which a figure can be made again.
std::string madeBy(const std::string& command);

// A picture with a caption. `id` is unique on the page; it may be empty if no wipe refers to it.
std::string figure(const DisplayImage& image, const std::string& caption,
                   const std::string& id = "");

struct WipeChoice {
    std::string id, name; // of a figure on the page
};
// Two pictures of the same size on top of each other with a slider between them. Each is chosen
// from the list; at first they are the first and the last of it.
std::string wipe(const std::vector<WipeChoice>& choices);

} // namespace candelabra::app
