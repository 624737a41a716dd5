// SPDX-License-Identifier: Apache-2.0
#include "render/camera_path.h"

#include <algorithm>
#include <array>
#include <numbers>
#include <sstream>

#include <fmt/format.h>
#include <glm/gtc/matrix_transform.hpp>

#include "io/error.h"
#include "render/camera.h"
#include "scene/scene_file.h"

namespace candelabra::app
{
namespace
{

// The value at the share t of the way from p[1] to p[2] of the curve of Catmull and Rom (1974)
// through the points p.
glm::dvec3 curve(const std::array<glm::dvec3, 4>& p, double t)
{
    const glm::dvec3 a = 2.0 * p[1], b = p[2] - p[0],
                     c = 2.0 * p[0] - 5.0 * p[1] + 4.0 * p[2] - p[3],
                     d = 3.0 * p[1] - p[0] - 3.0 * p[2] + p[3];
    return 0.5 * (a + t * (b + t * (c + t * d)));
}

std::vector<Camera> readKeys(const Scene& scene, const std::string& file)
{
    const std::vector<uint8_t> bytes = readSceneFile(file, "--path " + file, "");
    std::istringstream lines(std::string(bytes.begin(), bytes.end()));
    std::vector<Camera> keys;
    std::string line;
    for (uint32_t number = 1; std::getline(lines, line); ++number) {
        const auto fail = [&](const std::string& why) {
            throw UsageError(
                fmt::format("--path {}: line {}: {}", printable(file, 4096), number, why));
        };
        line.erase(std::remove_if(line.begin(), line.end(),
                                  [](unsigned char c) { return std::isspace(c); }),
                   line.end());
        if (line.empty() || line[0] == '#')
            continue;
        try {
            keys.push_back(selectCamera(scene, line));
        } catch (const UsageError& error) {
            fail(printable(error.what(), 500));
        }
        if (keys.back().orthographic != keys.front().orthographic)
            fail("all cameras of a path must be perspective, or all orthographic");
        constexpr double opposite = -0.99; // the cosine of the angle
        if (keys.size() > 1 &&
            glm::dot(keys.back().forward, keys[keys.size() - 2].forward) < opposite)
            fail("looks the opposite way of the camera before; put one between them");
    }
    if (keys.size() < 2)
        throw UsageError("--path " + file + ": a path needs two cameras or more, one per line");
    return keys;
}

} // namespace

Camera turnedBy(const Camera& camera, double share)
{
    Camera turned = camera;
    const glm::dmat4 turn =
        glm::rotate(glm::dmat4(1), 2 * std::numbers::pi * share, glm::dvec3(0, 1, 0));
    turned.forward = glm::dvec3(turn * glm::dvec4(camera.forward, 0));
    turned.up = glm::dvec3(turn * glm::dvec4(camera.up, 0));
    return turned;
}

CameraPath::CameraPath(const Scene& scene, const Camera& start, const std::string& path)
    : turns_(path == "turn"), keys_{start}
{
    if (path != "still" && !turns_)
        keys_ = readKeys(scene, path);
}

Camera CameraPath::at(uint32_t index, uint32_t count) const
{
    if (turns_)
        return turnedBy(keys_[0], double(index) / std::max(count, 1u));
    if (keys_.size() == 1 || count < 2)
        return keys_[0];
    const double place = double(index) * double(keys_.size() - 1) / (count - 1);
    const size_t from = std::min(size_t(place), keys_.size() - 2);
    const double t = place - double(from);
    if (t == 0)
        return keys_[from];
    // The four keys around the place; at the ends of the path a key stands in for what is missing.
    const Camera& a = keys_[from ? from - 1 : 0];
    const Camera& b = keys_[from];
    const Camera& c = keys_[from + 1];
    const Camera& d = keys_[std::min(from + 2, keys_.size() - 1)];
    Camera out = b;
    out.position = curve({a.position, b.position, c.position, d.position}, t);
    out.forward = glm::normalize(curve({a.forward, b.forward, c.forward, d.forward}, t));
    out.up = glm::normalize(glm::mix(b.up, c.up, t));
    out.verticalFov = glm::mix(b.verticalFov, c.verticalFov, t);
    out.orthographicHeight = glm::mix(b.orthographicHeight, c.orthographicHeight, t);
    return out;
}

} // namespace candelabra::app
