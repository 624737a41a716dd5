// SPDX-License-Identifier: Apache-2.0
// FlyCamera: first-person camera without gravity. No window here.
#pragma once

#include "scene/scene.h"

namespace candelabra::app
{

struct FlyInput {
    glm::dvec3 move{0}; // right, up, forward; -1, 0 or 1 each
    glm::dvec2 look{0}; // pixels the mouse moved, right and down
    bool fast = false;
};

class FlyCamera
{
public:
    FlyCamera() = default;
    // Starts at `camera` and keeps its lens. `speed` in m/s.
    FlyCamera(const Camera& camera, double speed);

    void update(const FlyInput& input, double seconds);
    // The wheel: one notch is a factor of 1.25.
    void scaleSpeed(double notches);
    Camera camera() const;
    double speed() const { return speed_; }

private:
    Camera lens_;
    glm::dvec3 position_{0};
    double yaw_ = 0;   // radians, 0 looks down -z, positive turns left
    double pitch_ = 0; // radians, positive looks up
    double speed_ = 1;
};

} // namespace candelabra::app
