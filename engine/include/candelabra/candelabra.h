// SPDX-License-Identifier: Apache-2.0
// Candelabra: the C ABI of the lighting, environment and exposure modules. This header includes all
// of it except the optional compiler (candelabra/compiler.h).
//
// Conventions
//   Units: metres, seconds, radians, photometric light units (lm, cd, lx, cd/m^2). Colours are
//   linear Rec.709. Matrices are column-major (element [column*4 + row]), vectors are columns.
//   Modules: a module is a CndLighting together with its views, a CndEnvironment or a CndExposure.
//   Ownership: a module borrows every Vulkan handle it is given and owns only what it created. It
//   never creates a device or a queue, never submits and never waits. Recording allocates nothing.
//   Threads: different modules may be used from different threads at the same time. Calls on one
//   module must not overlap, so two views of one CndLighting must not be recorded at the same time.
//   The one exception is cndAddLightingPipelines, which may run beside other calls on its module.
//   Errors: every function that can fail returns a CndResult. If it has an `error` parameter that
//   is not NULL, it also writes there one sentence that says what is wrong. No exception crosses
//   the ABI.
//   Versioning: every `structSize` member must be set to the size of its struct; any other value is
//   an error.
#ifndef CANDELABRA_CANDELABRA_H
#define CANDELABRA_CANDELABRA_H

#include "candelabra/core.h"
#include "candelabra/environment.h"
#include "candelabra/exposure.h"
#include "candelabra/lighting.h"
#include "candelabra/lights.h"
#include "candelabra/occluders.h"

#endif
