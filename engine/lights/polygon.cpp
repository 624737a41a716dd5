// SPDX-License-Identifier: Apache-2.0
#include "lights/polygon.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <span>
#include <string>

#include <glm/geometric.hpp>
#include <glm/vec2.hpp>
#include <glm/vec3.hpp>

#include "gpu/failure.h"
#include "lights/abi_vectors.h"
#include "shared/lighting_data.h"

namespace candelabra::lighting
{
namespace
{

static_assert(gpu::MAX_CORNERS == CND_MAX_CORNERS);

// The limits of CndPolygon.
constexpr double largestCoordinate = 1;
constexpr double largestDent = 1e-6; // how far a corner may be outside an edge
constexpr double smallestEdge = 1e-5;
constexpr double smallestArea = 1e-4;
// The largest distance of the corners of cndPolygonFromCorners from their plane, relative to the
// longest edge.
constexpr double largestHeight = 1e-4;

constexpr const char* wrongCount = "a polygon must have 3 to 8 corners";

glm::dvec2 cornerOf(const CndPolygon& polygon, uint32_t i)
{
    const float(&corner)[2] = polygon.corners[i % polygon.cornerCount];
    return {corner[0], corner[1]};
}

double cross(const glm::dvec2& a, const glm::dvec2& b)
{
    return a.x * b.y - a.y * b.x;
}

bool hasCoincidentNeighbours(const CndPolygon& polygon)
{
    for (uint32_t i = 0; i < polygon.cornerCount; ++i)
        if (glm::distance(cornerOf(polygon, i), cornerOf(polygon, i + 1)) < smallestEdge)
            return true;
    return false;
}

// Every corner is tested against every edge. Right turns alone would not do: the five points of a
// star turn in one direction as well.
bool isConvex(const CndPolygon& polygon)
{
    for (uint32_t i = 0; i < polygon.cornerCount; ++i) {
        const glm::dvec2 from = cornerOf(polygon, i);
        const glm::dvec2 edge = glm::normalize(cornerOf(polygon, i + 1) - from);
        for (uint32_t j = 0; j < polygon.cornerCount; ++j)
            if (cross(edge, cornerOf(polygon, j) - from) < -largestDent)
                return false;
    }
    return true;
}

struct PlacedPolygon {
    glm::dvec3 centre, axisU, axisV;
    CndPolygon polygon;
};

// Returns the polygon in the rectangle around it that has a side along the longest edge.
PlacedPolygon placePolygon(std::span<const glm::dvec3> corners)
{
    const auto corner = [&](size_t i) { return corners[i % corners.size()]; };
    glm::dvec3 longest(0), areaNormal(0);
    for (size_t i = 0; i < corners.size(); ++i) {
        const glm::dvec3 edge = corner(i + 1) - corner(i);
        if (glm::length(edge) > glm::length(longest))
            longest = edge;
        areaNormal += glm::cross(corner(i) - corners[0], corner(i + 1) - corners[0]);
    }
    const double size = glm::length(longest);
    if (!(size >= gpu::MIN_LIGHT_LENGTH))
        gpu::failArgument("all corners coincide");
    if (!(glm::length(areaNormal) > smallestArea * size * size))
        gpu::failArgument("the corners enclose no area");
    const glm::dvec3 normal = glm::normalize(areaNormal);
    for (const glm::dvec3& p : corners)
        if (std::abs(glm::dot(normal, p - corners[0])) > largestHeight * size)
            gpu::failArgument("the corners are not in a plane");
    // `longest` is in the plane up to largestHeight.
    const glm::dvec3 v = glm::normalize(glm::cross(normal, longest)), u = glm::cross(v, normal);
    glm::dvec2 low(INFINITY), high(-INFINITY);
    for (const glm::dvec3& p : corners) {
        const glm::dvec2 at(glm::dot(u, p - corners[0]), glm::dot(v, p - corners[0]));
        low = glm::min(low, at);
        high = glm::max(high, at);
    }
    const glm::dvec2 middle = 0.5 * (low + high), half = 0.5 * (high - low);
    PlacedPolygon out{corners[0] + middle.x * u + middle.y * v, half.x * u, half.y * v, {}};
    out.polygon.cornerCount = uint32_t(corners.size());
    for (size_t i = 0; i < corners.size(); ++i) {
        const glm::dvec3 p = corners[i] - corners[0];
        const glm::dvec2 at = (glm::dvec2(glm::dot(u, p), glm::dot(v, p)) - middle) / half;
        for (int k = 0; k < 2; ++k)
            out.polygon.corners[i][k] = float(std::clamp(at[k], -1.0, 1.0));
    }
    return out;
}

// Limits of outlinePolygon, relative to the length of the polygon.
constexpr double largestThinWidth = 0.1;
constexpr double samePlace = 1e-4; // corners of both sides that are closer count as one place

// One of the two sides between the ends of the longest diagonal: corners in the order of x, which
// goes along the diagonal.
struct Side {
    std::array<glm::dvec2, CND_MAX_CORNERS> corners{};
    uint32_t count = 0;

