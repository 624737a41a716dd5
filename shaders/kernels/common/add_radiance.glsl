// SPDX-License-Identifier: Apache-2.0
// The scene radiance image, to which kernels add light. The host may choose another format, which the
// engine then writes over this one (gpu/image_format.h).
#include "kernels/common/frame_params.glsl"

layout(binding = RADIANCE_IMAGE, rgba32f) uniform image2D radianceImage;

// Stores the radiance of a texel. What the image cannot hold becomes the largest value that it can; a
// NaN stays one.
void storeRadiance(ivec2 texel, vec4 radiance)
{
    const vec4 largest = vec4(vec3(frameParams.largestRadiance), radiance.a);
    imageStore(radianceImage, texel, mix(radiance, largest, greaterThan(radiance, largest)));
}

void addRadiance(uvec2 pixel, vec3 light)
{
    const ivec2 texel = texelOf(pixel);
    storeRadiance(texel, imageLoad(radianceImage, texel) + vec4(light, 0.0));
}
