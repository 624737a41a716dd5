// SPDX-License-Identifier: Apache-2.0
// Whole images of triangles and of exact planes and balls: direct light, no antialiasing, shadows
// if they are asked for. In double precision.
#pragma once

#include <cstdint>
#include <functional>
#include <optional>
#include <span>
#include <vector>

#include <glm/glm.hpp>

#include "candelabra/candelabra.h"
#include "reference/occluders.h"
#include "reference/surface.h"

namespace candelabra::reference
{

// A camera: right = normalize(cross(forward, up)), up' = cross(right, forward). The ray of
// the pixel in column i, row j from the top, is forward + tan(fov / 2) (x aspect right + y up')
// with x = 2 (i + 0.5) / width - 1, y = 1 - 2 (j + 0.5) / height. Rays of an orthographic camera
// are parallel to forward and start at position + orthographicHeight / 2 (x aspect right + y up').
struct Camera {
    glm::dvec3 position{0};
    glm::dvec3 forward{0, 0, -1};  // any length but 0
    glm::dvec3 up{0, 1, 0};        // not parallel to forward
    double verticalFov = 0.9;      // radians, 0 < fov < pi
    double aspect = 1;             // width / height of the image plane
    double orthographicHeight = 0; // metres; 0: a pinhole camera
};

struct Scene {
    Camera camera;
    std::vector<Material> materials;
    std::vector<Object> objects;
    std::vector<Triangle> triangles;
    std::vector<CndLight> lights;
    // Empty, or for each light the occluder layers whose surfaces do not shadow it, as bits.
    std::vector<uint32_t> ignoredLayers;
    glm::dvec3 lightOrigin{0};
    glm::dvec3 background{0};   // cd/m^2 of pixels without a surface
    bool lightsVisible = false; // area lights are visible, and hide what lies beyond them
    CndLobeJoining lobes = CND_LOBES_SUM;
    bool energyCompensation = false; // see joining.h, as for `lobes`
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

// Returns the surface that the ray through a pixel's centre meets first; empty if there is none.
// Lights are not surfaces.
std::optional<Hit> tracePixel(const Scene& scene, uint32_t width, uint32_t height, uint32_t column,
                              uint32_t row);

// Returns the luminance of one pixel, cd/m^2, without shadows: the emission of what is visible
// there and, for surfaces, the light of all lights.
glm::dvec3 renderPixel(const Scene& scene, uint32_t width, uint32_t height, uint32_t column,
                       uint32_t row, CndSpecularMethod specularMethod);

// Version of the integrators. It changes with every change that can alter a pixel by more than its
// tolerance; stored truths of another version are invalid.
inline constexpr uint32_t truthVersion = 1;

struct TruthOptions {
    double relative = 1e-4; // relative tolerance of every light's contribution, 1e-9..1e-2
    uint32_t threads = 0;   // 0: one per core
    bool shadows = false;   // surfaces stop light (visibility.h)
    uint64_t seed = 0;      // of the points that shadows are integrated with
    // Says which pixels are computed; the others become NaN. Empty: all of them.
    std::function<bool(uint32_t column, uint32_t row)> wanted;
    // Called after each row, from any thread but never concurrently; may be empty.
    std::function<void()> onRow;
};

struct TruthRows {
    std::vector<glm::dvec3> pixels; // cd/m^2; `width` pixels for each requested row
    uint64_t unconverged = 0;       // number of contributions that missed the tolerance
};

// Like render, but integrates every light (truth.h, visibility.h). Rows count from the top; the
// result does not depend on the number of threads. Throws std::invalid_argument for a scene outside
// the ranges above.
TruthRows renderTruth(const Scene& scene, uint32_t width, uint32_t height,
                      std::span<const uint32_t> rows, const TruthOptions& options);

// Renders all pixels on all cores; the result does not depend on the number of cores. Throws
// std::invalid_argument for a scene outside the ranges above.
Image render(const Scene& scene, uint32_t width, uint32_t height, CndSpecularMethod specularMethod);

} // namespace candelabra::reference
