// SPDX-License-Identifier: Apache-2.0
#include "lights/light_types.h"

#include <cmath>

namespace candelabra::lighting
{
namespace
{

float lengthOf(const float (&v)[3])
{
    return std::hypot(v[0], v[1], v[2]);
}

} // namespace

float boundingRadiusOf(const CndLight& light)
{
    const uint32_t fields = fieldsOf(light.type);
    const float radius = fields & gpu::LIGHT_HAS_RADIUS ? light.radius : 0;
    if (!(fields & gpu::LIGHT_HAS_AXIS_U))
        return radius;
    const float u = lengthOf(light.axisU);
    return (fields & gpu::LIGHT_HAS_AXIS_V ? std::hypot(u, lengthOf(light.axisV)) : u) + radius;
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
    return lightType < gpu::LIGHT_TYPE_COUNT && lighting::isPunctual(lightType);
}

float cndEmitterBoundingRadius(const CndLight* light)
{
    return lighting::boundingRadiusOf(*light);
}
