// SPDX-License-Identifier: Apache-2.0
#include "render/camera.h"

#include <algorithm>
#include <cmath>
#include <numbers>
#include <vector>

#include <fmt/format.h>

#include "io/error.h"
#include "io/parse.h"
#include "io/table.h"
#include "scene/fit_camera.h"

namespace candelabra::app
{
namespace
{

void viewFromWorld(const Camera& camera, double out[16])
{
    const glm::dvec3 forward = glm::normalize(camera.forward);
    const glm::dvec3 right = glm::normalize(glm::cross(forward, camera.up));
    const glm::dvec3 up = glm::cross(right, forward);
    const glm::dvec3 rows[3] = {right, up, -forward};
    for (int row = 0; row < 3; ++row) {
        for (int column = 0; column < 3; ++column)
            out[column * 4 + row] = rows[row][column];
        out[12 + row] = -glm::dot(rows[row], camera.position);
        out[row * 4 + 3] = 0;
    }
    out[15] = 1;
}

// The rows 2 and 3 of the projection give depth = (m22 z + m23) / w, where z = -distance.
void perspective(const Camera& camera, double aspect, float out[16])
{
    const double focal = 1 / std::tan(camera.verticalFov / 2);
    const double n = camera.nearPlane, f = camera.farPlane;
    out[0] = float(focal / aspect);
    out[5] = float(-focal);
    out[10] = float(f > 0 ? n / (f - n) : 0);
    out[14] = float(f > 0 ? n * f / (f - n) : n);
    out[11] = -1;
}

void orthographic(const Camera& camera, double aspect, float out[16])
{
    const double n = camera.nearPlane, f = camera.farPlane;
    out[0] = float(2 / (camera.orthographicHeight * aspect));
    out[5] = float(-2 / camera.orthographicHeight);
    out[10] = float(1 / (f - n));
    out[14] = float(f / (f - n));
    out[15] = 1;
}

void requireVolume(const Camera& camera, double aspect)
{
    const std::string name = camera.name.empty() ? "the camera" : "camera " + camera.name;
    const double sideways = glm::length(glm::cross(camera.forward, camera.up));
    const bool finite = std::isfinite(glm::dot(camera.position, camera.position) + sideways);
    if (!finite || !(sideways > 0))
        throw UsageError(name + ": position, direction and up do not span a view");
    if (!(aspect > 0) || !std::isfinite(aspect))
        throw UsageError(fmt::format("{}: aspect {} must be above 0", name, aspect));
    const double n = camera.nearPlane, f = camera.farPlane;
    if (camera.orthographic) {
        if (!(camera.orthographicHeight > 0) || !(f > n) || !std::isfinite(f))
            throw UsageError(fmt::format("{}: orthographic, so height {} must be above 0 and "
                                         "the far plane {} beyond the near plane {}",
                                         name, camera.orthographicHeight, f, n));
        return;
    }
    if (!(camera.verticalFov > 0) || !(camera.verticalFov < std::numbers::pi))
        throw UsageError(fmt::format("{}: vertical field of view {} rad must lie between 0 and pi",
                                     name, camera.verticalFov));
    if (!(n > 0) || !(f == 0 || f > n))
        throw UsageError(fmt::format("{}: near plane {} must be above 0 and the far plane {} 0 "
                                     "(infinite) or beyond it",
                                     name, n, f));
}

Camera typedCamera(const Scene& scene, const std::string& text, const std::vector<double>& v)
{
    Camera camera;
    camera.name = text;
    const Camera& like = scene.cameras[scene.defaultCamera];
    camera.nearPlane = like.orthographic ? camera.nearPlane : like.nearPlane;
    // In metres. This is beyond any scene; much farther away, squares of distances would leave the
    // range of float.
    constexpr double farthest = 1e9;
    for (int i = 0; i < 6; ++i)
        if (std::abs(v[i]) > farthest)
            throw UsageError(fmt::format("--camera {}: position and target must lie within 1e9 m "
                                         "of the origin on every axis",
                                         text));
    camera.position = {v[0], v[1], v[2]};
    const glm::dvec3 direction = glm::dvec3(v[3], v[4], v[5]) - camera.position;
    if (!(glm::length(direction) > 0))
        throw UsageError("--camera " + text + ": looks at its own position");
    camera.forward = glm::normalize(direction);
    // A camera that looks straight up or down cannot have +y as its up direction. It gets -z, which
    // is north on a map.
    if (std::abs(camera.forward.y) > 0.99999)
        camera.up = {0, 0, -1};
    if (v.size() == 7) {
        if (!(v[6] > 0 && v[6] < 180))
            throw UsageError("--camera " + text +
                             ": field of view must lie between 0 and 180 "
                             "degrees");
        camera.verticalFov = v[6] * std::numbers::pi / 180;
    }
    return camera;
}

} // namespace

CndCamera makeCamera(const Camera& camera, double imageAspect)
{
    requireVolume(camera, camera.aspect.value_or(imageAspect));
    const Camera whole = cameraOfPicture(camera, imageAspect);
    CndCamera out{};
    viewFromWorld(whole, out.viewFromWorld);
    if (whole.orthographic)
        orthographic(whole, imageAspect, out.clipFromView);
    else
        perspective(whole, imageAspect, out.clipFromView);
    return out;
}

Camera selectCamera(const Scene& scene, const std::string& wanted)
{
    if (scene.cameras.empty())
        throw UsageError("the scene has no camera; give one with --camera px,py,pz,tx,ty,tz");
    if (wanted.empty())
        return scene.cameras[scene.defaultCamera];
    for (const Camera& camera : scene.cameras)
        if (camera.name == wanted)
            return camera;
    if (const auto index = parseUnsigned(wanted)) {
        if (*index < scene.cameras.size())
            return scene.cameras[*index];
        throw UsageError(fmt::format("--camera {}: the scene has {}, numbered from 0", wanted,
                                     counted(scene.cameras.size(), "camera")));
    }
    if (const auto numbers = parseNumbers(wanted);
        numbers && (numbers->size() == 6 || numbers->size() == 7))
        return typedCamera(scene, wanted, *numbers);
    std::string names;
    for (const Camera& camera : scene.cameras)
        names += (names.empty() ? "" : ", ") + (camera.name.empty() ? "(unnamed)" : camera.name);
    throw UsageError("--camera " + wanted + ": give a camera of the scene by name (" + names +
                     ") or index, or position and target as px,py,pz,tx,ty,tz[,fov]");
}

InstanceRange selectNode(const Scene& scene, const std::string& wanted)
{
    if (scene.nodes.empty())
        throw UsageError("--fit " + wanted + ": " + scene.name +
                         " has no nodes with a mesh; only glTF files have nodes");
    for (const SceneNode& node : scene.nodes)
        if (node.name == wanted)
            return node.instances;
    if (const auto index = parseUnsigned(wanted))
        for (const SceneNode& node : scene.nodes)
            if (node.fileIndex == *index)
                return node.instances;
    constexpr size_t shown = 10;
    std::string names;
    for (size_t i = 0; i < std::min(shown, scene.nodes.size()); ++i) {
        const SceneNode& node = scene.nodes[i];
        names += (i ? ", " : "") +
                 (node.name.empty() ? std::to_string(node.fileIndex) : '"' + node.name + '"');
    }
    throw UsageError(fmt::format("--fit {}: no node with a mesh has this name or number; {} {}{}",
                                 wanted,
                                 scene.nodes.size() > shown ? "some of them are" : "there are",
                                 names, scene.nodes.size() > shown ? " ..." : ""));
}

} // namespace candelabra::app
