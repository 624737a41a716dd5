// SPDX-License-Identifier: Apache-2.0
// Moves a camera so that objects fill its picture.
#pragma once

#include <functional>
#include <vector>

#include "scene/scene.h"

namespace candelabra::app
{

// An object to which a camera is fitted fills this share of the width or of the height of a
// picture, whichever it reaches first.
constexpr double fitShare = 0.85;

// Calls visit(position) for every vertex of these instances that a triangle uses, in world space.
// If there are very many, the corners of the bounds of meshes are visited instead.
void visitVertices(const Scene& scene, const InstanceRange& range,
                   const std::function<void(const glm::dvec3&)>& visit);

// Returns the camera for a picture whose width / height is `aspect`: without an aspect of its own,
// and with a field of view that shows all that the camera frames, and more where the picture is
// wider or higher. So nothing is stretched or cut off.
Camera cameraOfPicture(const Camera& camera, double aspect);

// The share of a picture that points fill.
struct PictureShare {
    // The share is empty if all points are behind the camera, or all are outside the same edge of
    // the picture. Then no point is in the picture.
    bool isEmpty = false;
    // The distance between the outermost points, as a share of the picture's width and of its
    // height. Both are 1 if a point is outside the picture.
    double width = 1, height = 1;
};

// Returns how much of the picture of a camera the points fill, which are in world space. The near
// and the far plane are left out of account. `aspect` is the picture's width / height, which the
// camera gets by cameraOfPicture.
PictureShare pictureShare(const std::vector<glm::dvec3>& points, const Camera& camera,
                          double aspect);

// Returns the camera moved, but not turned, to where the points lie in the middle of the picture
// and fill fitShare of its width or height. `aspect` is the picture's width / height, which the
// camera gets by cameraOfPicture. The near plane is moved nearer if it would cut the points away,
// and the far plane farther. Returns the camera as it is if there are no points.
Camera fitCamera(std::vector<glm::dvec3> points, Camera camera, double aspect);

// The same for the vertices of these instances.
Camera fitCamera(const Scene& scene, const InstanceRange& range, const Camera& camera,
                 double aspect);

} // namespace candelabra::app
