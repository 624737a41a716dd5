// SPDX-License-Identifier: Apache-2.0
// A G-buffer as many renderers have it: a normal in world space and a colour, without roughness.
#version 460
layout(location = 0) out vec4 normal;
layout(location = 1) out vec4 albedo;
layout(location = 2) out vec4 emission; // into the radiance image

void main()
{
    normal = vec4(0.0, 0.0, 1.0, 0.0);
    albedo = vec4(vec3(0.6), 1.0);
    emission = vec4(0.25, 0.0, 0.0, 1.0); // cd/m^2
}
