// SPDX-License-Identifier: Apache-2.0
// A box: six faces of two triangles each, with front faces outside.
#version 460
layout(push_constant) uniform Push
{
    mat4 clipFromWorld;
    vec4 centre;             // w: perceptual roughness
    vec4 halfSize;           // w: metalness
    vec4 baseColour;         // linear
};
layout(location = 0) out vec3 normalWorld;

void main()
{
    const int face = gl_VertexIndex / 6, axis = face % 3;
    const float side = face < 3 ? 1.0 : -1.0;
    const vec2 corners[6] = {vec2(-1, -1), vec2(1, -1), vec2(1, 1), vec2(-1, -1), vec2(1, 1),
                             vec2(-1, 1)};
    const vec2 corner = corners[gl_VertexIndex % 6];
    vec3 at;
    at[axis] = side;
    at[(axis + 1) % 3] = corner.x * side; // times side: keeps the winding on opposite faces
    at[(axis + 2) % 3] = corner.y;
    normalWorld = vec3(0.0);
    normalWorld[axis] = side;
    gl_Position = clipFromWorld * vec4(centre.xyz + at * halfSize.xyz, 1.0);
}
