// SPDX-License-Identifier: Apache-2.0
// Reads the surfaces that a frame shows from its G-buffer and unpacks them in double precision.
#pragma once

#include <optional>
#include <vector>

#include <glm/glm.hpp>

#include "reference/surface.h"
#include "render/renderer.h"

namespace candelabra::app
{

struct SeenSurface {
    reference::SurfacePoint point; // world space
    reference::Material material;  // its lobes are not joined yet (reference/joining.h)
};

class Surfaces
{
public:
    // Reads the G-buffer of the last frame, or of recordUnlit(), which the GPU must have finished.
    // `frame` must be the options of that frame. Throws gpu::Failure.
    Surfaces(const VulkanContext& context, const Renderer& renderer, const FrameOptions& frame);

    PixelSize size() const { return size_; }
    // Return nothing if the pixel shows no surface. An emitter is a surface that reflects nothing.
    std::optional<reference::SurfacePoint> pointAt(uint32_t x, uint32_t y) const;
    std::optional<SeenSurface> at(uint32_t x, uint32_t y) const;

private:
    size_t index(uint32_t x, uint32_t y) const { return size_t(y) * size_.width + x; }
    glm::dvec3 viewPosition(uint32_t x, uint32_t y, double depth) const;
    reference::Material materialAt(uint32_t x, uint32_t y) const;

    PixelSize size_;
    bool compact_;
    CndCamera camera_;
    glm::dmat3 worldFromView_;
    glm::dvec3 eye_; // world space
    bool eyeIsPoint_;
    std::vector<float> depth_;
    std::vector<uint32_t> normalRoughness_; // per pixel two in the full layout, else one
    std::vector<uint32_t> albedo_;   // per pixel four halves in the full layout, else four bytes
    std::vector<uint32_t> specular_; // in the full layout only
};

} // namespace candelabra::app
