// SPDX-License-Identifier: Apache-2.0
// The scene that tests draw into G-buffers of hosts, and how they draw it
// (shaders/probes/host_scene).
#ifndef CND_SHARED_HOST_SCENE_H
#define CND_SHARED_HOST_SCENE_H

#include "shared/prelude.h"

GPU_BEGIN

// The content of the last image of the host's G-buffer.
const uint HOST_SCENE_LINEAR = 0u; // linear depth
const uint HOST_SCENE_VIEW = 1u;   // positions in view space
const uint HOST_SCENE_WORLD = 2u;  // positions in world space

const uint HOST_SCENE_WALLS = 6u;
struct HostSceneWall { // a parallelogram in world space
    vec3 corner, edgeU, edgeV;
    float facing;  // 1: it faces edgeU x edgeV; -1: the other way
    uint material; // 0..3
};
GPU_SIZE(HostSceneWall, 44)

const uint HOST_SCENE_BINDING = 0u; // a storage buffer with one HostScene
struct HostScene {
    mat4 clipFromWorld;
    mat3 viewFromWorld;
    vec3 originView;  // the world's origin in view space
    uint placeKind;   // HOST_SCENE_*
    float linearUnit; // metres per unit of linear depth
    HostSceneWall walls[HOST_SCENE_WALLS];
};
GPU_SIZE(HostScene, 384)

GPU_END

#endif
