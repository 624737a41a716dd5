// SPDX-License-Identifier: Apache-2.0
// The host's scene and its raster pass: balls on a floor, whose vertices, indices and objects are
// in buffers that shaders of every stage read through one descriptor set.
#pragma once

#include <glm/glm.hpp>

#include "host.hpp"

// The structs of scene.glsl.
struct Vertex {
    glm::vec3 position, normal;
};
struct Object {
    glm::mat4x3 worldFromMesh;
    glm::vec3 albedo;
    float perceptualRoughness;
};
struct Camera {
    glm::mat4 clipFromWorld;
    glm::mat3 viewFromWorld;
    glm::vec2 pixels;
};

struct Scene {
    HostImage ids; // the visibility buffer
    HostBuffer vertices, indices, objects, camera;
    VkDescriptorSetLayout setLayout;
    VkDescriptorPool pool;
    VkDescriptorSet set;
    Raster visibility, plain;
};

Scene createScene(const Host& host);
void destroyScene(const Host& host, const Scene& scene);
// Draw the scene as ids, or into the G-buffer of the host. They leave these images, depth and a
// black radiance in the states that CndLightingFrame requires.
void drawIds(const Host& host, const Scene& scene);
void drawGBuffer(const Host& host, const Scene& scene);
