// SPDX-License-Identifier: Apache-2.0
#include <vector>

#include "generate/mesh_builder.h"
#include "generate/shapes.h"

namespace candelabra::app
{
namespace
{

constexpr float pi = glm::pi<float>();

// Where the ray at `angle` in [0, pi] leaves the rectangle |x| <= halfWidth, 0 <= y <= height.
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
    // The outer corners must be vertices: split the sweep there.
    const float cornerAngle = std::atan2(height, half);
    const uint32_t sideSteps = segments / 3 + 1, topSteps = segments - segments / 3;
    std::vector<float> angles{0};
    const auto sweep = [&angles](float end, uint32_t steps) {
        const float start = angles.back();
        for (uint32_t i = 1; i <= steps; ++i) {
            angles.push_back(start +
                             (end - start) * static_cast<float>(i) / static_cast<float>(steps));
        }
    };
    sweep(cornerAngle, sideSteps);
    sweep(pi - cornerAngle, topSteps);
    sweep(pi, sideSteps);
    for (size_t i = 0; i + 1 < angles.size(); ++i) {
        const glm::vec2 in0 = radius * direction(angles[i]);
        const glm::vec2 in1 = radius * direction(angles[i + 1]);
        const glm::vec2 out0 = onRectangle(angles[i], half, height);
        const glm::vec2 out1 = onRectangle(angles[i + 1], half, height);
        for (const float s : {-z, z})
            appendQuad(mesh, {in0, s}, {out0, s}, {out1, s}, {in1, s}, {0, 0, s});
    }
    appendGrid(mesh, segments, 1, [=](float u, float v) {
        const glm::vec2 d = direction(pi * u);
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
            // Seen from +z, turning left and going inwards is counter-clockwise; from -z, outwards.
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
    if (angle < 2 * pi - 1e-3f) {
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
        // From +z over the top to -z; x to the right: cross(+x, +y) at +z would face out.
        const glm::vec2 d = direction(pi * v);
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
    // The roof shows no windows: the texture's first texel is wall.
    for (size_t i = sides; i < mesh.vertices.size(); ++i)
        mesh.vertices[i].uv[0] = mesh.vertices[i].uv[1] = glm::vec2(0);
    return mesh;
}

} // namespace candelabra::app
