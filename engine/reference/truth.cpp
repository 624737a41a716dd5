// SPDX-License-Identifier: Apache-2.0
#include "reference/truth.h"

#include <algorithm>
#include <array>
#include <stdexcept>
#include <string>

#include "reference/direction_domain.h"
#include "reference/light.h"
#include "reference/slope_domain.h"
#include "reference/sphere_light.h"
#include "reference/vectors.h"

namespace candelabra::reference
{

namespace
{

// Integrates over the directions to the light (direction_domain.h).
LightResponse truthOfOutline(const SurfacePoint& surface, double alpha, const Outline& outline,
                             double relative)
{
    LightResponse out;
    if (alpha > 0)
        out = directionDomainSpecular(surface, alpha, outline, relative);
    const LightResponse diffuse = directionDomainDiffuse(surface.normal, outline, relative);
    out.f = diffuse.f;
    out.fError = diffuse.fError;
    out.converged = out.converged && diffuse.converged;
    return out;
}

// The cap of sphereCap(). At the very centre the form factor is that of c = 0.
LightResponse truthOfSphere(const SurfacePoint& surface, double alpha, const glm::dvec3& toCenter,
                            double radius, double relative)
{
    if (glm::dot(toCenter, toCenter) > 0)
        return truthOfCap(surface, alpha, sphereCap(toCenter, radius), relative);
    LightResponse out;
    out.f = sphereFormFactor(0, 1);
    return out;
}

// Inside a tube and at its surface: the hemisphere towards the nearest point of its segment, which
// is continuous as for the sphere. On the segment: as at the centre of a sphere.
LightResponse truthOfTube(const SurfacePoint& surface, double alpha, const CndLight& light,
                          const glm::dvec3& toCenter, double relative)
{
    const glm::dvec3 half = vec3(light.axisU);
    const double along = -glm::dot(toCenter, half) / glm::dot(half, half);
    const glm::dvec3 toNearest = toCenter + std::clamp(along, -1.0, 1.0) * half;
    if (!(glm::length(toNearest) > 0))
        return truthOfSphere(surface, alpha, toNearest, light.radius, relative);
    if (!(glm::length(toNearest) > light.radius * (1 + 1e-12)))
        return truthOfOutline(surface, alpha, *capOutline(sphereCap(toNearest, light.radius)),
                              relative);
    const auto outline = capsuleOutline(toCenter - half, toCenter + half, light.radius);
    return truthOfOutline(surface, alpha, *outline, relative);
}

// Whether a receiver sees a flat light: not from behind unless it is two-sided, and not from a
// point in its plane.
bool seesFlatLight(const glm::dvec3& normal, const glm::dvec3& toCenter, VkBool32 twoSided)
{
    const double height = -glm::dot(normal, toCenter);
    return twoSided ? height != 0 : height > 0;
}

bool hasSpecular(const Material& material)
{
    return material.f0 != glm::dvec3(0) || material.specularWeight != 0;
}

} // namespace

SphereCap sphereCap(const glm::dvec3& toCenter, double radius)
{
    const double distance = glm::length(toCenter);
    if (!(distance > 0))
        return {};
    const double s = std::min(radius / distance, 1.0);
    return {toCenter / distance, s * s};
}

LightResponse truthOfCap(const SurfacePoint& surface, double alpha, const SphereCap& cap,
                         double relative)
{
    LightResponse out;
    if (alpha > 0)
        out = slopeDomainSpecular(surface, alpha, cap, relative);
    const double c = glm::dot(surface.normal, cap.axis);
    out.f = sphereFormFactor(std::clamp(c, -1.0, 1.0), std::min(cap.sine(), 1.0));
    return out;
}

LightResponse truthResponse(const SurfacePoint& surface, double alpha, const CndLight& light,
                            const glm::dvec3& lightOrigin, double relative)
{
    const glm::dvec3 toCenter = lightOrigin + vec3(light.position) - surface.position;
    switch (light.type) {
    case CND_LIGHT_SPHERE:
        return truthOfSphere(surface, alpha, toCenter, light.radius, relative);
    case CND_LIGHT_DISTANT_SPHERE: { // the cap of sine `radius` around the opposite of `direction`
        const double s = std::min(double(light.radius), 1.0);
        return truthOfCap(surface, alpha, {-glm::normalize(vec3(light.direction)), s * s},
                          relative);
    }
    case CND_LIGHT_TUBE:
        return truthOfTube(surface, alpha, light, toCenter, relative);
    case CND_LIGHT_RECTANGLE: {
        const glm::dvec3 u = vec3(light.axisU), v = vec3(light.axisV);
        if (!seesFlatLight(glm::cross(u, v), toCenter, light.twoSided))
            return {};
        const std::array<glm::dvec3, 4> corners = {toCenter - u - v, toCenter + u - v,
                                                   toCenter + u + v, toCenter - u + v};
        return truthOfOutline(surface, alpha, *polygonOutline(std::span<const glm::dvec3>(corners)),
                              relative);
    }
    case CND_LIGHT_POLYGON: {
        if (!seesFlatLight(glm::cross(vec3(light.axisU), vec3(light.axisV)), toCenter,
                           light.twoSided))
            return {};
        return truthOfOutline(surface, alpha, *polygonOutline(polygonCorners(light, toCenter)),
                              relative);
    }
    case CND_LIGHT_DISC: {
        const glm::dvec3 normal = glm::normalize(vec3(light.direction));
        if (!seesFlatLight(normal, toCenter, light.twoSided))
            return {};
        return truthOfOutline(surface, alpha, *discOutline(toCenter, normal, light.radius),
                              relative);
    }
    default:
        throw std::invalid_argument("light type " + std::to_string(light.type) +
                                    " is no area light");
    }
}

Truth truthLuminance(const SurfacePoint& surface, const Material& material, const CndLight& light,
                     const glm::dvec3& lightOrigin, double relative)
{
    if (light.type == CND_LIGHT_POINT || light.type == CND_LIGHT_SPOT ||
        light.type == CND_LIGHT_DIRECTIONAL) {
        // Any method but CND_SPECULAR_NONE does: punctual lights have only one specular lobe.
        return {.luminance = outgoingLuminance(surface, material, light, lightOrigin,
                                               hasSpecular(material) ? CND_SPECULAR_KARIS
                                                                     : CND_SPECULAR_NONE)};
    }
    double window = 1;
    if (light.type != CND_LIGHT_DISTANT_SPHERE) {
        const double distance = glm::distance(lightOrigin + vec3(light.position), surface.position);
        window = lightWindow(distance, light.influenceRadius);
    }
    if (window == 0)
        return {};
    const LightResponse r = truthResponse(surface, hasSpecular(material) ? material.alpha : 0,
                                          light, lightOrigin, relative);
    const glm::dvec3 emission = vec3(light.emission) * window;
    return {emission * (material.diffuseAlbedo * r.f +
                        material.specularGain * (material.f0 * (r.a - r.b) +
                                                 glm::dvec3(material.specularWeight * r.b))),
            r.converged, emission * material.specularGain * material.f0 * r.a,
            emission * material.specularGain * (material.specularWeight - material.f0) * r.b,
            emission * material.diffuseAlbedo * r.f};
}

} // namespace candelabra::reference
