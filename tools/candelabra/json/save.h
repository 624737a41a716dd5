// SPDX-License-Identifier: Apache-2.0
// Scenes as scene descriptions (.json) that load again: what was edited in the viewer is kept.
#pragma once

#include <optional>
#include <string>

#include "scene/scene.h"

namespace candelabra::app
{

// One roughness and metalness for everything, to see lights and nothing else.
struct MaterialOverride {
    bool on = false;
    float perceptualRoughness = 0.4f;
    float metalness = 0;

    bool operator==(const MaterialOverride&) const = default;
};

// Gives every material of `scene` the roughness and metalness of `override`, if that is on.
void overrideMaterials(Scene& scene, const MaterialOverride& override);

// Where the surfaces of a scene are from, when a description cannot hold them (meshes).
struct SceneSource {
    std::string scene; // hall, field, fence, showcase, or the path of a glTF file
    uint32_t seed = 1; // of the generated ones
    MaterialOverride materials{};
};

// Of what loadScene makes of `scene` with such a seed: that itself, or what it refers to, if it is
// a description that does. Throws SceneError.
SceneSource sceneSource(const std::string& scene, uint32_t seed);

// The text of a description that will stand at `path`: `scene` with its lights where they are at
// `time` seconds, seen by `camera`. Planes and balls are written out; a scene with meshes refers to
// `source`, to a file as it is found from the folder of `path`, and its lights are replaced when it
// is loaded. Not in it, because they are options of the command line: environment, how lobes share
// the light, exposure. Motion of lights is lost. Throws SceneError for what the format cannot say:
// an orthographic camera, a roughness of 0.
std::string sceneDescription(const Scene& scene, const SceneSource& source, const Camera& camera,
                             double time, const std::string& path);

} // namespace candelabra::app
