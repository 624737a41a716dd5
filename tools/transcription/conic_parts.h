// SPDX-License-Identifier: Apache-2.0
// Constants, structs and small functions that several files of the transcription use.
#pragma once

#include <algorithm>
#include <cmath>
#include <numbers>

#include "transcription/conic.h"

namespace candelabra::transcription
{

inline constexpr double PI = std::numbers::pi;
inline constexpr double INV_PI = 1 / PI;
inline constexpr double HALF_PI = PI / 2;
inline constexpr double MIN_LENGTH2 = 1e-30;
inline constexpr double MAX_SPECULAR_S2 = 0.9999;
inline const double MIN_CONIC_NOV = gpu::MIN_CONIC_NOV;
inline const double MIN_CONIC_MU = gpu::MIN_CONIC_MU;
inline const double MAX_SLOPE_VARIANCE = gpu::MAX_SLOPE_VARIANCE;
inline const double MIN_VARIANCE = gpu::MIN_VARIANCE;
inline const double SMALL_CAP = gpu::SMALL_CAP;

inline double saturate(double x)
{
    return std::clamp(x, 0.0, 1.0);
}

inline double pow5(double x)
{
    return x * x * x * x * x;
}

inline double length2(glm::dvec3 x)
{
    return glm::dot(x, x);
}

inline double inversesqrt(double x)
{
    return 1 / std::sqrt(x);
}

struct ConicRegion {
    double integral;
    double x2;
    double av;
    double mu;
};

struct CapHeights {
    double low, high, mean;
};

struct HeightNodes {
    double low, high;
};

struct LightHeights {
    double low, high;
    double mean, variance;
};

struct CapFrame {
    double sinC;
    double v1, v2;
};

struct Chord {
    double cp, sp, cm;
};

struct CapCone {
    double xx, xy, xz, yy, yz, zz;
    double sg;
    double tr, D0, lam;
};

struct ConeAxes {
    glm::dvec3 e, e1, e2;
    double A2, B2;
};

struct SubstituteCap {
    glm::dvec3 c;
    double NoC, s2, omc;
};

double halley(double t, double tr, double m2, double D0);
ConicRegion wholeCap(ConicPoint p, glm::dvec3 c, double NoC, double s2, double omc);
double smith(ConicPoint p, double NoL);
glm::dvec2 shadeOneNode(ConicPoint p, ConicRegion o, const ConicConstants& k);
CapHeights capHeights(SphereCap cap, double sinC, const ConicConstants& k);
HeightNodes heightNodes(CapHeights z, const ConicConstants& k);
LightHeights weighHeights(ConicPoint p, CapHeights z, HeightNodes nodes, double ha, double hb);
LightHeights lightHeights(ConicPoint p, CapHeights z, double v1, const ConicConstants& k);
glm::dvec2 shadeTwoNodes(ConicPoint p, ConicRegion o, LightHeights z, double elongation,
                         const ConicConstants& k);
glm::dvec2 atanTail(glm::dvec2 t2);
glm::dvec2 atan2Pair(glm::dvec2 y, glm::dvec2 x);
double atanhRatio(double y, double x);
double conicRoot(double tr, double m2, double D0);
CapFrame makeCapFrame(ConicPoint p, glm::dvec3 c, double NoC);
Chord makeChord(SphereCap cap, double sinC);
glm::dvec3 horizonArc(ConicPoint p, CapFrame f, Chord chord);
CapCone makeCapCone(ConicPoint p, SphereCap cap, CapFrame f);
ConeAxes makeConeAxes(CapCone q, glm::dvec3 inside);
glm::dvec3 capArc(ConeAxes axes, double sg, glm::dvec3 wc, double sp, bool above);
ConicRegion clippedCap(ConicPoint p, SphereCap cap, CapFrame f);
SubstituteCap substituteCap(ConicPoint p, SphereCap cap, const ConicConstants& k);
unsigned conicClass(double heightAbove, double radius, double d2, double a2);
double nearness(SphereCap cap);
glm::dvec2 conicUnclipped(ConicPoint p, SphereCap cap, bool mixed, const ConicConstants& k);

} // namespace candelabra::transcription
