// SPDX-License-Identifier: Apache-2.0
// Transcribed from shaders/lib/brdf.glsl and shaders/lib/specular/kx.glsl.
#include <algorithm>
#include <cmath>
#include <numbers>

#include "transcription/conic.h"

namespace candelabra::transcription
{

ShadingPoint makeShadingPoint(glm::dvec3 n, glm::dvec3 v, double alpha)
{
    ShadingPoint p{};
    p.n = n;
    p.v = glm::normalize(v);
    p.NoV = std::max(glm::dot(n, p.v), 1e-4);
    p.mirror = 2.0 * p.NoV * n - p.v;
    p.alpha = std::max(alpha, 0.002);
    const double a2 = p.alpha * p.alpha;
    p.smithV = std::sqrt(a2 + (1 - a2) * p.NoV * p.NoV);
    return p;
}

glm::dvec2 specularResponse(ShadingPoint p, glm::dvec3 l)
{
    const double NoL = glm::dot(p.n, l);
    const glm::dvec3 h = p.v + l;
    const double h2 = std::max(glm::dot(h, h), 1e-30);
    const double a2 = p.alpha * p.alpha;
    const glm::dvec3 nxh = glm::cross(p.n, h);
    const double noh = glm::dot(p.n, h);
    const double width = std::max(glm::dot(nxh, nxh) + noh * noh * a2, h2 * a2);
    const double smithL = std::sqrt(a2 + (1 - a2) * NoL * NoL);
    const double visibility = 0.5 / (NoL * p.smithV + p.NoV * smithL);
    const double q = h2 / width;
    const double d = a2 / std::numbers::pi * q * q;
    const double VoH = std::clamp(glm::dot(p.v, h) / std::sqrt(h2), 0.0, 1.0);
    const double a = NoL > 0 ? d * visibility * NoL : 0;
    return {a, a * std::pow(1 - VoH, 5)};
}

glm::dvec2 pointResponse(ShadingPoint p, SphereCap cap)
{
    return glm::min(std::numbers::pi * cap.s2 * specularResponse(p, cap.c), glm::dvec2(1));
}

glm::dvec2 kxResponse(ShadingPoint p, SphereCap cap)
{
    const glm::dvec3 toRay = glm::dot(cap.c, p.mirror) * p.mirror - cap.c;
    const double reach = cap.s / std::sqrt(std::max(glm::dot(toRay, toRay), 1e-30));
    const glm::dvec3 closest = cap.c + toRay * std::min(reach, 1.0);
    const glm::dvec3 l = closest / std::sqrt(std::max(glm::dot(closest, closest), 1e-30));
    const double VoH2 = 0.5 * std::max(1 + glm::dot(p.v, l), 1e-6);
    const double q = cap.s * cap.s / (4 * p.alpha * p.alpha);
    const double peak = 1 / std::sqrt((1 + q) * (1 + q / VoH2));
    return glm::min(2 * std::numbers::pi * cap.omc * peak * specularResponse(p, l), glm::dvec2(1));
}

} // namespace candelabra::transcription
