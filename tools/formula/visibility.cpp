// SPDX-License-Identifier: Apache-2.0
#include "formula/visibility.h"

#include <algorithm>
#include <vector>

#include <glm/matrix.hpp>

#include "formula/glsl.h"
#include "tables/point_table.h"

#include "formula/shared_in_double.h"

namespace candelabra::formula
{
namespace
{

struct Visibility {
    explicit Visibility(uint32_t points) : table_(points == 64 ? table64() : table32()) {}

    uvec2 pointTable(uint i) const { return table_[i]; }

#include "double_visibility.h"

    Facet facetOf(const LightFacet& f) const
    {
        return {f.centre, f.halfU,
                f.halfV,  FrontSurface{f.inverseDistance, f.kappa, f.roundEnd},
                f.shape,  maskOf(f.members)};
    }
    static uvec2 maskOf(uint64_t bits)
    {
        return {uint(bits), uint(bits >> 32u)};
    }
    static uint64_t bitsOf(const uvec2& mask)
    {
        return uint64_t(mask.y) << 32u | mask.x;
    }

private:
    static const std::vector<uvec2>& table64()
    {
        static const std::vector<uvec2> table = tables::pointTable(64);
        return table;
    }
    static const std::vector<uvec2>& table32()
    {
        static const std::vector<uvec2> table = tables::pointTable(32);
        return table;
    }

    const std::vector<uvec2>& table_;
};

} // namespace

LightFacet lightFacet(uint32_t count, const Receiver& receiver, const Light& light,
                      uint64_t polygonPoints)
{
    Visibility shaders(count);
    const bool distant = (gpu::TYPES_WITH_POSITION >> light.type & 1u) == 0;
    const Visibility::LightShape shape{vec3(light.shape.axisU), light.shape.radius,
                                       vec3(light.shape.axisV), light.shape.flags};
    const auto f = shaders.lightFacet(count, light.type,
                                      distant ? light.centre : light.centre - receiver.position,
                                      light.boundingRadius, shape, mat3(1.0));
    return {count,
            f.centre,
            f.halfU,
            f.halfV,
            f.front.inverseDistance,
            f.front.kappa,
            f.front.roundEnd,
            f.shape,
            Visibility::bitsOf(f.members) & polygonPoints};
}

EnclosingRectangle enclosingRectangle(uint32_t count, std::span<const glm::dvec2> corners)
{
    Visibility shaders(count);
    Visibility::FlatPolygon polygon{};
    polygon.count = uint(corners.size());
    std::ranges::copy(corners, polygon.corners);
    const auto r = shaders.enclosingRectangle(polygon);
    return {r.centre, r.halfU, r.halfV,
            Visibility::bitsOf(shaders.pointsInside(count, polygon, r))};
}

uint64_t hiddenPoints(const LightFacet& facet, const OccludingMesh& mesh, const Receiver& receiver,
                      double ownDistance)
{
    Visibility shaders(facet.count);
    const auto f = shaders.facetOf(facet);
    if (facet.members == 0)
        return 0;
    const auto local = shaders.inSpaceOf(shaders.lightCoordinates(f), mesh.worldFromLocal);
    const mat3 localFromWorld = glm::inverse(mesh.worldFromLocal);
    const vec3 p = localFromWorld * receiver.position;
    uvec2 lit = f.members;
    unsigned turns = 0;
    for (const Triangle& t : mesh.triangles)
        lit = lit & ~shaders.trianglePoints(facet.count, f.shape, f.front, local, localFromWorld,
                                            t[0] - p, t[1] - p, t[2] - p, ownDistance, lit, turns);
    return facet.members & ~Visibility::bitsOf(lit);
}

bool leavesOut(const Shaft& shaft, const OccludingMesh& mesh, const Triangle& t)
{
    Visibility shaders(64);
    const mat3 localFromWorld = glm::inverse(mesh.worldFromLocal);
    const Visibility::ShaftEnds ends{.middle = 0.5 * (shaft.low + shaft.high),
                                     .halfBox = 0.5 * (shaft.high - shaft.low),
                                     .ball = shaft.ball,
                                     .radius = shaft.radius,
                                     .rounding = 0,
                                     .ownDistance = shaft.ownDistance};
    const vec3 low = min(t[0], min(t[1], t[2])), high = max(t[0], max(t[1], t[2]));
    const auto local = shaders.shaftIn(ends, localFromWorld, vec3(0.0), 3.0, low, high);
    return !shaders.shaftTouches(local, low, high) ||
           shaders.isBehindAll(local, ends, 0, localFromWorld, t[0], t[1], t[2]);
}

bool provesDarkness(const ReceiverBox& box, const Light& light, const OccludingMesh& mesh,
                    std::span<const gpu::OccluderNeighbours> neighbours)
{
    Visibility shaders(64);
    const Visibility::LightShape shape{vec3(light.shape.axisU), light.shape.radius,
                                       vec3(light.shape.axisV), light.shape.flags};
    Visibility::Shaft shaft{};
    if (!shaders.shaftTo(box.half, light.type, light.centre - box.centre, light.boundingRadius,
                         shape, shaft))
        return false;
    const mat3 localFromWorld = glm::inverse(mesh.worldFromLocal);
    const vec3 centre = localFromWorld * box.centre;
    const auto local = shaders.shaftInSpaceOf(shaft, localFromWorld, box.ownDistance);
    const auto corner = [&](size_t triangle, uint32_t i) {
        return mesh.triangles[triangle][i % 3] - centre;
    };
    const auto inView = [&](const vec3& a, const vec3& b, const vec3& c) {
        return shaders.triangleInView(mesh.worldFromLocal, a, b, c);
    };
    const auto touches = [&](const vec3& a, const vec3& b, const vec3& c) {
        return shaders.shaftTouchesBox(local, min(a, min(b, c)), max(a, max(b, c))) &&
               !shaders.isBesideShaft(shaft, box.ownDistance, inView(a, b, c));
    };
    std::vector<uint> sides;
    for (size_t t = 0; t < mesh.triangles.size(); ++t)
        sides.push_back(shaders.planeSide(shaft, box.ownDistance,
                                          inView(corner(t, 0), corner(t, 1), corner(t, 2))));
    uint32_t crossings = 0;
    for (size_t t = 0; t < mesh.triangles.size(); ++t) {
        const vec3 a = corner(t, 0), b = corner(t, 1), c = corner(t, 2);
        if (sides[t] == shaders.PLANE_BESIDE || !touches(a, b, c))
            continue;
        if (sides[t] == shaders.PLANE_NEAR)
            return false;
        crossings += shaders.crossesTriangle(shaft, inView(a, b, c));
        for (uint32_t edge = 0; edge < 3; ++edge)
            if (shaders.isOpenEdge(sides[t], neighbours[t].edges[edge],
                                   neighbours[t].edges[edge] == gpu::NO_NEIGHBOUR
                                       ? shaders.PLANE_NEAR
                                       : sides[neighbours[t].edges[edge] >> 1]) &&
                touches(corner(t, edge), corner(t, edge + 1), corner(t, edge + 1)))
                return false;
    }
    return crossings != 0;
}

glm::dvec2 visibleShares(const LightFacet& facet, uint64_t lit, const Receiver& receiver)
{
    Visibility shaders(facet.count);
    const auto point = shaders.makeShadingPoint(
        {receiver.n, vec3(0.0), vec3(0.0), 1.0, receiver.perceptualRoughness}, receiver.position,
        receiver.v);
    return shaders.visibleShares(shaders.facetOf(facet), facet.count, Visibility::maskOf(lit),
                                 point);
}

} // namespace candelabra::formula
