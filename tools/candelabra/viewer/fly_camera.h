// SPDX-License-Identifier: Apache-2.0
// FlyCamera: a first-person camera that flies freely or orbits a point. It knows no window: the
// viewer hands it its input.
#pragma once

#include "scene/scene.h"

namespace candelabra::app
{

struct FlyInput {
    glm::dvec3 move{0}; // direction to move in: right, up, forward; each is -1, 0 or 1
    glm::dvec2 look{0}; // mouse movement in pixels: right, down
    bool fast = false;  // move 6 times as fast
};

class FlyCamera
{
public:
    FlyCamera() = default;
    // Starts where `camera` stands and looks, with its projection. `speed` is in m/s.
    FlyCamera(const Camera& camera, double speed);

    void update(const FlyInput& input, double seconds);
    // Each notch makes the camera 1.25 times as fast. In orbit it divides the distance to the pivot
    // by 1.25 instead.
    void wheel(double notches);
    // Orbits the point `distance` metres ahead, the pivot, until fly() is called. Looking turns the
    // camera around the pivot; moving sideways or up moves both; moving forward approaches the
    // pivot.
    void orbit(double distance);
    void fly() { distance_ = 0; }
    bool orbits() const { return distance_ > 0; }
    Camera camera() const;
    double speed() const { return speed_; }

private:
    Camera lens_; // its projection and aspect are used; position and directions are below
    glm::dvec3 position_{0}; // metres
    double yaw_ = 0;         // radians; at 0 the camera looks along -z, positive is to the left
    double pitch_ = 0;       // radians; positive is up
    double speed_ = 1;       // m/s
    glm::dvec3 pivot_{0};    // the point that is orbited, metres
    double distance_ = 0;    // from the camera to the pivot, metres; 0 while flying
};

// A speed in m/s, 0.2 to 200, at which crossing the scene's diagonal takes about fifteen seconds.
double cruisingSpeed(const Scene& scene);

} // namespace candelabra::app
