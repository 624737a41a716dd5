// SPDX-License-Identifier: Apache-2.0
// The shaders' sphere light specular in double: the same formulas, term by term, so that float32's
// share of the error can be told from the formulas' own. Whether the formulas are right is not
// asked here (reference/ knows the truth and shares nothing with this).
#pragma once

#include <glm/glm.hpp>

namespace candelabra::test::transcription
{

// Unit normal and direction to the eye; NoV and mirror as the shaders clamp them.
struct ShadingPoint {
    glm::dvec3 n, v, mirror;
    double NoV, alpha, smithV;
};
// v need not be unit.
ShadingPoint makeShadingPoint(glm::dvec3 n, glm::dvec3 v, double alpha);

struct SphereCap {
    glm::dvec3 c;
    double NoC, s2, s, omc;
};

struct ConicPoint {
    glm::dvec3 n;
    glm::dvec3 v;
    glm::dvec3 mirror;
    glm::dvec3 vxn;
    double NoV;
    double vv;
    double alpha, a2, oneMinusA2, invA2;
    double smithV;
};

inline constexpr unsigned CONIC_BELOW = 0u;
inline constexpr unsigned CONIC_ABOVE = 1u;
inline constexpr unsigned CONIC_NEAR = 2u;
inline constexpr unsigned CONIC_CLIPPED = 3u;

SphereCap makeSphereCap(glm::dvec3 n, glm::dvec3 toLight, double radius);
ConicPoint makeConicPoint(ShadingPoint s);
glm::dvec2 conicAbove(ConicPoint p, SphereCap cap);
glm::dvec2 conicNear(ConicPoint p, SphereCap cap);
glm::dvec2 conicFullUnclipped(ConicPoint p, SphereCap cap);
glm::dvec2 conicClipped(ConicPoint p, SphereCap cap);
unsigned conicClassOf(ConicPoint p, SphereCap cap);
glm::dvec2 conicResponse(ConicPoint p, SphereCap cap);
glm::dvec2 conicFullResponse(ConicPoint p, SphereCap cap);

glm::dvec2 specularResponse(ShadingPoint p, glm::dvec3 l);
glm::dvec2 pointResponse(ShadingPoint p, SphereCap cap);
glm::dvec2 kxResponse(ShadingPoint p, SphereCap cap);

} // namespace candelabra::test::transcription
