// SPDX-License-Identifier: Apache-2.0
#include "occluders/refit_plan.h"

#include <algorithm>
#include <array>

#include "occluders/occluder_tree.h"

namespace candelabra::lighting
{
namespace
{

// Nodes of a group, at most. Each round takes time, and has few nodes near the root of a subtree.
constexpr uint32_t groupNodes = 512;
constexpr uint32_t roundsAtMost = deepestTree + 1;

class PlanWriter
{
public:
    PlanWriter(std::span<const gpu::OccluderNode> nodes, std::span<uint8_t> heights,
               std::span<uint32_t> words)
        : nodes_(nodes), heights_(heights), words_(words)
    {
        for (uint32_t node = count(); node-- > 0;)
            heights[node] =
                nodes[node].leaf
                    ? uint8_t(0)
                    : uint8_t(1 + std::max(heights[node + 1], heights[nodes[node + 1].skip]));
    }

    RefitPlan write()
    {
        uint32_t groups = 0; // first pass: how many there are
        forEachGroup([&](uint32_t, uint32_t) { ++groups; });
        const bool hasTop = count() && isTop(0);
        used_ = groups + hasTop;
        uint32_t group = 0;
        forEachGroup([&](uint32_t first, uint32_t end) { writeGroup(group++, first, end, false); });
        if (hasTop)
            writeGroup(group, 0, count(), true);
        return {used_, groups, hasTop};
    }

private:
    uint32_t count() const { return uint32_t(nodes_.size()); }
    // Tells whether a subtree has more nodes than a group takes.
    bool isTop(uint32_t node) const { return nodes_[node].skip - node > groupNodes; }

    // Calls `take` for ranges of nodes. Those in it that are not above all subtrees are a group.
    template <typename Take>
    void forEachGroup(Take&& take) const
    {
        uint32_t first = 0, taken = 0;
        for (uint32_t node = 0; node < count();) {
            if (isTop(node)) {
                ++node;
                continue;
            }
            const uint32_t size = nodes_[node].skip - node;
            if (taken + size > groupNodes) {
                take(first, node);
                first = node;
                taken = 0;
            }
            taken += size;
            node = nodes_[node].skip;
        }
        if (taken)
            take(first, count());
    }

    void writeGroup(uint32_t group, uint32_t first, uint32_t end, bool top)
    {
        std::array<uint32_t, roundsAtMost> nodesOf{}; // by height
        for (uint32_t node = first; node < end; ++node)
            nodesOf[heights_[node]] += isTop(node) == top;
        words_[group] = used_;
        uint32_t& rounds = words_[used_++] = 0;
        for (const uint32_t round : nodesOf)
            if (round) {
                words_[used_++] = round;
                ++rounds;
            }
        for (uint32_t& round : nodesOf) // from here on the place of the next node
            used_ += std::exchange(round, used_);
        for (uint32_t node = first; node < end; ++node)
            if (isTop(node) == top)
                words_[nodesOf[heights_[node]]++] = node;
    }

    std::span<const gpu::OccluderNode> nodes_;
    std::span<const uint8_t> heights_;
    std::span<uint32_t> words_;
    uint32_t used_ = 0;
};

} // namespace

uint32_t maxRefitPlanWords(uint32_t nodes)
{
    // Two groups that follow one another have more than groupNodes nodes. There is one more group
    // at the end, and one for the top.
    const uint32_t groups = 2 * (nodes / groupNodes) + 3;
    return nodes + groups * (2 + roundsAtMost);
}

RefitPlan writeRefitPlan(std::span<const gpu::OccluderNode> nodes, std::span<uint8_t> heights,
                         std::span<uint32_t> words) noexcept
{
    return PlanWriter(nodes, heights, words).write();
}

} // namespace candelabra::lighting
