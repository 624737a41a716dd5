// SPDX-License-Identifier: Apache-2.0
// The shaders' sphere light specular in double precision: the same formulas, term by term, so that
// the share of float32 in the error can be told from that of the formulas, and so that their
// constants can be fitted. Whether the formulas are right is not asked here (engine/reference knows
// the truth and shares nothing with this). The shaders explain the formulas; the functions here
// have their names.
#pragma once

#include <glm/glm.hpp>

#include "shared/conic_constants.h"

namespace candelabra::transcription
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

// The fitted constants of shaders/shared/conic_constants.h under the same names, as variables for
// the program that fits them; by default, what the shaders have.
struct ConicConstants {
#define X(name, value, meaning) double name = value;
    CND_CONIC_FITTED(X)
#undef X
};

SphereCap makeSphereCap(glm::dvec3 n, glm::dvec3 toLight, double radius);
ConicPoint makeConicPoint(ShadingPoint s);
glm::dvec2 conicAbove(ConicPoint p, SphereCap cap, const ConicConstants& k = {});
glm::dvec2 conicNear(ConicPoint p, SphereCap cap, const ConicConstants& k = {});
glm::dvec2 conicFullUnclipped(ConicPoint p, SphereCap cap, const ConicConstants& k = {});
glm::dvec2 conicClipped(ConicPoint p, SphereCap cap, const ConicConstants& k = {});
unsigned conicClassOf(ConicPoint p, SphereCap cap);
glm::dvec2 conicResponse(ConicPoint p, SphereCap cap, const ConicConstants& k = {});
glm::dvec2 conicFullResponse(ConicPoint p, SphereCap cap, const ConicConstants& k = {});

glm::dvec2 specularResponse(ShadingPoint p, glm::dvec3 l);
glm::dvec2 pointResponse(ShadingPoint p, SphereCap cap);
glm::dvec2 kxResponse(ShadingPoint p, SphereCap cap);

} // namespace candelabra::transcription
