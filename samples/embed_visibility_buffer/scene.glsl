// SPDX-License-Identifier: Apache-2.0
// The buffers of the scene, for the shaders that draw it and for the function that Candelabra
// calls. They are in the descriptor set SCENE_SET, which the includer defines.
struct Vertex {
    vec3 position, normal;
};
struct Object {
    mat4x3 worldFromMesh;
    vec3 albedo;
    float perceptualRoughness;
};
layout(scalar, set = SCENE_SET, binding = 0) readonly buffer Vertices
{
    Vertex vertices[];
};
layout(scalar, set = SCENE_SET, binding = 1) readonly buffer Indices
{
    uint indices[]; // of all meshes: three per triangle
};
layout(scalar, set = SCENE_SET, binding = 2) readonly buffer Objects
{
    Object objects[];
};
layout(scalar, set = SCENE_SET, binding = 3) uniform Camera
{
    mat4 clipFromWorld;
    mat3 viewFromWorld;
    vec2 pixels; // of the frame
};

// The material: a pattern in the space of the mesh.
vec3 albedoAt(Object object, vec3 positionMesh)
{
    const vec3 waves = sin(12.0 * positionMesh);
    return object.albedo * (0.75 + 0.25 * waves.x * waves.z);
}
