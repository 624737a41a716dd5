// SPDX-License-Identifier: Apache-2.0
// The surfaces that a frame shows, read back from its G-buffer and unpacked in double.
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
    reference::Material material;  // lobes not joined
};

class Surfaces
{
public:
    // Of the frame recorded last, which the GPU is done with, or of recordUnlit(). Throws
    // gpu::Failure.
    Surfaces(const VulkanContext& context, const Renderer& renderer, const FrameOptions& frame);

    PixelSize size() const { return size_; }
    // Empty where the pixel shows none. Emitters are surfaces that reflect nothing.
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
    std::vector<uint32_t> normalRoughness_; // two of a pixel in the full layout
    std::vector<uint32_t> albedo_;          // likewise: four halves, or four bytes
    std::vector<uint32_t> specular_;        // full layout
};

} // namespace candelabra::app
