// SPDX-License-Identifier: Apache-2.0
// Bends the stalk: writes the vertices from which it is drawn, and which cast its shadow.
#version 460
layout(local_size_x = 64) in;
layout(push_constant) uniform Push
{
    uint count, sides, rings;
    float length, radius;
    float bend; // angle between its ends
};
struct Vertex {
    float position[3], normal[3];
};
layout(std430, binding = 0) writeonly buffer Vertices
{
    Vertex vertices[];
};

void main()
{
    const uint i = gl_GlobalInvocationID.x;
    if (i >= count)
        return;
    const float along = float(i / sides) / float(rings);
    const float around = 6.2831853 * float(i % sides) / float(sides);
    const float angle = bend * along;
    // Points of a circular arc; a straight line if the angle is small.
    const float part = abs(angle) < 1e-3 ? 0.5 * angle : (1.0 - cos(angle)) / angle;
    const float up = abs(angle) < 1e-3 ? 1.0 : sin(angle) / angle;
    const vec3 centre = length * along * vec3(part, up, 0.0);
    const vec3 aside = vec3(cos(angle), -sin(angle), 0.0);
    const vec3 normal = cos(around) * aside + sin(around) * vec3(0.0, 0.0, 1.0);
    const vec3 position = centre + radius * (1.0 - along) * normal;
    vertices[i] = Vertex(float[3](position.x, position.y, position.z),
                         float[3](normal.x, normal.y, normal.z));
}
