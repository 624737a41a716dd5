// SPDX-License-Identifier: Apache-2.0
// How far a stored depth may be from the surface.

// Returns half a step of the depth format as a distance along the view ray, in metres. The step leads
// towards 0.5, so that it stays in the range of depths.
float depthErrorAt(uvec2 pixel, float depth, vec3 position)
{
    const bool back = depth > 0.5;
    const uint bits = floatBitsToUint(depth);
    const float nextFloat = uintBitsToFloat(back ? bits - 1u : bits + 1u);
    const float nextInteger = back ? depth - shadowView.depthStep : depth + shadowView.depthStep;
    const float next = shadowView.depthStep == 0.0 ? nextFloat : nextInteger;
    const vec3 moved = viewPosition(frameParams.projection, pixel, frameParams.invImageSize, next);
    return 0.5 * length(moved - position);
}
