// SPDX-License-Identifier: Apache-2.0
// The function that Candelabra's kernels call. It follows scene.glsl in one source.
layout(set = SCENE_SET, binding = 4) uniform utexture2D ids;

CndSurface candelabraReadSurface(ivec2 texel)
{
    const uvec2 id = texelFetch(ids, texel, 0).xy;
    const Object object = objects[id.x];
    const vec2 pixel = vec2(texel - ivec2(cndGbufferView.firstTexel)) + 0.5;
    const vec2 ndc = 2.0 * pixel / pixels - 1.0;
    Vertex corners[3];
    precise vec3 x, y; // of the corners in clip space, relative to the pixel
    for (int i = 0; i < 3; ++i) {
        corners[i] = vertices[indices[3u * id.y + uint(i)]];
        precise const vec3 world = object.worldFromMesh * vec4(corners[i].position, 1.0);
        precise const vec4 clip = clipFromWorld * vec4(world, 1.0);
        x[i] = clip.x - ndc.x * clip.w;
        y[i] = clip.y - ndc.y * clip.w;
    }
    // The pixel shows the corners with these weights: the sums of weight * x and weight * y are 0.
    precise vec3 weights = cross(x, y);
    weights /= weights.x + weights.y + weights.z;
    precise vec3 normalMesh = vec3(0.0), positionMesh = vec3(0.0);
    for (int i = 0; i < 3; ++i) {
        normalMesh += weights[i] * corners[i].normal;
        positionMesh += weights[i] * corners[i].position;
    }
    precise const vec3 normalWorld = mat3(object.worldFromMesh) * normalMesh;

    CndSurface s;
    s.normal = cndGbufferView.viewFromWorld * normalWorld; // of any length
    s.albedo = albedoAt(object, positionMesh);             // diffuse
    s.F0 = vec3(0.04);
    s.specularWeight = 1.0; // Schlick's F90
    s.perceptualRoughness = object.perceptualRoughness;
    return s;
}
