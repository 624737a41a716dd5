// SPDX-License-Identifier: Apache-2.0
// Pages of results: one HTML file that needs nothing else, in light and dark, well-formed as XML.
#pragma once

#include <string>
#include <vector>

#include "measure/accuracy/image_level.h"
#include "measure/accuracy/kernel_level.h"

namespace candelabra::app
{

// Up to and with the heading; pageEnd() closes it and makes sliders work.
std::string pageHead(const std::string& title);
std::string pageEnd();

std::string preformatted(const std::string& text);
// The command that makes a figure again.
std::string madeBy(const std::string& command);

// A picture; `id` is unique on the page, empty: nothing refers to it.
std::string figure(const DisplayImage& image, const std::string& caption,
                   const std::string& id = "");

struct WipeChoice {
    std::string id, name; // of a figure
};
// Two pictures on top of each other with a slider between them, each chosen from a list; at first
// the first and the last of it. They have one size.
std::string wipe(const std::vector<WipeChoice>& choices);

// Plots, tables, pictures and maps of their differences.
std::string accuracySections(const KernelLevel& kernels, const std::vector<ImageScene>& scenes,
                             const BudgetSweep& budgets, const DeviceInfo& device);

// The page of `candelabra bench accuracy`.
std::string accuracyPage(const Json& provenance, const KernelLevel& kernels,
                         const std::vector<ImageScene>& scenes, const BudgetSweep& budgets,
                         const DeviceInfo& device);

} // namespace candelabra::app
