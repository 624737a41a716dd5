// SPDX-License-Identifier: Apache-2.0
// Candelabra: C ABI of the lighting, environment and exposure modules.
//
// Conventions
//   Units: metres, seconds, radians, photometric light units (lm, cd, lx, cd/m^2). Colours are
//   linear Rec.709. Matrices are column-major (element [column*4 + row]), vectors are columns.
//   Ownership: a module borrows every Vulkan handle it is given, owns only what it created, never
//   creates a device or a queue, never submits and never waits. Recording allocates nothing.
//   Threads: different objects may be used from different threads; calls on one object, or on a
//   view and the CndLighting it came from, must not overlap.
//   Errors: every function that can fail returns a CndResult and, when `error` is not NULL, one
//   sentence naming the offending thing. Nothing is thrown.
//   Versioning: every descriptor starts with structSize = sizeof(the struct).
#ifndef CANDELABRA_CANDELABRA_H
#define CANDELABRA_CANDELABRA_H

#include "candelabra/core.h"
#include "candelabra/environment.h"
#include "candelabra/exposure.h"
#include "candelabra/lighting.h"
#include "candelabra/lights.h"

#endif