    bool hasCornerAt(double x, double tolerance) const
    {
        return std::any_of(corners.begin(), corners.begin() + count,
                           [&](const glm::dvec2& c) { return std::abs(c.x - x) < tolerance; });
    }
    // x must be within the side.
    glm::dvec2 at(double x) const
    {
        uint32_t i = 1;
        while (i + 1 < count && corners[i].x < x)
            ++i;
        const glm::dvec2 &a = corners[i - 1], &b = corners[i];
        return {x, a.y + (x - a.x) / (b.x - a.x) * (b.y - a.y)};
    }
};

// The ends of the longest diagonal.
struct Diagonal {
    uint32_t from = 0, to = 0;
    double length = 0;
};

Diagonal longestDiagonal(std::span<const glm::dvec2> corners)
{
    Diagonal out;
    for (uint32_t i = 0; i < corners.size(); ++i)
        for (uint32_t j = i + 1; j < corners.size(); ++j)
            if (const double length = glm::distance(corners[i], corners[j]); length > out.length)
                out = {i, j, length};
    return out;
}

// Returns the corners between the ends of a side, and for every such corner of the other side a
// point next to it, in the order of x.
uint32_t matchedCorners(const Side& side, const Side& other, double tolerance,
                        std::span<glm::dvec2> out)
{
    uint32_t count = 0;
    for (uint32_t i = 1; i + 1 < side.count; ++i)
        out[count++] = side.corners[i];
    for (uint32_t i = 1; i + 1 < other.count; ++i)
        if (!side.hasCornerAt(other.corners[i].x, tolerance))
            out[count++] = side.at(other.corners[i].x);
    std::sort(out.begin(), out.begin() + count,
              [](const glm::dvec2& a, const glm::dvec2& b) { return a.x < b.x; });
    return count;
}

} // namespace

OutlinePolygon outlinePolygon(const CndLight& light) noexcept
{
    const CndPolygon& given = *light.polygon;
    const uint32_t count = given.cornerCount;
    OutlinePolygon out{
        glm::vec3(dvec3From(light.axisU)), glm::vec3(dvec3From(light.axisV)), count, {}};
    for (uint32_t i = 0; i < count; ++i)
        out.corners[i] = {given.corners[i][0], given.corners[i][1]};

    // In metres along the axes, which are perpendicular.
    const glm::dvec3 u = dvec3From(light.axisU), v = dvec3From(light.axisV);
    std::array<glm::dvec2, CND_MAX_CORNERS> metres{};
    for (uint32_t i = 0; i < count; ++i)
        metres[i] = cornerOf(given, i) * glm::dvec2(glm::length(u), glm::length(v));
    const Diagonal diagonal = longestDiagonal({metres.data(), count});
    const glm::dvec2 along = (metres[diagonal.to] - metres[diagonal.from]) / diagonal.length;
    glm::dvec2 low(INFINITY), high(-INFINITY);
    for (uint32_t i = 0; i < count; ++i) {
        metres[i] = {glm::dot(along, metres[i]), cross(along, metres[i])};
        low = glm::min(low, metres[i]);
        high = glm::max(high, metres[i]);
    }
    if (!(high.y - low.y < largestThinWidth * diagonal.length))
        return out;

    Side right, left; // of the diagonal
    for (uint32_t i = diagonal.from;; i = (i + 1) % count) {
        right.corners[right.count++] = metres[i];
        if (i == diagonal.to)
            break;
    }
    for (uint32_t i = diagonal.from;; i = (i + count - 1) % count) {
        left.corners[left.count++] = metres[i];
        if (i == diagonal.to)
            break;
    }
    const double tolerance = samePlace * diagonal.length;
    std::array<glm::dvec2, gpu::MAX_RECORD_CORNERS> matched{};
    const std::span all(matched);
    matched[0] = metres[diagonal.from];
    out.count = 1 + matchedCorners(right, left, tolerance, all.subspan(1));
    matched[out.count++] = metres[diagonal.to];
    const uint32_t onLeft = matchedCorners(left, right, tolerance, all.subspan(out.count));
    std::reverse(matched.begin() + out.count, matched.begin() + out.count + onLeft);
    out.count += onLeft;

    const glm::dvec2 half = glm::max(glm::abs(low), glm::abs(high));
    const glm::dvec3 unitU = glm::normalize(u), unitV = glm::normalize(v);
    out.axisU = glm::vec3(half.x * (along.x * unitU + along.y * unitV));
    out.axisV = glm::vec3(half.y * (along.x * unitV - along.y * unitU));
    for (uint32_t i = 0; i < out.count; ++i)
        out.corners[i] = glm::vec2(matched[i] / half);
    return out;
}

const char* whyPolygonInvalid(const CndPolygon* polygon)
{
    if (!polygon)
        return "polygon must not be NULL";
    if (polygon->cornerCount < 3 || polygon->cornerCount > CND_MAX_CORNERS)
        return wrongCount;
    for (uint32_t i = 0; i < polygon->cornerCount; ++i)
        for (const float coordinate : polygon->corners[i])
            if (!(std::abs(coordinate) <= largestCoordinate)) // true for NaN
                return "the coordinates of a polygon's corners must be within -1..1";
    if (hasCoincidentNeighbours(*polygon))
        return "two neighbouring corners of the polygon coincide";
    const double area = polygonArea(*polygon);
    if (std::abs(area) < smallestArea)
        return "the corners of the polygon enclose no area";
    if (area < 0)
        return "the corners of the polygon must go counterclockwise, from axisU to axisV";
    if (!isConvex(*polygon))
        return "the polygon must be convex";
    return nullptr;
}

double polygonArea(const CndPolygon& polygon)
{
    double twice = 0;
    for (uint32_t i = 0; i < polygon.cornerCount; ++i)
        twice += cross(cornerOf(polygon, i), cornerOf(polygon, i + 1));
    return twice / 2;
}

float polygonRadius(const CndLight& light)
{
    const glm::dvec3 u = dvec3From(light.axisU), v = dvec3From(light.axisV);
    double radius = 0;
    for (uint32_t i = 0; i < light.polygon->cornerCount; ++i) {
        const glm::dvec2 corner = cornerOf(*light.polygon, i);
        radius = std::max(radius, glm::length(corner.x * u + corner.y * v));
    }
    return float(radius);
}

} // namespace candelabra::lighting

