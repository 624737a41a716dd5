// SPDX-License-Identifier: Apache-2.0
// Properties of the light types, from the list in shared/light_type_list.h.
#pragma once

#include <array>

#include "candelabra/lights.h"
#include "shared/light_type_list.h"

namespace candelabra::lighting
{

// A number of lights for each type.
using LightTypeCounts = std::array<uint32_t, CND_LIGHT_TYPE_COUNT>;

#define X(id, NAME, family, fields) static_assert(gpu::LIGHT_##NAME == uint32_t{CND_LIGHT_##NAME});
CND_LIGHT_TYPES(X)
#undef X
static_assert(gpu::LIGHT_TYPE_COUNT == uint32_t{CND_LIGHT_TYPE_COUNT});
static_assert(gpu::LIGHT_HAS_POSITION == uint32_t{CND_LIGHT_FIELD_POSITION_BIT} &&
              gpu::LIGHT_HAS_RADIUS == uint32_t{CND_LIGHT_FIELD_RADIUS_BIT} &&
              gpu::LIGHT_HAS_DIRECTION == uint32_t{CND_LIGHT_FIELD_DIRECTION_BIT} &&
              gpu::LIGHT_HAS_CONE == uint32_t{CND_LIGHT_FIELD_CONE_BIT} &&
              gpu::LIGHT_HAS_AXIS_U == uint32_t{CND_LIGHT_FIELD_AXIS_U_BIT} &&
              gpu::LIGHT_HAS_AXIS_V == uint32_t{CND_LIGHT_FIELD_AXIS_V_BIT} &&
              gpu::LIGHT_HAS_SIDES == uint32_t{CND_LIGHT_FIELD_TWO_SIDED_BIT} &&
              gpu::LIGHT_HAS_CORNERS == uint32_t{CND_LIGHT_FIELD_POLYGON_BIT});

// By light type: the fields of CndLight that it uses, as a mask of gpu::LIGHT_HAS_*.
inline constexpr auto fieldsOfTypes = [] {
    using namespace gpu;
#define X(id, NAME, family, fields) (fields),
    return std::array<uint32_t, LIGHT_TYPE_COUNT>{CND_LIGHT_TYPES(X)};
#undef X
}();

// Returns the fields of CndLight that the type uses, or 0 if `lightType` is not a type.
constexpr uint32_t fieldsOf(uint32_t lightType)
{
    return lightType < gpu::LIGHT_TYPE_COUNT ? fieldsOfTypes[lightType] : 0;
}

constexpr bool hasField(uint32_t lightType, uint32_t field)
{
    return (fieldsOf(lightType) & field) != 0;
}

// Distant lights have a direction and no position. They light every surface, so they are in no
// light tree and in no list.
constexpr bool isDistant(uint32_t lightType)
{
    return !hasField(lightType, gpu::LIGHT_HAS_POSITION);
}

// Returns the family of the type. Types that are shaded by the specular methods of spheres belong
// to FAMILY_SPHERE.
constexpr uint32_t baseFamilyOf(uint32_t lightType)
{
    using namespace gpu;
#define X(id, NAME, family, fields) FAMILY_##family,
    constexpr uint32_t families[] = {CND_LIGHT_TYPES(X)};
#undef X
    return families[lightType];
}

constexpr bool isSphere(uint32_t lightType)
{
    return baseFamilyOf(lightType) == gpu::FAMILY_SPHERE;
}

// boundingRadiusOf for types with axes.
float boundingRadiusOfAxes(const CndLight& light);
// Returns the radius of a sphere around the light's centre that holds its emitter: in metres, 0 for
// punctual lights, and the sine of the angular radius for distant spheres.
inline float boundingRadiusOf(const CndLight& light)
{
    const uint32_t fields = fieldsOf(light.type);
    return fields & gpu::LIGHT_HAS_AXIS_U   ? boundingRadiusOfAxes(light)
           : fields & gpu::LIGHT_HAS_RADIUS ? light.radius
                                            : 0;
}

// Returns the luminous power in lm of a light of this type and shape whose emission is 1, without
// its window. Throws gpu::Failure for directional and distant lights, which have none.
double luminousPowerPerEmission(const CndLight& light);

} // namespace candelabra::lighting
