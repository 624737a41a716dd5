// SPDX-License-Identifier: Apache-2.0
// FlyCamera: first-person camera without gravity, or one that orbits a point. No window here.
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
    // One notch is a factor of 1.25: of the speed, in orbit of the distance.
    void wheel(double notches);
    // Around the point `distance` metres ahead, until fly(): looking goes around it, moving takes
    // it along, but forward is nearer.
    void orbit(double distance);
    void fly() { distance_ = 0; }
    bool orbits() const { return distance_ > 0; }
    Camera camera() const;
    double speed() const { return speed_; }

private:
    Camera lens_;
    glm::dvec3 position_{0};
    double yaw_ = 0;   // radians, 0 looks down -z, positive turns left
    double pitch_ = 0; // radians, positive looks up
    double speed_ = 1;
    glm::dvec3 pivot_{0};
    double distance_ = 0; // to the pivot; 0: flies
};

// m/s: crossing the scene takes about fifteen seconds.
double cruisingSpeed(const Scene& scene);

} // namespace candelabra::app
