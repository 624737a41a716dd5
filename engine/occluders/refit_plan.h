// SPDX-License-Identifier: Apache-2.0
// The order in which refit_occluders fits the boxes of a tree (shared/refit_occluders.h).
#pragma once

#include <cstdint>
#include <span>

#include "shared/occluder_data.h"

namespace candelabra::lighting
{

// A plan is an array of words. First come, for each group, the index of its own words. These are
// the number of its rounds, the number of nodes in each, and the nodes, round by round: all leaves
// in the first one, and children in an earlier one than their parents. Groups hold subtrees and may
// run at the same time. The last group holds the nodes above all subtrees, and runs after them.
struct RefitPlan {
    uint32_t words = 0;
    uint32_t subtreeGroups = 0;
    bool hasTop = false;
};

// Returns how many words the plan of a tree with so many nodes has at most.
uint32_t maxRefitPlanWords(uint32_t nodes);

// Writes the plan of a tree. `heights`: memory for as many elements as there are nodes. `words`:
// room for maxRefitPlanWords().
RefitPlan writeRefitPlan(std::span<const gpu::OccluderNode> nodes, std::span<uint8_t> heights,
                         std::span<uint32_t> words) noexcept;

} // namespace candelabra::lighting
