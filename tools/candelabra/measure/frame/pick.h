// SPDX-License-Identifier: Apache-2.0
// The lights of one pixel: what each of them contributes, and what it should.
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
    uint32_t x = 0, y = 0; // from the left and the top
};

struct PickedLight {
    uint32_t light = 0;     // index in the scene
    double distance = 0;    // metres, from the surface to its centre; 0: infinitely far away
    glm::dvec3 radiance{0}; // cd/m^2, evaluated on the device
    glm::dvec3 truth{0};    // cd/m^2, integrated in double (reference/truth.h)
};

struct Pick {
    PixelPosition pixel;
    bool surface = false;            // else there is nothing to light
    glm::dvec3 position{0};          // world space, metres
    glm::dvec3 radiance{0};          // of the pixel, cd/m^2
    glm::dvec3 unlit{0};             // without lights: emission, background, environment
    std::vector<PickedLight> lights; // strongest first; those that give nothing are left out

    // unlit and all lights.
    glm::dvec3 sum() const;
};

// cd/m^2 of linear Rec.709.
double luminanceOf(const glm::dvec3& radiance);

// Why lights cannot be shown one by one in such a frame, one clause; empty: they can.
std::string pickRefusal(CndSpecularMethod specular, CndInfluenceRule influence);

// Draws a frame like `frame`, for which pickRefusal is empty, then the pixel under each of its
// lights alone. Ends with the lights of the scene.
Pick pickPixel(const VulkanContext& context, Renderer& renderer, const Scene& scene,
               const FrameOptions& frame, PixelPosition pixel);

std::string pickText(const Pick& pick, const Scene& scene);
Json toJson(const Pick& pick, const Scene& scene);

} // namespace candelabra::app
