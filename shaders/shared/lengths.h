// SPDX-License-Identifier: Apache-2.0
// Limits of the lengths that kernels compute with, in metres.
#ifndef CND_SHARED_LENGTHS_H
#define CND_SHARED_LENGTHS_H

#include "shared/prelude.h"

GPU_BEGIN

// Limits of coordinates and lengths of lights: beyond them, squares of lengths are infinite or 0 in
// float32.
const float MAX_LIGHT_COORDINATE = 1e15f;
const float MIN_LIGHT_LENGTH = 1e-15f;

// Stands for an infinite length, such as the influence radius of an uncut light. Infinity itself is
// stored nowhere, because a driver may compile shaders as if there were none, and then a square
// root or a product with 0 may give NaN. The square of this length, times 100, is still finite.
// Distances between lights and surfaces that they light are far shorter: at 1e16 m, (d / r)^4 is
// 1e-8, so the window of an uncut light is exactly 1 in float32.
const float UNBOUNDED = 1e18f;

GPU_END

#endif
