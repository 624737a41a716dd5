// SPDX-License-Identifier: Apache-2.0
// Records of lights that the host has edited, on their way from staging memory to their places.
#ifndef CND_SHARED_LIGHT_EDITS_H
#define CND_SHARED_LIGHT_EDITS_H

#include "shared/prelude.h"

GPU_BEGIN

// --- light_edits: copies records to where they belong, LIGHT_EDITS_LANES lanes per record
const uint LIGHT_EDITS_GROUP = 64u;
const uint LIGHT_EDITS_LANES = 4u; // each copies 16 bytes, so that a group reads one long stretch
const uint LIGHT_EDITS_STAGED = 0u;
const uint LIGHT_EDITS_PLACES = 1u; // for each staged record: the index of the host's record
const uint LIGHT_EDITS_RECORDS = 2u;
struct LightEditsParams {
    uint count;       // of staged records
    uint firstRecord; // index of the host's first record
};
GPU_SIZE(LightEditsParams, 8)

GPU_END

#endif
