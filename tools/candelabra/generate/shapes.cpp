// SPDX-License-Identifier: Apache-2.0
#include "generate/shapes.h"

#include <cmath>
#include <numbers>

#include "generate/mesh_builder.h"

namespace candelabra::app
{

namespace
{

using std::numbers::pi_v;

// The position along a closed line. Its end is exactly its beginning, so that seams have no cracks.
float closed(float turn)
{
    return turn < 1 ? turn : 0;
}

// A point of the unit circle around y, in the direction in which u x v points out if v goes up.
glm::vec3 around(float turn)
{
    turn = closed(turn);
    return {std::cos(2 * pi_v<float> * turn), 0, -std::sin(2 * pi_v<float> * turn)};
}

glm::vec3 aroundTangent(float turn)
{
    turn = closed(turn);
    return {-std::sin(2 * pi_v<float> * turn), 0, -std::cos(2 * pi_v<float> * turn)};
}

// The normals of a profile run in the (radius, height) plane. They are averaged where two pieces
// meet.
std::vector<glm::vec2> profileNormals(const ProfileRun& run)
{
    std::vector<glm::vec2> normals(run.size(), glm::vec2(0));
    for (size_t i = 0; i + 1 < run.size(); ++i) {
        const glm::vec2 along = glm::normalize(run[i + 1] - run[i]);
        const glm::vec2 normal{along.y, -along.x};
        normals[i] += normal;
        normals[i + 1] += normal;
    }
    for (glm::vec2& normal : normals)
        normal = glm::normalize(normal);
    return normals;
}

} // namespace

Mesh makeBox()
{
    Mesh mesh;
    const glm::vec3 outward[] = {{1, 0, 0}, {0, 0, -1}, {-1, 0, 0}, {0, 0, 1}};
    for (const glm::vec3& out : outward) {
        const glm::vec3 side = glm::cross(glm::vec3(0, 1, 0), out);
        const glm::vec3 up{0, 1, 0};
        appendQuad(mesh, 0.5f * (out - side - up), 0.5f * (out + side - up),
                   0.5f * (out + side + up), 0.5f * (out - side + up), out);
    }
    const size_t sides = mesh.vertices.size();
    for (const float y : {-0.5f, 0.5f}) {
        appendQuad(mesh, {-0.5f, y, 0.5f}, {0.5f, y, 0.5f}, {0.5f, y, -0.5f}, {-0.5f, y, -0.5f},
                   {0, y, 0});
    }
    for (size_t i = sides; i < mesh.vertices.size(); ++i)
        mesh.vertices[i].uv[0] = mesh.vertices[i].uv[1] = glm::vec2(0);
    return mesh;
}

Mesh makeBevelledBox(float bevel)
{
    // The corner `sign` of the face that is perpendicular to `axis`.
    const auto corner = [bevel](const glm::vec3& sign, int axis) {
        glm::vec3 p = sign * (0.5f - bevel);
        p[axis] = 0.5f * sign[axis];
        return p;
    };
    Mesh mesh;
    for (int axis = 0; axis < 3; ++axis) {
        const int next = (axis + 1) % 3, last = (axis + 2) % 3;
        for (const float s : {-1.0f, 1.0f}) {
            glm::vec3 out(0);
            out[axis] = s;
            glm::vec3 q[4];
            const float signs[4][2] = {{-1, -1}, {1, -1}, {1, 1}, {-1, 1}};
            for (int i = 0; i < 4; ++i) {
                glm::vec3 sign(0);
                sign[axis] = s;
                sign[next] = signs[i][0];
                sign[last] = signs[i][1];
                q[i] = corner(sign, axis);
            }
            appendQuad(mesh, q[0], q[1], q[2], q[3], out);
            // The edges along `last`, between the faces of `axis` and `next`.
            for (const float t : {-1.0f, 1.0f}) {
                glm::vec3 low(0), high(0);
                low[axis] = high[axis] = s;
                low[next] = high[next] = t;
                low[last] = -1;
                high[last] = 1;
                appendQuad(mesh, corner(low, axis), corner(high, axis), corner(high, next),
                           corner(low, next), low + high);
            }
        }
    }
    for (int bits = 0; bits < 8; ++bits) {
        const glm::vec3 sign{bits & 1 ? 1 : -1, bits & 2 ? 1 : -1, bits & 4 ? 1 : -1};
        appendFlatTriangle(mesh, corner(sign, 0), corner(sign, 1), corner(sign, 2), sign);
    }
    return mesh;
}

Mesh makeTile(float bevel)
{
    Mesh mesh;
    const float in = 0.5f - bevel;
    const glm::vec2 signs[4] = {{-1, 1}, {1, 1}, {1, -1}, {-1, -1}};
    glm::vec3 top[4], rim[4];
    for (int i = 0; i < 4; ++i) {
        top[i] = {signs[i].x * in, 0, signs[i].y * in};
        rim[i] = {signs[i].x * 0.5f, -bevel, signs[i].y * 0.5f};
    }
    appendQuad(mesh, top[0], top[1], top[2], top[3], {0, 1, 0});
    for (int i = 0; i < 4; ++i) {
        const int j = (i + 1) % 4;
        appendQuad(mesh, rim[i], rim[j], top[j], top[i], {0, 1, 0});
    }
    return mesh;
}

Mesh makeGround(uint32_t cells)
{
    Mesh mesh;
    appendGrid(mesh, cells, cells, [](float u, float v) {
        return SurfacePoint{{u - 0.5f, 0, 0.5f - v}, {0, 1, 0}, {1, 0, 0}};
    });
    return mesh;
}

Mesh makeSphere(uint32_t segments, uint32_t rings)
{
    Mesh mesh;
    appendGrid(mesh, segments, rings, [](float u, float v) {
        const bool pole = v == 0 || v == 1;
        const float radius = pole ? 0 : std::sin(pi_v<float> * v);
        const glm::vec3 p = radius * around(u) - glm::vec3(0, std::cos(pi_v<float> * v), 0);
        return SurfacePoint{p, p, aroundTangent(u)};
    });
    return mesh;
}

Mesh makeTorus(float majorRadius, float minorRadius, uint32_t segments, uint32_t sides)
{
    Mesh mesh;
    appendGrid(mesh, segments, sides, [=](float u, float v) {
        const glm::vec2 section = direction(2 * pi_v<float> * closed(v));
        const glm::vec3 normal = around(u) * section.x + glm::vec3(0, section.y, 0);
        return SurfacePoint{around(u) * majorRadius + normal * minorRadius, normal,
                            aroundTangent(u)};
    });
    return mesh;
}

Mesh makeKnot(float tubeRadius, uint32_t segments, uint32_t sides)
{
    // p(t) = (2 + cos 3t)(cos 2t, ., -sin 2t) + (0, sin 3t, 0), scaled to about unit width.
    const auto at = [](float t) {
        const float r = 2 + std::cos(3 * t);
        return glm::vec3(r * std::cos(2 * t), std::sin(3 * t), -r * std::sin(2 * t)) / 6.0f;
    };
    Mesh mesh;
    appendGrid(mesh, segments, sides, [&](float u, float v) {
        const float t = 2 * pi_v<float> * closed(u), step = 0.01f;
        const glm::vec3 p = at(t), before = at(t - step), after = at(t + step);
        const glm::vec3 along = glm::normalize(after - before);
        const glm::vec3 binormal = glm::normalize(glm::cross(along, after - 2.0f * p + before));
        const glm::vec2 section = direction(2 * pi_v<float> * closed(v));
        const glm::vec3 normal = glm::cross(binormal, along) * section.x - binormal * section.y;
        return SurfacePoint{p + normal * tubeRadius, normal, along};
    });
    return mesh;
}

Mesh makeLathe(const std::vector<ProfileRun>& runs, uint32_t segments)
{
    Mesh mesh;
    for (const ProfileRun& run : runs) {
        const std::vector<glm::vec2> normals = profileNormals(run);
        const float last = float(run.size() - 1);
        appendGrid(mesh, segments, uint32_t(run.size() - 1), [&](float u, float v) {
            const size_t i = size_t(v * last + 0.5f);
            return SurfacePoint{around(u) * run[i].x + glm::vec3(0, run[i].y, 0),
                                around(u) * normals[i].x + glm::vec3(0, normals[i].y, 0),
                                aroundTangent(u)};
        });
    }
    return mesh;
}

Mesh makeCylinder(uint32_t segments)
{
    return makeLathe({{{0, 0}, {1, 0}}, {{1, 0}, {1, 1}}, {{1, 1}, {0, 1}}}, segments);
}

namespace
{

// The point where the ray at `angle` in [0, pi] leaves the rectangle |x| <= halfWidth, 0 <= y <=
// height.
glm::vec2 onRectangle(float angle, float halfWidth, float height)
{
    const glm::vec2 ray = direction(angle);
    const float toSide = halfWidth / std::max(std::abs(ray.x), 1e-6f);
    const float toTop = height / std::max(ray.y, 1e-6f);
    return glm::vec2(glm::clamp(ray.x * toTop, -halfWidth, halfWidth),
                     glm::clamp(ray.y * toSide, 0.0f, height));
}

} // namespace

Mesh makeArchedWall(float width, float height, float depth, float radius, uint32_t segments)
{
    Mesh mesh;
    const float half = 0.5f * width, z = 0.5f * depth;
    // The sweep is split at the outer corners, which must be vertices.
    const float cornerAngle = std::atan2(height, half);
    const uint32_t sideSteps = segments / 3 + 1, topSteps = segments - segments / 3;
    std::vector<float> angles{0};
    const auto sweep = [&angles](float end, uint32_t steps) {
        const float start = angles.back();
        for (uint32_t i = 1; i <= steps; ++i) {
            angles.push_back(start + (end - start) * float(i) / float(steps));
        }
    };
    sweep(cornerAngle, sideSteps);
    sweep(pi_v<float> - cornerAngle, topSteps);
    sweep(pi_v<float>, sideSteps);
    for (size_t i = 0; i + 1 < angles.size(); ++i) {
        const glm::vec2 in0 = radius * direction(angles[i]);
        const glm::vec2 in1 = radius * direction(angles[i + 1]);
        const glm::vec2 out0 = onRectangle(angles[i], half, height);
        const glm::vec2 out1 = onRectangle(angles[i + 1], half, height);
        for (const float s : {-z, z})
            appendQuad(mesh, {in0, s}, {out0, s}, {out1, s}, {in1, s}, {0, 0, s});
    }
    appendGrid(mesh, segments, 1, [=](float u, float v) {
        const glm::vec2 d = direction(pi_v<float> * u);
        return SurfacePoint{{radius * d, z - depth * v}, {-d, 0}, {-d.y, d.x, 0}};
    });
    for (const float s : {-1.0f, 1.0f}) {
        appendQuad(mesh, {s * radius, 0, z}, {s * half, 0, z}, {s * half, 0, -z},
                   {s * radius, 0, -z}, {0, -1, 0});
        appendQuad(mesh, {s * half, 0, z}, {s * half, height, z}, {s * half, height, -z},
                   {s * half, 0, -z}, {s, 0, 0});
    }
    appendQuad(mesh, {-half, height, z}, {half, height, z}, {half, height, -z}, {-half, height, -z},
               {0, 1, 0});
    return mesh;
}

Mesh makeArchRing(float inner, float outer, float depth, float angle, uint32_t segments)
{
    Mesh mesh;
    const float z = 0.5f * depth;
    for (const float s : {-1.0f, 1.0f}) {
        appendGrid(mesh, segments, 1, [=](float u, float v) {
            // Seen from +z, turning left and going inwards is counter-clockwise; seen from -z,
            // going outwards is.
            const glm::vec2 d = direction(angle * u);
            const float r = (s > 0) == (v == 0) ? outer : inner;
            return SurfacePoint{{r * d, s * z}, {0, 0, s}, {-d.y, d.x, 0}};
        });
        appendGrid(mesh, segments, 1, [=](float u, float v) {
            const glm::vec2 d = direction(angle * u);
            const float r = s > 0 ? outer : inner;
            return SurfacePoint{{r * d, s * (2 * v - 1) * z}, {s * d, 0}, {-d.y, d.x, 0}};
        });
    }
    if (angle < 2 * pi_v<float> - 1e-3f) {
        for (const float end : {0.0f, angle}) {
            const glm::vec2 d = direction(end);
            const glm::vec3 out = glm::vec3(-d.y, d.x, 0) * (end > 0 ? 1.0f : -1.0f);
            appendQuad(mesh, {inner * d, z}, {outer * d, z}, {outer * d, -z}, {inner * d, -z}, out);
        }
    }
    return mesh;
}

Mesh makeVault(uint32_t segments)
{
    Mesh mesh;
    appendGrid(mesh, 1, segments, [](float u, float v) {
        // v goes from +z over the top to -z. u goes along -x, because the cross product of +x and
        // +y at +z would point out.
        const glm::vec2 d = direction(pi_v<float> * v);
        return SurfacePoint{{0.5f - u, d.y, d.x}, {0, -d.y, -d.x}, {-1, 0, 0}};
    });
    return mesh;
}

Mesh makeGabledHouse()
{
    Mesh mesh;
    const float eaves = 0.7f;
    for (const float s : {-0.5f, 0.5f}) {
        appendQuad(mesh, {-0.5f, 0, s}, {0.5f, 0, s}, {0.5f, eaves, s}, {-0.5f, eaves, s},
                   {0, 0, s});
        appendQuad(mesh, {s, 0, -0.5f}, {s, 0, 0.5f}, {s, eaves, 0.5f}, {s, eaves, -0.5f},
                   {s, 0, 0});
    }
    const size_t sides = mesh.vertices.size();
    for (const float s : {-0.5f, 0.5f}) {
        appendFlatTriangle(mesh, {s, eaves, -0.5f}, {s, eaves, 0.5f}, {s, 1, 0}, {s, 0, 0});
        appendQuad(mesh, {-0.5f, eaves, s}, {0.5f, eaves, s}, {0.5f, 1, 0}, {-0.5f, 1, 0},
                   {0, 1, 0});
    }
    // The uv of the roof is that of the texture's first texel, which is wall, so that it has no
    // windows.
    for (size_t i = sides; i < mesh.vertices.size(); ++i)
        mesh.vertices[i].uv[0] = mesh.vertices[i].uv[1] = glm::vec2(0);
    return mesh;
}

} // namespace candelabra::app
