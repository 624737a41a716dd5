// SPDX-License-Identifier: Apache-2.0
#include "scene/light_types.h"

#include <algorithm>
#include <cassert>

#include "scene/polygons.h"

namespace candelabra::app
{

using enum LightKeyMeaning;

const LightTypeInfo& lightTypeInfo(uint32_t type)
{
    static const std::vector<std::string> luminance = {"radiance", "luminance", "luminous_power"};
    static const std::vector<std::string> intensity = {"intensity", "luminous_power"};
    // By CndLightType.
    static const LightTypeInfo types[] = {
        {.name = "point", .keys = {{"position", Position}}, .emission = intensity, .lamp = {}},
        {.name = "sphere",
         .keys = {{"position", Position}, {"radius", Radius}},
         .emission = {"radiance", "luminance", "luminous_power", "intensity"},
         .lamp = {.radius = 0.34f}},
        {.name = "spot",
         .keys = {{"position", Position},
                  {"direction", Direction},
                  {"inner_cone_degrees", InnerCone},
                  {"outer_cone_degrees", OuterCone}},
         .emission = intensity,
         .lamp = {.innerConeAngle = 0.25f, .outerConeAngle = 0.6f}},
        {.name = "directional",
         .keys = {{"direction", Direction}},
         .emission = {"illuminance"},
         .lamp = {}},
        {.name = "distant_sphere",
         .keys = {{"direction", Direction}, {"sin_angular_radius", Sine}},
         .emission = {"radiance", "luminance", "illuminance"},
         .lamp = {.radius = CND_SUN_SINE}},
        {.name = "tube",
         .keys = {{"start", SegmentStart}, {"end", SegmentEnd}, {"radius", Radius}},
         .emission = luminance,
         .lamp = {.radius = 0.06f, .axisU = {0.55f, 0.13f, 0.1f}}},
        {.name = "rectangle",
         .keys = {{"position", Position},
                  {"axis_u", AxisU},
                  {"axis_v", AxisV},
                  {"two_sided", TwoSided}},
         .emission = luminance,
         .lamp = {.axisU = {0.55f, 0, 0}, .axisV = {0.3f, 0, 0}}},
        {.name = "disc",
         .keys = {{"position", Position},
                  {"normal", Direction},
                  {"radius", Radius},
                  {"two_sided", TwoSided}},
         .emission = luminance,
         .lamp = {.radius = 0.4f, .twoSided = VK_TRUE}},
        {.name = "polygon",
         .keys = {{"corners", Corners}, {"two_sided", TwoSided}},
         .emission = luminance,
         .lamp = {.axisU = {0.45f, 0, 0}, .axisV = {0.4f, 0, 0}, .polygon = regularPolygon(5)}},
    };
    static_assert(std::size(types) == CND_LIGHT_TYPE_COUNT);
    assert(type < CND_LIGHT_TYPE_COUNT);
    return types[type];
}

const char* lightTypeName(uint32_t type)
{
    return lightTypeInfo(type).name;
}

std::string lightTypeLabel(uint32_t type)
{
    std::string label = lightTypeName(type);
    std::ranges::replace(label, '_', ' ');
    return label;
}

std::vector<uint32_t> areaLightTypes()
{
    std::vector<uint32_t> types;
    for (uint32_t type = 0; type < CND_LIGHT_TYPE_COUNT; ++type)
        if (!cndIsPunctual(type))
            types.push_back(type);
    return types;
}

} // namespace candelabra::app
