// SPDX-License-Identifier: Apache-2.0
#include "load/auto_cameras.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <numbers>
#include <optional>

#include "candelabra/glm.hpp"
#include "generate/ray_caster.h"
#include "load/outside.h"
#include "scene/fit_camera.h"

namespace candelabra::app
{
namespace
{

using std::numbers::pi;

constexpr double objectFov = 0.66;    // rad (38 degrees): little perspective distortion
constexpr double roomFov = 1.05;      // rad (60 degrees)
constexpr double threeQuarter = 0.61; // rad (35 degrees) to the right of the front

// Returns the direction from a camera to what it looks at. The camera is `azimuth` radians to
// the right of the front, which is +z, and `elevation` radians above the horizon.
glm::dvec3 towards(double azimuth, double elevation)
{
    return {-std::sin(azimuth) * std::cos(elevation), -std::sin(elevation),
            -std::cos(azimuth) * std::cos(elevation)};
}

Camera cameraLooking(const std::string& name, const glm::dvec3& direction, double verticalFov)
{
    Camera camera;
    camera.name = name;
    camera.forward = glm::normalize(direction);
    if (std::abs(camera.forward.y) > 0.99999)
        camera.up = {0, 0, -1}; // north on a map
    const glm::dvec3 right = glm::normalize(glm::cross(camera.forward, camera.up));
    camera.up = glm::cross(right, camera.forward);
    camera.verticalFov = verticalFov;
    return camera;
}

// --- objects

// Returns the direction of the three-quarter view: the first of a list that draws at least half as
// much of the object as the one that draws most.
glm::dvec3 threeQuarterDirection(const Scene& scene)
{
    const Bounds bounds = sceneBounds(scene);
    const glm::dvec3 size = bounds.max - bounds.min;
    // A flat scene, such as a floor plan, is seen from higher up.
    const bool flat = size.y < 0.15 * std::max(size.x, size.z);
    const double high = flat ? 0.75 : 0.35, low = -0.35;
    std::vector<glm::dvec3> directions;
    for (const double elevation : {high, low})
        for (const double azimuth :
             {threeQuarter, -threeQuarter, threeQuarter + pi, -threeQuarter + pi})
            directions.push_back(towards(azimuth, elevation));
    const std::vector<OutsideView> seen = seenFromOutside(scene, directions);
    double most = 0;
    for (const OutsideView& view : seen)
        most = std::max(most, view.drawn);
    for (size_t i = 0; i < seen.size(); ++i)
        if (seen[i].drawn >= 0.5 * most)
            return directions[i];
    return directions.front();
}

void addObjectCameras(Scene& scene, double aspect)
{
    const std::pair<const char*, glm::dvec3> views[] = {
        {"three-quarter", threeQuarterDirection(scene)},
        {"front", towards(0, 0)},
        {"right", towards(0.5 * pi, 0)},
        {"back", towards(pi, 0)},
        {"left", towards(-0.5 * pi, 0)},
        {"above", {0, -1, 0}}};
    for (const auto& [name, direction] : views)
        scene.cameras.push_back(fitCamera(scene, {0, scene.instances.size()},
                                          cameraLooking(name, direction, objectFov), aspect));
}

// --- rooms

// Tells whether most of what is seen from outside are backs of surfaces.
bool showsBacksOutside(const Scene& scene)
{
    std::vector<glm::dvec3> directions;
    for (int i = 0; i < 6; ++i)
        directions.push_back(towards(i * pi / 3, 0.3));
    directions.push_back(towards(0, 1.2));
    double fronts = 0, backs = 0;
    for (const OutsideView& view : seenFromOutside(scene, directions)) {
        fronts += view.fronts;
        backs += view.backs;
    }
    return backs > fronts;
}

// Returns the horizontal direction in which one looks into a room through a side that is open, and
// sees hardly any backs of surfaces; nothing if all sides are closed.
std::optional<glm::dvec3> intoOpenSide(const Scene& scene)
{
    constexpr double leastFronts = 0.9; // of all that is seen
    std::vector<glm::dvec3> directions;
    for (int i = 0; i < 8; ++i)
        directions.push_back(towards(i * pi / 4, 0));
    const std::vector<OutsideView> seen =
        seenFromOutside(scene, directions, mostTrianglesOutside / 4);
    std::optional<size_t> best;
    for (size_t i = 0; i < seen.size(); ++i)
        if (seen[i].fronts > 0 &&
            seen[i].fronts >= leastFronts * (seen[i].fronts + seen[i].backs) &&
            (!best || seen[i].fronts > seen[*best].fronts))
            best = i;
    return best ? std::optional(directions[*best]) : std::nullopt;
}

constexpr int headings = 24; // horizontal rays around a standpoint
constexpr int viewHalf = 3;  // rays to either side of a view's middle: 90 degrees in all

// The surroundings of a point.
struct Standpoint {
    glm::dvec3 position{0};
    std::array<double, headings> distances{}; // to the front of a surface; 0 where there is none
    double nearest = 0;                       // distance to any surface
};

glm::dvec3 headingOf(int i)
{
    return towards(2 * pi * i / headings, 0);
}

// Returns what is seen from a point at the height of eyes above the floor that is found below the
// point, or nothing if the point is not inside a room.
std::optional<Standpoint> standpointAt(RayCaster& caster, glm::dvec3 point, double diagonal)
{
    const auto floor = caster.cast({point, {0, -1, 0}});
    if (!floor || !floor->front)
        return std::nullopt;
    const auto ceiling = caster.cast({point, {0, 1, 0}});
    if (ceiling && !ceiling->front)
        return std::nullopt;
    const double room = floor->distance + (ceiling ? ceiling->distance : floor->distance);
    point.y += -floor->distance + (room > 2.2 ? std::min(1.6, 0.6 * room) : 0.5 * room);
    Standpoint out{.position = point, .nearest = diagonal};
    int fronts = 0;
    for (int i = 0; i < headings; ++i) {
        const auto hit = caster.cast({point, headingOf(i)});
        if (!hit)
            continue;
        out.nearest = std::min(out.nearest, hit->distance);
        if (hit->front) {
            out.distances[size_t(i)] = hit->distance;
            ++fronts;
        }
    }
    // Not in a wall or a piece of furniture, not outside, and not with the nose at a wall.
    if (fronts < headings * 3 / 4 || out.nearest < 0.02 * diagonal)
        return std::nullopt;
    return out;
}

// The mean distance of what is seen with heading `i` in the middle of the view.
double viewDepth(const Standpoint& at, int i)
{
    double sum = 0;
    for (int k = -viewHalf; k <= viewHalf; ++k)
        sum += at.distances[size_t((i + k + headings) % headings)];
    return sum / (2 * viewHalf + 1);
}

struct RoomView {
    double depth = 0;
    glm::dvec3 position{0};
    int heading = 0;
};

std::vector<Standpoint> findStandpoints(const Scene& scene)
{
    const Bounds bounds = sceneBounds(scene);
    const glm::dvec3 size = bounds.max - bounds.min;
    const double diagonal = glm::length(size);
    RayCaster caster(scene);
    std::vector<Standpoint> out;
    constexpr int places = 9; // along x and along z
    for (int z = 0; z < places; ++z)
        for (int x = 0; x < places; ++x) {
            const glm::dvec3 share((x + 0.5) / places, 0.5, (z + 0.5) / places);
            if (const auto at = standpointAt(caster, bounds.min + share * size, diagonal))
                out.push_back(*at);
        }
    return out;
}

// Returns the deepest view, or the deepest of those that look away from `other`.
RoomView deepestView(const std::vector<Standpoint>& standpoints, std::optional<int> other)
{
    RoomView best;
    for (const Standpoint& at : standpoints)
        for (int i = 0; i < headings; ++i) {
            const int turn = std::abs(i - other.value_or(i));
            if (other && std::min(turn, headings - turn) < headings / 4)
                continue;
            const double depth = viewDepth(at, i);
            if (depth > best.depth)
                best = {depth, at.position, i};
        }
    return best;
}

Camera roomCamera(const std::string& name, const RoomView& view)
{
    // The horizon is a little above the middle of the picture.
    Camera camera = cameraLooking(name, headingOf(view.heading) - glm::dvec3(0, 0.08, 0), roomFov);
    camera.position = view.position;
    camera.nearPlane = std::min(camera.nearPlane, 0.005 * view.depth);
    return camera;
}

void addRoomCameras(Scene& scene, double aspect)
{
    if (!showsBacksOutside(scene))
        return;
    const std::vector<Standpoint> standpoints = findStandpoints(scene);
    const RoomView first = deepestView(standpoints, std::nullopt);
    if (!(first.depth > 0))
        return;
    scene.interior = true;
    if (const auto direction = intoOpenSide(scene))
        scene.cameras.push_back(fitCamera(scene, {0, scene.instances.size()},
                                          cameraLooking("open-side", *direction, roomFov), aspect));
    scene.cameras.push_back(roomCamera("inside", first));
    const RoomView second = deepestView(standpoints, first.heading);
    if (second.depth > 0)
        scene.cameras.push_back(roomCamera("inside-2", second));
}

// --- cameras of files

// Makes the first automatic camera the default if none of the `own` cameras of the file shows the
// scene large enough. Many files have cameras that their makers never looked through.
void chooseDefaultCamera(Scene& scene, size_t own, double aspect)
{
    if (own == 0)
        return;
    std::vector<glm::dvec3> points;
    visitVertices(scene, {0, scene.instances.size()},
                  [&](const glm::dvec3& p) { points.push_back(p); });
    // Only the first of thousands of cameras are tried: 8 of them if there are 4 million points.
    const size_t tried =
        std::min(own, std::max<size_t>(mostPointsTried / std::max<size_t>(points.size(), 1), 1));
    constexpr double least = 0.5; // of the width or of the height
    const char* fault = "the scene less than half as wide and as high as the picture";
    for (size_t i = 0; i < tried; ++i) {
        const PictureShare share = pictureShare(points, scene.cameras[i], aspect);
        if (!share.isEmpty && std::max(share.width, share.height) >= least) {
            scene.defaultCamera = i;
            return;
        }
        if (i == 0 && share.isEmpty)
            fault = "nothing of the scene";
    }
    scene.defaultCamera = own;
    scene.notes.push_back(std::string("the file's ") + (own == 1 ? "camera" : "first camera") +
                          " shows " + fault + ", so the automatic camera " +
                          scene.cameras[own].name + " is used; --camera 0 chooses the file's" +
                          (tried == own ? ""
                                        : "; only the first " + std::to_string(tried) + " of its " +
                                              std::to_string(own) + " cameras were tried"));
}

// --- lights alone

// Returns the corners of boxes around all emitters that have a place.
std::vector<glm::dvec3> emitterCorners(const Scene& scene)
{
    std::vector<glm::dvec3> out;
    for (const CndLight& light : scene.lights) {
        if (cndIsDistant(light.type))
            continue;
        const double radius = double{cndEmitterBoundingRadius(&light)};
        for (int corner = 0; corner < 8; ++corner)
            out.push_back(
                scene.lightOrigin + glm::dvec3(toGlm(light.position)) +
                radius * glm::dvec3(corner & 1 ? 1 : -1, corner & 2 ? 1 : -1, corner & 4 ? 1 : -1));
    }
    return out;
}

} // namespace

void addAutomaticCameras(Scene& scene, double aspect)
{
    const Bounds bounds = sceneBounds(scene);
    const size_t own = scene.cameras.size();
    if (scene.instances.empty() || bounds.min == bounds.max) {
        scene.cameras.push_back(fitCamera(
            emitterCorners(scene),
            cameraLooking("three-quarter", towards(threeQuarter, 0.35), objectFov), aspect));
        return;
    }
    addRoomCameras(scene, aspect);
    addObjectCameras(scene, aspect);
    chooseDefaultCamera(scene, own, aspect);
}

} // namespace candelabra::app
