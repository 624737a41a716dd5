// SPDX-License-Identifier: Apache-2.0
#include "lights/light_types.h"

#include <cmath>
#include <numbers>

#include <glm/geometric.hpp>
#include <glm/vec3.hpp>

#include "gpu/failure.h"
#include "lights/polygon.h"

namespace candelabra::lighting
{
namespace
{

using std::numbers::pi;

float lengthOf(const float (&v)[3])
{
    return std::hypot(v[0], v[1], v[2]);
}

double preciseLength(const float (&v)[3])
{
    return glm::length(glm::dvec3(v[0], v[1], v[2]));
}

double sides(VkBool32 twoSided)
{
    return twoSided ? 2 : 1;
}

} // namespace

float boundingRadiusOfAxes(const CndLight& light)
{
    const uint32_t fields = fieldsOf(light.type);
    if (fields & gpu::LIGHT_HAS_CORNERS)
        return polygonRadius(light);
    const float radius = fields & gpu::LIGHT_HAS_RADIUS ? light.radius : 0;
    const float u = lengthOf(light.axisU);
    return (fields & gpu::LIGHT_HAS_AXIS_V ? std::hypot(u, lengthOf(light.axisV)) : u) + radius;
}

double luminousPowerPerEmission(const CndLight& light)
{
    const double radius = light.radius;
    switch (light.type) {
    case CND_LIGHT_POINT:
        return 4 * pi;
    case CND_LIGHT_SPOT: {
        // Between the cones the attenuation is the square of a linear function of the cosine, from
        // 0 to 1: its mean is 1/3.
        const double inner = std::cos(double(light.innerConeAngle));
        const double outer = std::cos(double(light.outerConeAngle));
        return 2 * pi * (1 - inner + (inner - outer) / 3);
    }
    case CND_LIGHT_SPHERE:
        return 4 * pi * pi * radius * radius;
    case CND_LIGHT_TUBE: // pi times the area of the capsule
        return pi * (2 * pi * radius * (2 * preciseLength(light.axisU) + 2 * radius));
    case CND_LIGHT_RECTANGLE:
        return 4 * pi * preciseLength(light.axisU) * preciseLength(light.axisV) *
               sides(light.twoSided);
    case CND_LIGHT_DISC:
        return pi * pi * radius * radius * sides(light.twoSided);
    case CND_LIGHT_POLYGON:
        return pi * preciseLength(light.axisU) * preciseLength(light.axisV) *
               polygonArea(*light.polygon) * sides(light.twoSided);
    case CND_LIGHT_DIRECTIONAL:
    case CND_LIGHT_DISTANT_SPHERE:
        gpu::failArgument("a directional or distant light has no luminous power");
    default:
        gpu::failArgument("type is not a CndLightType");
    }
}

} // namespace candelabra::lighting

using namespace candelabra;

uint32_t cndLightFields(uint32_t lightType)
{
    return lighting::fieldsOf(lightType);
}

VkBool32 cndIsDistant(uint32_t lightType)
{
    return lightType < gpu::LIGHT_TYPE_COUNT && lighting::isDistant(lightType);
}

VkBool32 cndIsPunctual(uint32_t lightType)
{
    return lightType < gpu::LIGHT_TYPE_COUNT &&
           lighting::baseFamilyOf(lightType) == gpu::FAMILY_PUNCTUAL;
}

float cndEmitterBoundingRadius(const CndLight* light)
{
    return lighting::boundingRadiusOf(*light);
}
