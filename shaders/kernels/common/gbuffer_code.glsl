// SPDX-License-Identifier: Apache-2.0
// The specialisation constant that says what the images of the G-buffer hold
// (shared/host_gbuffer_data.h).
#ifndef CND_COMMON_GBUFFER_CODE
#define CND_COMMON_GBUFFER_CODE

#include "shared/host_gbuffer_data.h"

layout(constant_id = SPEC_GBUFFER) const uint gbufferCode = 0u;

#endif
