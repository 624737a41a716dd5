// SPDX-License-Identifier: Apache-2.0
// The specialisation constant that says what the images of the G-buffer hold
// (shared/host_gbuffer_data.h).
// The includer defines GBUFFER_CODE, its id.
#ifndef CND_COMMON_GBUFFER_CODE
#define CND_COMMON_GBUFFER_CODE

layout(constant_id = GBUFFER_CODE) const uint gbufferCode = 0u;

#endif
