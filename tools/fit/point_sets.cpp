// SPDX-License-Identifier: Apache-2.0
#include "fit/point_sets.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <numbers>
#include <utility>

#include <glm/common.hpp>

#include "generate/random.h"

namespace candelabra::fit
{
namespace
{

constexpr uint32_t directions = 96, offsets = 96;
constexpr double resolution = 1e5; // coordinates are multiples of 1 / resolution

// Edges along a side of the square count more: panels and windows are parallel to the walls, doors
// and slats that hide them.
constexpr double alignedWithin = 4; // degrees
constexpr double alignedWeight = 8;

// The half-planes in one direction: those points x with dot(normal, x) > offset.
struct Direction {
    glm::dvec2 normal;
    double extent = 1; // offsets lie between -extent and extent
    double weight = 1;
    std::array<double, offsets> share{}; // of the region's area, by offset

    // Returns how many of the offsets are below the point.
    uint32_t offsetsBelow(const glm::dvec2& point) const
    {
        const double at = normal.x * point.x + normal.y * point.y;
        const double place = (at / extent + 1) * offsets / 2 + 0.5;
        return uint32_t(std::clamp(std::ceil(place) - 1, 0.0, double(offsets)));
    }
};

double shareOfDisc(double offset)
{
    return (std::acos(offset) - offset * std::sqrt(1 - offset * offset)) / std::numbers::pi;
}

// Returns the share of the square's area beyond an offset along a normal whose components have the
// sizes a and b: the projection of the square is the sum of two uniform variables.
double shareOfSquare(double a, double b, double offset)
{
    const auto integral = [](double x) { return x > 0 ? x * x / 2 : 0; };
    if (std::min(a, b) < 1e-9)
        return std::clamp((1 - offset / std::max(a, b)) / 2, 0.0, 1.0);
    const double below = integral(offset + a + b) - integral(offset + a - b) -
                         integral(offset - a + b) + integral(offset - a - b);
    return 1 - below / (4 * a * b);
}

std::vector<Direction> halfPlanes(Region region)
{
    std::vector<Direction> out(directions);
    for (uint32_t i = 0; i < directions; ++i) {
        const double angle = std::numbers::pi * i / directions;
        Direction& d = out[i];
        d.normal = {std::cos(angle), std::sin(angle)};
        const double a = std::abs(d.normal.x), b = std::abs(d.normal.y);
        d.extent = region == Region::Disc ? 1 : a + b;
        const double limit = std::sin(alignedWithin * std::numbers::pi / 180);
        if (region == Region::Square && std::min(a, b) < limit)
            d.weight = alignedWeight;
        for (uint32_t k = 0; k < offsets; ++k) {
            const double offset = d.extent * ((2 * k + 1.0) / offsets - 1);
            d.share[k] = region == Region::Disc ? shareOfDisc(offset) : shareOfSquare(a, b, offset);
        }
    }
    return out;
}

bool isInside(Region region, const glm::dvec2& p)
{
    constexpr double limit = 1 - 2 / resolution; // after rounding, too
    return region == Region::Disc ? std::hypot(p.x, p.y) < limit
                                  : std::max(std::abs(p.x), std::abs(p.y)) < limit;
}

// The points with their errors in each half-plane, which change little if one point moves.
class Arrangement
{
public:
    Arrangement(Region region, std::vector<glm::dvec2> points)
        : planes_(halfPlanes(region)), points_(std::move(points))
    {
        for (uint32_t d = 0; d < directions; ++d)
            for (uint32_t k = 0; k < offsets; ++k) {
                double& error = errors_[d][k];
                error = -planes_[d].share[k];
                for (const glm::dvec2& p : points_)
                    error += k < planes_[d].offsetsBelow(p) ? step() : 0;
            }
        for (const Direction& d : planes_)
            weights_ += d.weight;
    }