using namespace candelabra;

CndResult cndPolygonFromCorners(const float (*corners)[3], uint32_t count, CndLight* light,
                                CndPolygon* polygon, CndError* error)
{
    return gpu::guard(error, [&] {
        gpu::requireNotNull("cndPolygonFromCorners", {corners, light, polygon});
        if (count < 3 || count > CND_MAX_CORNERS)
            gpu::failArgument(lighting::wrongCount);
        std::array<glm::dvec3, CND_MAX_CORNERS> points;
        for (uint32_t i = 0; i < count; ++i) {
            points[i] = lighting::dvec3From(corners[i]);
            for (const float coordinate : corners[i])
                if (!(std::abs(coordinate) <= gpu::MAX_LIGHT_COORDINATE)) // true for NaN
                    gpu::failArgument("corners[" + std::to_string(i) +
                                      "] is not finite or beyond 1e15 m");
        }
        const lighting::PlacedPolygon placed = lighting::placePolygon({points.data(), count});
        if (const char* why = lighting::whyPolygonInvalid(&placed.polygon))
            gpu::failArgument(why);
        light->type = CND_LIGHT_POLYGON;
        lighting::setFloats(light->position, placed.centre);
        lighting::setFloats(light->axisU, placed.axisU);
        lighting::setFloats(light->axisV, placed.axisV);
        *polygon = placed.polygon;
        light->polygon = polygon;
    });
}
