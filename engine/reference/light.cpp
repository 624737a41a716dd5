// SPDX-License-Identifier: Apache-2.0
#include "reference/light.h"

#include <algorithm>
#include <cmath>
#include <stdexcept>
#include <string>

#include "reference/brdf.h"
#include "reference/sphere_light.h"
#include "reference/vectors.h"

namespace candelabra::reference
{

namespace
{

bool hasSpecular(const Material& material, CndSpecularMethod method)
{
    return method != CND_SPECULAR_NONE &&
           (material.f0 != glm::dvec3(0) || material.specularWeight != 0);
}

// Returns the outgoing luminance under illuminance `perpendicular` (lx on a surface that faces the
// light) from one direction.
glm::dvec3 fromDirection(const SurfacePoint& surface, const Material& material,
                         const glm::dvec3& toLight, const glm::dvec3& perpendicular,
                         CndSpecularMethod method)
{
    const double NoL = glm::dot(surface.normal, toLight);
    if (NoL <= 0)
        return glm::dvec3(0);
    glm::dvec3 brdf = material.diffuseAlbedo * lambertBrdf();
    if (hasSpecular(material, method)) {
        const SpecularBrdf lobe = ggxBrdf(surface.normal, surface.toEye, toLight, material.alpha);
        const double p = lobe.schlickWeight;
        brdf += lobe.value * material.specularGain *
                (material.f0 * (1 - p) + glm::dvec3(material.specularWeight * p));
    }
    return perpendicular * NoL * brdf;
}

glm::dvec3 fromPosition(const SurfacePoint& surface, const Material& material,
                        const CndLight& light, const glm::dvec3& position, CndSpecularMethod method)
{
    const glm::dvec3 offset = position - surface.position;
    const double distance = glm::length(offset);
    const double window = lightWindow(distance, light.influenceRadius);
    if (distance == 0 || window == 0)
        return glm::dvec3(0);
    const glm::dvec3 toLight = offset / distance;
    glm::dvec3 intensity = vec3(light.emission);
    if (light.type == CND_LIGHT_SPOT) {
        const glm::dvec3 chord = glm::normalize(vec3(light.direction)) + toLight;
        intensity *=
            spotAttenuation(glm::dot(chord, chord) / 4, light.innerConeAngle, light.outerConeAngle);
    }
    return fromDirection(surface, material, toLight, intensity * (window / (distance * distance)),
                         method);
}

glm::dvec3 fromSphere(const SurfacePoint& surface, const Material& material, const CndLight& light,
                      const glm::dvec3& center, CndSpecularMethod method)
{
    const double window =
        lightWindow(glm::distance(center, surface.position), light.influenceRadius);
    if (window == 0)
        return glm::dvec3(0);
    glm::dvec3 response = material.diffuseAlbedo * sphereDiffuse(surface, center, light.radius);
    if (hasSpecular(material, method)) {
        const auto [a, b] = karisSphereSpecular(surface, material.alpha, center, light.radius);
        response += material.specularGain *
                    (material.f0 * (a - b) + glm::dvec3(material.specularWeight * b));
    }
    return vec3(light.emission) * window * response;
}

} // namespace

double spotAttenuation(double halfSine2, double innerConeAngle, double outerConeAngle)
{
    const double inner = std::pow(std::sin(innerConeAngle / 2), 2);
    const double outer = std::pow(std::sin(outerConeAngle / 2), 2);
    const double t = std::clamp((outer - halfSine2) / (outer - inner), 0.0, 1.0);
    return t * t;
}

glm::dvec3 outgoingLuminance(const SurfacePoint& surface, const Material& material,
                             const CndLight& light, const glm::dvec3& lightOrigin,
                             CndSpecularMethod specularMethod)
{
    const glm::dvec3 position = lightOrigin + vec3(light.position);
    switch (light.type) {
    case CND_LIGHT_POINT:
    case CND_LIGHT_SPOT:
        return fromPosition(surface, material, light, position, specularMethod);
    case CND_LIGHT_SPHERE:
        return fromSphere(surface, material, light, position, specularMethod);
    case CND_LIGHT_DIRECTIONAL:
        return fromDirection(surface, material, -glm::normalize(vec3(light.direction)),
                             vec3(light.emission), specularMethod);
    default:
        throw std::invalid_argument("light type " + std::to_string(light.type) + " is unknown");
    }
}

} // namespace candelabra::reference
