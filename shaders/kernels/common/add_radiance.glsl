// SPDX-License-Identifier: Apache-2.0
// The scene radiance image, to which kernels add light. The host may choose another format, which the
// engine then writes over this one (gpu/image_format.h).
#include "kernels/common/frame_params.glsl"

layout(binding = RADIANCE_IMAGE, rgba32f) uniform image2D radianceImage;

// Stores the radiance of a pixel. What the image cannot hold becomes the largest value that it can; a
// NaN stays one.
void storeRadiance(ivec2 pixel, vec4 radiance)
{
    const vec4 largest = vec4(vec3(frameParams.largestRadiance), radiance.a);
    imageStore(radianceImage, pixel, mix(radiance, largest, greaterThan(radiance, largest)));
}

void addRadiance(ivec2 pixel, vec3 light)
{
    storeRadiance(pixel, imageLoad(radianceImage, pixel) + vec4(light, 0.0));
}
