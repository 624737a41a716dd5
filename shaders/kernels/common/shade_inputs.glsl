// SPDX-License-Identifier: Apache-2.0
// The bindings that the kernels share which evaluate lights per pixel.
#include "shared/lighting_data.h"
#include "kernels/common/read_gbuffer.glsl"
#include "lib/brdf.glsl"
#include "lib/projection.glsl"
#include "kernels/common/light_stream.glsl"

layout(scalar, binding = SHADE_SHAPES) readonly buffer LightShapes
{
    LightShape lightShapes[];
};
layout(scalar, binding = SHADE_LIGHT_IDS) readonly buffer LightIds
{
    uint lightIds[];
};
layout(binding = SHADE_DEPTH) uniform texture2D depthImage;
