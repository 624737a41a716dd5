// SPDX-License-Identifier: Apache-2.0
#include "occluders/occluder_tree.h"

#include <algorithm>
#include <array>
#include <cmath>

namespace candelabra::lighting
{
namespace
{

constexpr int bins = 16;
// Below this depth nodes are halved. Bins alone could make a tree as deep as it has items.
constexpr uint32_t halvedFrom = 48;
// A node with few items becomes a leaf unless two children are cheaper. The test of a box costs
// half as much as the test of a triangle (65 and 120 instructions), and the children are two boxes.
constexpr double boxCost = 0.5;

struct Bin {
    Box box;
    uint32_t count = 0;

    void add(const Bin& other)
    {
        box.add(other.box);
        count += other.count;
    }
};

struct Split {
    double cost = DBL_MAX; // sum over both sides: half surface times items
    int axis = 0, bin = 0; // the first bin of the upper side
};

// The bins along the axes, for items whose centres are in a box.
class Bins
{
public:
    explicit Bins(std::span<const TreeItem> items)
    {
        Box centres;
        for (const TreeItem& item : items) {
            centres.add(centreOf(item));
            all_.add(item.box);
        }
        low_ = centres.low;
        scale_ = float(bins) / (centres.high - centres.low);
        for (const TreeItem& item : items) {
            const glm::vec3 centre = centreOf(item);
            for (int axis = 0; axis < 3; ++axis)
                if (isUsed(axis))
                    bins_[axis][binOf(centre, axis)].add({item.box, 1});
        }
    }
    // Returns the cheapest split; its cost is DBL_MAX if there is none.
    Split best() const
    {
        Split best;
        for (int axis = 0; axis < 3; ++axis)
            if (isUsed(axis))
                tryAxis(axis, best);
        return best;
    }
    bool isBelow(const TreeItem& item, const Split& split) const
    {
        return binOf(centreOf(item), split.axis) < split.bin;
    }
    const Box& all() const { return all_; } // the box of all items

private:
    // Twice the centre; a factor changes no bin.
    static glm::vec3 centreOf(const TreeItem& item) { return item.box.low + item.box.high; }
    // All centres may be the same along an axis.
    bool isUsed(int axis) const { return std::isfinite(scale_[axis]); }
    int binOf(const glm::vec3& centre, int axis) const
    {
        return std::min(int((centre[axis] - low_[axis]) * scale_[axis]), bins - 1);
    }
    void tryAxis(int axis, Split& best) const
    {
        std::array<double, bins> above{}; // the cost of the bins from here on
        Bin sum;
        for (int b = bins - 1; b > 0; --b) {
            sum.add(bins_[axis][b]);
            above[b] = sum.count ? halfSurface(sum.box) * sum.count : DBL_MAX;
        }
        sum = {};
        for (int b = 1; b < bins; ++b) {
            sum.add(bins_[axis][b - 1]);
            if (!sum.count || above[b] == DBL_MAX)
                continue;
            if (const double cost = halfSurface(sum.box) * sum.count + above[b]; cost < best.cost)
                best = {cost, axis, b};
        }
    }

    Box all_;
    glm::vec3 low_, scale_;
    Bin bins_[3][bins];
};

// Returns how many items the first child gets, which come first then; 0: the node is a leaf.
size_t divide(std::span<TreeItem> items, uint32_t leafItems, uint32_t depth)
{
    if (items.size() <= 1)
        return 0;
    const size_t half = items.size() / 2;
    if (depth >= halvedFrom)
        return items.size() <= leafItems ? 0 : half;
    const Bins sorted(items);
    const Split split = sorted.best();
    const double alone = halfSurface(sorted.all()) * (double(items.size()) - 2 * boxCost);
    if (items.size() <= leafItems && split.cost >= alone)
        return 0;
    if (split.cost == DBL_MAX)
        return half;
    const auto upper = std::partition(items.begin(), items.end(), [&](const TreeItem& item) {
        return sorted.isBelow(item, split);
    });
    return size_t(upper - items.begin());
}

} // namespace

double halfSurface(const Box& box)
{
    const glm::dvec3 size = glm::dvec3(box.high) - glm::dvec3(box.low);
    return size.x * size.y + size.y * size.z + size.z * size.x;
}

uint32_t buildTree(std::span<TreeItem> items, uint32_t leafItems,
                   std::span<gpu::OccluderNode> nodes)
{
    struct Range {
        size_t first, count;
        uint32_t depth;
    };
    std::array<Range, deepestTree + 1> waiting; // one second child per level, and the node itself
    size_t waits = 0;
    uint32_t count = 0;
    if (!items.empty())
        waiting[waits++] = {0, items.size(), 0};
    while (waits) {
        const Range range = waiting[--waits];
        const size_t below =
            divide(items.subspan(range.first, range.count), leafItems, range.depth);
        gpu::OccluderNode& made = nodes[count++] = {};
        if (below) {
            waiting[waits++] = {range.first + below, range.count - below, range.depth + 1};
            waiting[waits++] = {range.first, below, range.depth + 1};
        } else {
            made.leaf = uint32_t(range.first << gpu::OCCLUDER_LEAF_SHIFT | range.count);
        }
    }
    for (uint32_t node = count; node-- > 0;)
        nodes[node].skip = nodes[node].leaf ? node + 1 : nodes[nodes[node + 1].skip].skip;
    fitTree(nodes.first(count), [&](uint32_t i) -> const Box& { return items[i].box; });
    return count;
}

} // namespace candelabra::lighting
