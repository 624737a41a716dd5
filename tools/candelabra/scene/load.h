// SPDX-License-Identifier: Apache-2.0
// The one entry point that turns what a user typed as SCENE into a Scene.
#pragma once

#include <cstdint>
#include <optional>
#include <stdexcept>
#include <string>

#include "scene/scene.h"

namespace candelabra::app
{

// A scene that cannot be used. what() is one sentence: file, element, reason. Exit code 2.
struct SceneError : std::runtime_error {
    using std::runtime_error::runtime_error;
};

struct SceneOptions {
    std::optional<uint32_t> lights; // hall/field/fence: number of sphere lights (default 4000);
                                    // files: extra random sphere lights inside the bounds
    uint32_t seed = 1;
    std::optional<double> overlaps; // mean lights that contribute to a pixel that shows a surface:
                                    // inside their influence, not wholly below its horizon
                                    // (default 8, with few lights half of what is possible)
    bool moving = false;            // lights get a LightMotion
    std::optional<double> punctualRadius; // metres: point lights without a radius become spheres
    std::optional<double> sunRadius;      // sine of an angular radius: directional lights become
                                          // distant spheres
    std::string environment;              // .hdr, .exr or .pfm file; empty: none
    double environmentRotation = 0;       // radians
    double environmentScale = 1;
    std::optional<CndLobeJoining> lobes; // default: sum for .json, else conserving
    bool energyCompensation = false;
};

// `scene` is "hall", "field", "fence", "showcase", or the path of a .gltf, .glb or .json file.
// Throws SceneError.
Scene loadScene(const std::string& scene, const SceneOptions& options);

// Whether `scene` is made for any number of lights: hall, field and fence.
bool isGenerated(const std::string& scene);
// Whether it is no file: one of those, or the showcase.
bool isBuiltIn(const std::string& scene);
// Whether it is a glTF file: by its name or, where that says nothing, by what is in it. Throws
// SceneError where that cannot be read.
bool isGltf(const std::string& scene);

// The pieces behind it.
Scene generateHall(const SceneOptions& options);
Scene generateField(const SceneOptions& options);
Scene generateFence(const SceneOptions& options);
Scene generateShowcase(const SceneOptions& options); // one light of every type
Scene loadGltf(const std::string& path, const SceneOptions& options);
Scene loadSceneJson(const std::string& path);
// Adds options.lights random sphere lights inside the scene's bounds.
void addRandomLights(Scene& scene, const SceneOptions& options);

} // namespace candelabra::app
