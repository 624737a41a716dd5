// SPDX-License-Identifier: Apache-2.0
// The shaders' formulas for the specular light of spheres, transcribed term by term in double
// precision. Tests use them to separate the rounding errors of float32 from the errors of the
// formulas, and tools/fit uses them to fit the constants of the formulas. The transcription does
// not say whether the formulas are right: that is found by comparison with engine/reference, which
// shares no code with it. The shaders explain the formulas; functions here have the names that they
// have there.
#pragma once

#include <glm/glm.hpp>

#include "shared/conic_constants.h"

namespace candelabra::transcription
{

// n and v are unit: the normal and the direction to the eye. NoV and the mirror direction are
// clamped as in the shaders.
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

// The fitted constants of shaders/shared/conic_constants.h under the same names, as variables, so
// that tools/fit can change them. The defaults are the values that the shaders have.
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
