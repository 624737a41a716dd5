// SPDX-License-Identifier: Apache-2.0
// Writes the surface of a wall into a G-buffer: with FULL into the layout FULL, otherwise into one of a
// host, whose last image holds positions or linear depths.
#version 460
#extension GL_GOOGLE_include_directive : require
#include "shared/host_scene.h"
#include "lib/gbuffer.glsl"

layout(scalar, binding = HOST_SCENE_BINDING) readonly buffer Scene
{
    HostScene scene;
};
layout(location = 1) flat in uint wallIndex;
#ifdef FULL
layout(location = 0) out uvec2 normalRoughness;
layout(location = 1) out uvec2 albedo;
layout(location = 2) out uvec2 specular;
#else
layout(location = 0) in vec3 positionWorld;
layout(location = 0) out vec4 normalRoughness;
layout(location = 1) out vec4 albedo;
layout(location = 2) out vec4 place;
#endif

void main()
{
    const HostSceneWall wall = scene.walls[wallIndex];
    // Steps of 8 bits, so that the host's albedo image stores them without an error.
    const vec3 baseColour =
        vec3(40u + 50u * wall.material, 200u - 40u * wall.material, 90u) / 255.0;
    const float perceptualRoughness = 0.25 + 0.125 * float(wall.material);
    const float metalness = float(wall.material & 1u);
    const vec3 normalWorld = normalize(wall.facing * cross(wall.edgeU, wall.edgeV));
#ifdef FULL
    normalRoughness = packNormalRoughnessFull(scene.viewFromWorld * normalWorld, perceptualRoughness);
    albedo = packAlbedoFull(baseColour * (1.0 - metalness));
    specular = packSpecularFull(mix(vec3(DIELECTRIC_F0), baseColour, metalness), 1.0);
#else
    normalRoughness = vec4(normalWorld, perceptualRoughness);
    albedo = vec4(baseColour, metalness);
    const vec3 positionView = scene.viewFromWorld * positionWorld + scene.originView;
    place = scene.placeKind == HOST_SCENE_LINEAR ? vec4(abs(positionView.z) / scene.linearUnit)
          : scene.placeKind == HOST_SCENE_VIEW   ? vec4(positionView, 1.0)
                                                 : vec4(positionWorld, 1.0);
#endif
}
