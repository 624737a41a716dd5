// SPDX-License-Identifier: Apache-2.0
// Saves a scene as a scene description (.json) that can be loaded again, so that edits in the
// viewer are kept.
#pragma once

#include <string>
#include <vector>

#include "scene/scene.h"

namespace candelabra::app
{

// One roughness and metalness for all materials, which shows the effect of lights alone.
struct MaterialOverride {
    bool on = false; // false: the scene's own materials are used
    float perceptualRoughness = 0.4f;
    float metalness = 0;

    bool operator==(const MaterialOverride&) const = default;
};

// Gives all materials the roughness and metalness of `override`, if `override` is on.
void overrideMaterials(std::vector<Material>& materials, const MaterialOverride& override);

// The source of the surfaces of a scene. A description refers to its source if it cannot hold the
// surfaces itself, because they are meshes.
struct SceneSource {
    std::string scene; // hall, field, fence, rooms, showcase, or the path of a glTF file
    uint32_t seed = 1; // for a scene that is generated
    MaterialOverride materials{};
};

// The source of the scene that loadScene makes of `scene` with this seed. It is `scene` itself, or
// the source that `scene` names if it is a description with one. Throws SceneError.
SceneSource sceneSource(const std::string& scene, uint32_t seed);

// Returns the text of a description of `scene`, to be written to `path`, with the lights at the
// places where they are at `time` seconds, and seen by `camera`. Planes and balls are written out.
// A scene with meshes refers to `source` instead, by a path relative to the folder of `path` if it
// is a file; when the description is loaded, its lights replace those of the source. The
// description has no environment, no exposure, and no choice of how lobes share the light, because
// these are options of the command line. The motion of lights is lost. Throws SceneError for what
// the format cannot express: an orthographic camera, a roughness of 0.
std::string sceneDescription(const Scene& scene, const SceneSource& source, const Camera& camera,
                             double time, const std::string& path);

} // namespace candelabra::app
