// SPDX-License-Identifier: Apache-2.0
// What the vertex shader of meshes gives the fragment shader. Both are compiled for one of
//   CONSTANT  the material is the same all over the mesh, and the vertex shader packs it
//   COLORED   as before, but vertex colours tint the albedo, which fragments pack
//   SAMPLED   anything else: fragments read the material, and textures
// and each has only the varyings that it needs, because llvmpipe interpolates unused ones as well.
#ifdef GL_VERTEX_SHADER
#define VARYING out
#else
#define VARYING in
#endif

layout(location = 0) VARYING vec3 varyingNormal; // view space, not normalised
// Index of the material, and: unless sampled, the roughness in the bits that it has beside the normal;
// if sampled, the instance, and MeshParams::coverageFrame.
layout(location = 1) flat VARYING uvec3 varyingMaterial;
#ifdef SAMPLED
layout(location = 2) VARYING vec4 varyingTangent; // view space
layout(location = 3) VARYING vec4 varyingUv;
layout(location = 4) VARYING vec4 varyingColor;
#elif defined(COLORED)
layout(location = 2) VARYING vec3 varyingAlbedo;
layout(location = 3) flat VARYING uvec2 varyingSpecular; // packed
#else
layout(location = 2) flat VARYING uvec4 varyingAlbedoSpecular; // both packed
#endif
