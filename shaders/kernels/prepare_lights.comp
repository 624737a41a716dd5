// SPDX-License-Identifier: Apache-2.0
// Writes the lights in sorted order, transformed from the coordinates of the light set to view space
// and split into the part that every loop reads and the rest.
#version 460
#extension GL_GOOGLE_include_directive : require
#include "lib/light_shape.glsl"
#include "shared/light_order_data.h"

layout(local_size_x = PREPARE_LIGHTS_GROUP) in;
layout(push_constant, scalar) uniform Push
{
    PrepareLightsParams params;
};
layout(scalar, binding = PREPARE_LIGHTS_RECORDS) readonly buffer Records
{
    LightRecord records[];
};
layout(scalar, binding = PREPARE_LIGHTS_CORE) writeonly buffer Core
{
    vec4 core[];
};
layout(scalar, binding = PREPARE_LIGHTS_SHAPES) writeonly buffer Shapes
{
    LightShape shapes[];
};
layout(scalar, binding = PREPARE_LIGHTS_ORDER) readonly buffer Order
{
    LightKey order[];
};
layout(scalar, binding = PREPARE_LIGHTS_IDS) writeonly buffer Ids
{
    uint ids[];
};
layout(scalar, binding = PREPARE_LIGHTS_POLYGONS) readonly buffer Polygons
{
    PolygonRecord polygons[];
};
layout(constant_id = PREPARE_LIGHTS_WITH_IDS) const uint withIds = 0u;

// Writes the corners of the polygon at a place of the sorted order. Returns its shape, which refers to
// them, and sets its id.
LightShape preparePolygon(uint place, LightShape shape, inout uint id)
{
    const PolygonRecord polygon = polygons[id];
    const uint first = params.firstCornerShape + (place - params.firstPolygon) * CORNER_SHAPES;
    for (uint i = 0u; i < CORNER_SHAPES; ++i)
        shapes[first + i] = shapeOfCorners(polygon, i, shape.axisU, shape.axisV);
    shape.radius = float(polygon.count);
    shape.flags = shape.flags & LIGHT_TWO_SIDED | first;
    id = polygon.id;
    return shape;
}

void main()
{
    const uint i = gl_GlobalInvocationID.x;
    if (i >= params.lightCount)
        return;
    const LightRecord light = records[order[i].light];
    const uint type = light.flags & LIGHT_TYPE_MASK;
    const bool distant = (TYPES_WITH_POSITION >> type & 1u) == 0u;
    const vec3 origin = distant ? vec3(0.0) : params.originView;
    const bool inFrame = (light.flags >> LIGHT_LAYERS_SHIFT & params.layers) != 0u;
    core[i * LIGHT_CORE_STRIDE] = vec4(params.viewFromWorld * light.position + origin,
                                       inFrame ? light.boundingRadius : BOUNDING_RADIUS_OF_NONE);
    // A radius of 0 means that this is not a light (device_lights).
    const bool endless = params.uncut != 0u && light.influenceRadius > 0.0;
    const float influenceRadius = endless ? UNBOUNDED : light.influenceRadius;
    core[i * LIGHT_CORE_STRIDE + 1u] =
        vec4(light.emission, inFrame ? influenceRadius * influenceRadius : INFLUENCE2_OF_NONE);
    LightShape shape = rotatedShape(shapeOfRecord(light, type), type, params.viewFromWorld);
    uint id = light.id;
    if (type == LIGHT_POLYGON)
        shape = preparePolygon(i, shape, id);
    shapes[i] = shape;
    if (withIds != 0u)
        ids[i] = id;
}
