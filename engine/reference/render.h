// SPDX-License-Identifier: Apache-2.0
// Whole images of exact planes and balls in double: direct light, no shadows, no antialiasing.
#pragma once

#include <cstdint>
#include <functional>
#include <optional>
#include <span>
#include <vector>

#include <glm/glm.hpp>

#include "candelabra/candelabra.h"
#include "reference/surface.h"

namespace candelabra::reference
{

// Pinhole: right = normalize(cross(forward, up)), up' = cross(right, forward); the ray of pixel
// (column i, row j from the top) is forward + tan(fov / 2) (x aspect right + y up') with
// x = 2 (i + 0.5) / width - 1, y = 1 - 2 (j + 0.5) / height.
struct Camera {
    glm::dvec3 position{0};
    glm::dvec3 forward{0, 0, -1}; // any length but 0
    glm::dvec3 up{0, 1, 0};       // not parallel to forward
    double verticalFov = 0.9;     // radians, 0 < fov < pi
    double aspect = 1;            // width / height of the image plane
};

struct Object {
    enum class Type { Plane, Ball } type = Type::Plane;
    glm::dvec3 point{0};        // plane: a point on it; ball: centre
    glm::dvec3 normal{0, 1, 0}; // plane: unit; only the side it points to is seen
    double radius = 1;          // ball, seen from outside only
    uint32_t material = 0;      // index into Scene::materials
};

struct Scene {
    Camera camera;
    std::vector<Material> materials;
    std::vector<Object> objects;
    std::vector<CndLight> lights;
    glm::dvec3 lightOrigin{0};
    glm::dvec3 background{0};   // cd/m^2 where nothing is seen
    bool lightsVisible = false; // area lights are seen, and hide what is behind them
    CndLobeJoining lobes = CND_LOBES_SUM;
    bool energyCompensation = false; // both: joining.h
};

struct Image {
    uint32_t width = 0, height = 0;
    std::vector<glm::dvec3> pixels; // rows from the top

    const glm::dvec3& at(uint32_t column, uint32_t row) const
    {
        return pixels[static_cast<size_t>(row) * width + column];
    }
};

struct Hit {
    SurfacePoint surface;
    uint32_t material = 0;
};

// The object that the ray through a pixel's centre meets first; empty where it meets none. Lights
// are none.
std::optional<Hit> tracePixel(const Scene& scene, uint32_t width, uint32_t height, uint32_t column,
                              uint32_t row);

// Luminance of one pixel, cd/m^2: emission of what is seen plus, of surfaces, all lights.
glm::dvec3 renderPixel(const Scene& scene, uint32_t width, uint32_t height, uint32_t column,
                       uint32_t row, CndSpecularMethod specularMethod);

// Changes with every change of an integrator that can change a pixel by more than its tolerance:
// stored truths of another version are no longer true.
inline constexpr uint32_t truthVersion = 1;

struct TruthOptions {
    double relative = 1e-4; // tolerance of every light's contribution, 1e-9..1e-2
    uint32_t threads = 0;   // 0: one for every core
    // After each row, from any thread but never from two at a time; may be empty.
    std::function<void()> onRow;
};

struct TruthRows {
    std::vector<glm::dvec3> pixels; // cd/m^2; width of them for each row asked for
    uint64_t unconverged = 0;       // contributions that missed the tolerance
};

// Like renderPixel, with every light integrated (truth.h). Rows count from the top; the result does
// not depend on the number of threads. Throws std::invalid_argument for a scene outside the ranges
// above.
TruthRows renderTruth(const Scene& scene, uint32_t width, uint32_t height,
                      std::span<const uint32_t> rows, const TruthOptions& options);

// All pixels, on every core; the result does not depend on the number of cores. Throws
// std::invalid_argument for a scene outside the ranges above.
Image render(const Scene& scene, uint32_t width, uint32_t height, CndSpecularMethod specularMethod);

} // namespace candelabra::reference
