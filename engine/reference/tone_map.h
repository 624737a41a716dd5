// SPDX-License-Identifier: Apache-2.0
// Tone mapping curves and the sRGB transfer function. In double precision.
#pragma once

#include <glm/glm.hpp>

#include "candelabra/candelabra.h"

namespace candelabra::reference
{

// Maps exposed linear Rec.709 to display-linear Rec.709 in [0, 1]. Before every curve NaN and
// negative channels become 0, and channels above 1e15 (infinity included) become 1e15, where all
// curves have long reached white.
//   NONE         clipped.
//   REINHARD     Reinhard et al. 2002, eq. 3, on each channel: c / (1 + c).
//   ACES         Hill's fit of RRT + sRGB ODT with its matrices (Pettineo's BakingLab, ACES.hlsl).
//   PBR_NEUTRAL  Khronos PBR Neutral specification (KhronosGroup/ToneMapping, PBR_Neutral).
//   AGX          Sobotka's AgX base look in Wrensch's "Minimal AgX Implementation" (a sixth-order
//                polynomial), linearised with the exponent 2.2 of its display.
// All curves are applied to the exposed value times middleGreyGain(). An unknown curve throws
// std::invalid_argument.
glm::dvec3 toneMap(CndToneMap curve, const glm::dvec3& exposed);

// The factor with which a curve displays the exposed grey 0.18 at a luminance of 0.18. Throws
// std::invalid_argument for an unknown curve.
double middleGreyGain(CndToneMap curve);

// Encodes display-linear [0, 1] with the exact piecewise form of IEC 61966-2-1.
double srgbEncode(double linear);

} // namespace candelabra::reference
