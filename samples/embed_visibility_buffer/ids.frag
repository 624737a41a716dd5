// SPDX-License-Identifier: Apache-2.0
// Writes the visibility buffer: which object and which triangle a pixel shows.
#version 460
layout(location = 0) flat in uvec2 id;
layout(location = 0) out uvec2 ids;

void main()
{
    ids = id;
}
