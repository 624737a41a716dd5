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

// A plot that scrolls sideways where it does not fit.
std::string plotBox(const std::string& svg, const std::string& name);
// HTML that is shown when its summary is clicked.
std::string folded(const std::string& summary, const std::string& html);
// A line that names the command with which a figure can be made again.
std::string madeBy(const std::string& command);

// A picture with a caption. `id` is unique on the page; it may be empty if no wipe refers to it.
std::string figure(const DisplayImage& image, const std::string& caption,
                   const std::string& id = "");

struct WipeChoice {
    std::string id, name, figure; // `figure` is the picture, with that id
};
// Two pictures of the same size on top of each other with a slider between them. Each is chosen
// from the list; `left` and `right` are the first choice. Without a script the two are side by
// side.
std::string wipe(const std::vector<WipeChoice>& choices, size_t left, size_t right);

} // namespace candelabra::app
