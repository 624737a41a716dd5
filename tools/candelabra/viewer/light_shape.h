// SPDX-License-Identifier: Apache-2.0
// Finds lights in a picture: their outlines, and the light under the mouse. It needs no window.
#pragma once

#include <optional>
#include <vector>

#include <glm/glm.hpp>

#include "io/parse.h"
#include "scene/scene.h"

namespace candelabra::app
{

// Projects the world to a picture of `size` pixels as a camera does. All that the camera frames is
// in the picture, whatever its aspect (cameraOfPicture).
class Projection
{
public:
    Projection(const Camera& camera, PixelSize size);

    // The ray through a place of the picture, in pixels from its upper left corner.
    struct Line {
        glm::dvec3 origin, direction; // world space; the direction is a unit vector
    };
    Line lineAt(glm::dvec2 place) const;
    // Returns the width of a pixel in metres at a distance along such a ray.
    double metresPerPixel(double distance) const;
    // The parts of a polyline that are in front of the camera, in pixels, as pairs of ends.
    std::vector<glm::dvec2> segments(const std::vector<glm::dvec3>& polyline) const;
    double depthOf(const glm::dvec3& point) const; // metres along the direction of the view
    const glm::dvec3& eye() const { return camera_.position; }
    const glm::dvec3& right() const { return right_; }
    const glm::dvec3& up() const { return up_; }

private:
    glm::dvec2 place(const glm::dvec3& point) const;

    Camera camera_;
    glm::dvec2 size_;
    glm::dvec3 right_, up_, forward_;
    glm::dvec2 slope_; // half the picture at a depth of 1 m; if orthographic at any depth
};

// Polylines in world space that show the emitter of a light, and the cone of a spot. `origin` is
// Scene::lightOrigin. Distant lights have none.
std::vector<std::vector<glm::dvec3>> outlineOf(const CndLight& light, const glm::dvec3& origin,
                                               const Projection& view);
// A circle around `centre` that faces the camera.
std::vector<glm::dvec3> circle(const glm::dvec3& centre, double radius, const glm::dvec3& u,
                               const glm::dvec3& v);

// Returns the light that is at a place of the picture or at most `slack` pixels beside it: of
// those, the one that is nearest to the place, then the one that is nearest to the camera, then the
// first. Lights whose emitter is wholly beyond `farthest` metres, where the picture shows a
// surface, are hidden.
std::optional<uint32_t> lightAt(const std::vector<CndLight>& lights, const glm::dvec3& origin,
                                const Projection& view, glm::dvec2 place, double slack,
                                double farthest);

} // namespace candelabra::app