    const std::vector<glm::dvec2>& points() const { return points_; }
    double meanSquare() const
    {
        double sum = 0;
        for (uint32_t d = 0; d < directions; ++d)
            for (const double error : errors_[d])
                sum += planes_[d].weight * error * error;
        return sum / (weights_ * offsets);
    }
    // Returns by how much the mean square would grow if the point moved.
    double change(size_t i, const glm::dvec2& to) const
    {
        double sum = 0;
        for (uint32_t d = 0; d < directions; ++d) {
            const uint32_t before = planes_[d].offsetsBelow(points_[i]);
            const uint32_t after = planes_[d].offsetsBelow(to);
            for (uint32_t k = before; k < after; ++k)
                sum += planes_[d].weight * step() * (2 * errors_[d][k] + step());
            for (uint32_t k = after; k < before; ++k)
                sum += planes_[d].weight * step() * (step() - 2 * errors_[d][k]);
        }
        return sum / (weights_ * offsets);
    }
    void move(size_t i, const glm::dvec2& to)
    {
        for (uint32_t d = 0; d < directions; ++d) {
            const uint32_t before = planes_[d].offsetsBelow(points_[i]);
            const uint32_t after = planes_[d].offsetsBelow(to);
            for (uint32_t k = before; k < after; ++k)
                errors_[d][k] += step();
            for (uint32_t k = after; k < before; ++k)
                errors_[d][k] -= step();
        }
        points_[i] = to;
    }

private:
    double step() const { return 1.0 / double(points_.size()); }

    std::vector<Direction> planes_;
    std::vector<glm::dvec2> points_;
    std::array<std::array<double, offsets>, directions> errors_{};
    double weights_ = 0;
};

} // namespace

double halfPlaneError(Region region, const std::vector<glm::dvec2>& points)
{
    return std::sqrt(Arrangement(region, points).meanSquare());
}

std::vector<glm::dvec2> regularPoints(Region region, uint32_t count)
{
    std::vector<glm::dvec2> out;
    for (uint32_t i = 0; i < count; ++i) {
        if (region == Region::Disc) {
            const double radius = std::sqrt((i + 0.5) / count);
            const double angle = i * std::numbers::pi * (3 - std::sqrt(5.0));
            out.emplace_back(radius * std::cos(angle), radius * std::sin(angle));
        } else {
            constexpr double plastic = 1.32471795724474602596;
            const double x = 0.5 + (i + 1) / plastic, y = 0.5 + (i + 1) / (plastic * plastic);
            out.emplace_back(2 * (x - std::floor(x)) - 1, 2 * (y - std::floor(y)) - 1);
        }
    }
    return out;
}

std::vector<glm::dvec2> annealedPoints(Region region, uint32_t count, uint32_t moves)
{
    app::Random random(count, uint64_t(region));
    Arrangement at(region, regularPoints(region, count));
    // Both fall geometrically: the mean square that a move may add, and how far a point may move.
    const double firstHeat = 1e-6 * 32 / count, lastHeat = 1e-10, firstWay = 0.2, lastWay = 0.002;
    for (uint32_t i = 0; i < moves; ++i) {
        const double done = double(i) / moves;
        const double heat = firstHeat * std::pow(lastHeat / firstHeat, done);
        const double way = firstWay * std::pow(lastWay / firstWay, done);
        const uint32_t moved = random.below(count);
        const glm::dvec2 step(random.uniform2());
        const double luck = std::max(double(random.uniform()), 1e-9);
        const glm::dvec2 to = at.points()[moved] + way * (2.0 * step - 1.0);
        if (isInside(region, to) && at.change(moved, to) < -heat * std::log(luck))
            at.move(moved, to);
    }
    std::vector<glm::dvec2> out;
    for (const glm::dvec2& p : at.points())
        out.emplace_back(glm::vec2(glm::round(p * resolution) / resolution));
    std::sort(out.begin(), out.end(), [](const auto& a, const auto& b) { return a.x < b.x; });
    return out;
}

} // namespace candelabra::fit
