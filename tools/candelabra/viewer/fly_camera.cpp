// SPDX-License-Identifier: Apache-2.0
#include "viewer/fly_camera.h"

#include <algorithm>
#include <cmath>
#include <numbers>

namespace candelabra::app
{
namespace
{

constexpr double radiansPerPixel = 0.0025; // about 1260 pixels turn the camera by 180 degrees
constexpr double fastFactor = 6;
constexpr double nearest = 0.05; // smallest distance to the pivot, metres
// The camera never looks straight along its up vector.
constexpr double pitchLimit = std::numbers::pi / 2 - 0.01;

glm::dvec3 direction(double yaw, double pitch)
{
    return {-std::sin(yaw) * std::cos(pitch), std::sin(pitch), -std::cos(yaw) * std::cos(pitch)};
}

} // namespace

FlyCamera::FlyCamera(const Camera& camera, double speed)
    : lens_(camera), position_(camera.position), speed_(speed)
{
    const glm::dvec3 f = glm::normalize(camera.forward);
    pitch_ = std::clamp(std::asin(std::clamp(f.y, -1.0, 1.0)), -pitchLimit, pitchLimit);
    // The direction of a camera that looks straight up or down has no heading. Its up vector, the
    // top of the image, gives the yaw.
    const glm::dvec3 level = std::abs(f.y) < 0.9999 ? f : camera.up * (f.y > 0 ? -1.0 : 1.0);
    yaw_ = std::atan2(-level.x, -level.z);
}

void FlyCamera::update(const FlyInput& input, double seconds)
{
    yaw_ = std::remainder(yaw_ - input.look.x * radiansPerPixel, 2 * std::numbers::pi);
    pitch_ = std::clamp(pitch_ - input.look.y * radiansPerPixel, -pitchLimit, pitchLimit);
    const double distance = speed_ * (input.fast ? fastFactor : 1) * seconds;
    const glm::dvec3 forward = direction(yaw_, pitch_);
    const glm::dvec3 right{std::cos(yaw_), 0, -std::sin(yaw_)};
    const glm::dvec3 across =
        distance * (input.move.x * right + input.move.y * glm::dvec3(0, 1, 0));
    if (orbits()) {
        pivot_ += across;
        distance_ = std::max(distance_ - distance * input.move.z, nearest);
        position_ = pivot_ - distance_ * forward;
    } else {
        position_ += across + distance * input.move.z * forward;
    }
}

void FlyCamera::wheel(double notches)
{
    const double factor = std::pow(1.25, notches);
    if (orbits()) {
        distance_ = std::clamp(distance_ / factor, nearest, 1e6);
        position_ = pivot_ - distance_ * direction(yaw_, pitch_);
    } else {
        speed_ = std::clamp(speed_ * factor, 1e-3, 1e5);
    }
}

void FlyCamera::orbit(double distance)
{
    distance_ = std::max(distance, nearest);
    pivot_ = position_ + distance_ * direction(yaw_, pitch_);
}

Camera FlyCamera::camera() const
{
    Camera out = lens_;
    out.position = position_;
    out.forward = direction(yaw_, pitch_);
    out.up = {0, 1, 0};
    return out;
}

double cruisingSpeed(const Scene& scene)
{
    const Bounds bounds = sceneBounds(scene);
    const double diagonal = glm::length(bounds.max - bounds.min);
    return std::clamp(diagonal / 15, 0.2, 200.0);
}

} // namespace candelabra::app
