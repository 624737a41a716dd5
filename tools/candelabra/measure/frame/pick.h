// SPDX-License-Identifier: Apache-2.0
// Lists the lights of one pixel with what each contributes and what it should contribute.
#pragma once

#include <cstdint>
#include <string>
#include <vector>

#include <glm/glm.hpp>

#include "io/report.h"
#include "render/renderer.h"

namespace candelabra::app
{

struct PixelPosition {
    uint32_t x = 0, y = 0; // counted from the left and from the top
};

// What hides a light, and the share of the light's points that it hides.
struct PickedOccluder {
    std::string name;
    double share = 0;
};

struct PickedLight {
    uint32_t light = 0;     // index in the scene
    double distance = 0;    // metres from the surface to its centre; 0: infinitely far away
    glm::dvec3 radiance{0}; // cd/m^2, evaluated on the device
    glm::dvec3 truth{0};    // cd/m^2, computed in double; area lights: by reference/truth.h
    // In frames with shadows:
    glm::dvec3 unshadowed{0}; // cd/m^2 without shadows, evaluated on the device
    // Visible shares of the diffuse and the specular lobe, by reference/visibility.h. NaN: the lobe
    // reflects nothing.
    double visibleDiffuse = 1, visibleSpecular = 1;
    std::vector<PickedOccluder> occluders; // the one that hides the most first
};

struct Pick {
    PixelPosition pixel;
    bool surface = false;   // whether the pixel shows a surface; only surfaces are lit
    glm::dvec3 position{0}; // world space, metres
    glm::dvec3 radiance{0}; // cd/m^2 of the pixel
    glm::dvec3 unlit{0};    // cd/m^2 without lights: emission, background, environment
    // The strongest first. Lights that give nothing, even without shadows, are left out.
    std::vector<PickedLight> lights;
    bool shadows = false;

    // The sum of `unlit` and of all lights.
    glm::dvec3 sum() const;
};

// The luminance in cd/m^2 of linear Rec.709 radiance.
double luminanceOf(const glm::dvec3& radiance);

// Returns, in one clause, why lights cannot be shown one by one in such a frame, or an empty text
// if they can.
std::string pickRefusal(const FrameOptions& frame);

// Draws a frame like `frame`, for which pickRefusal must be empty, and then the pixel lit by each
// light alone. Afterwards the renderer has the scene's lights again.
Pick pickPixel(const VulkanContext& context, Renderer& renderer, const Scene& scene,
               const FrameOptions& frame, PixelPosition pixel);

std::string pickText(const Pick& pick, const Scene& scene);
Json toJson(const Pick& pick, const Scene& scene);

} // namespace candelabra::app
