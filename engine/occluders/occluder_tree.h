// SPDX-License-Identifier: Apache-2.0
// Trees of boxes over triangles or instances, stored depth first with skip links
// (gpu::OccluderNode).
#pragma once

#include <cfloat>
#include <span>
#include <vector>

#include <glm/common.hpp>

#include "shared/occluder_data.h"

namespace candelabra::lighting
{

struct Box {
    glm::vec3 low{FLT_MAX}, high{-FLT_MAX}; // nothing is in it

    void add(const glm::vec3& point) { add({point, point}); }
    void add(const Box& other)
    {
        low = glm::min(low, other.low);
        high = glm::max(high, other.high);
    }
    bool operator==(const Box&) const = default;
};

inline Box boxOf(const gpu::OccluderNode& node)
{
    return {node.low, node.high};
}

// Half the surface of a box.
double halfSurface(const Box& box);

struct TreeItem {
    Box box;
    uint32_t index; // of the triangle or the instance; buildTree() only moves it
};

constexpr uint32_t deepestTree = 80; // levels below the root

// Sorts `items` so that each leaf has consecutive ones, at most `leafItems`, and writes the nodes
// of their tree. Returns how many these are, at most 2 * items.size() - 1. The tree is binary and
// follows the surface area heuristic with 16 bins along each axis. It is at most deepestTree levels
// deep whatever the items are.
uint32_t buildTree(std::span<TreeItem> items, uint32_t leafItems,
                   std::span<gpu::OccluderNode> nodes);

inline uint32_t leafFirst(const gpu::OccluderNode& node)
{
    return node.leaf >> gpu::OCCLUDER_LEAF_SHIFT;
}
inline uint32_t leafEnd(const gpu::OccluderNode& node)
{
    return leafFirst(node) + (node.leaf & gpu::OCCLUDER_LEAF_COUNT);
}

// Returns the box of a node from its items or its two children. `itemBox` returns the box of the
// item with an index.
template <typename ItemBox>
Box fittedBox(std::span<const gpu::OccluderNode> nodes, uint32_t node, ItemBox&& itemBox)
{
    Box box;
    if (nodes[node].leaf) {
        for (uint32_t i = leafFirst(nodes[node]); i < leafEnd(nodes[node]); ++i)
            box.add(itemBox(i));
    } else {
        box = boxOf(nodes[node + 1]);
        box.add(boxOf(nodes[nodes[node + 1].skip]));
    }
    return box;
}

// Fits the boxes of all nodes to items that have moved.
template <typename ItemBox>
void fitTree(std::span<gpu::OccluderNode> nodes, ItemBox&& itemBox)
{
    for (uint32_t node = uint32_t(nodes.size()); node-- > 0;) {
        const Box box = fittedBox(nodes, node, itemBox);
        nodes[node].low = box.low;
        nodes[node].high = box.high;
    }
}

} // namespace candelabra::lighting
