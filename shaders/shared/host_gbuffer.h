// SPDX-License-Identifier: Apache-2.0
// The layout of the G-buffer, which may be one of the host (CndGBufferDesc), as the bit fields of
// one specialisation constant, and the bindings of its images.
#ifndef CND_SHARED_HOST_GBUFFER_H
#define CND_SHARED_HOST_GBUFFER_H

#include "shared/gbuffer.h"

GPU_BEGIN

const uint GBUFFER_LAYOUT_MASK =
    3u; // CndGBufferLayout; the other fields describe GBUFFER_LAYOUT_HOST
const uint GBUFFER_NORMAL_SHIFT = 2u;
const uint GBUFFER_NORMAL_MASK = 3u; // CndNormalEncoding
const uint GBUFFER_NORMAL_UNORM = 0u;
const uint GBUFFER_NORMAL_SNORM = 1u;
const uint GBUFFER_NORMAL_OCTAHEDRAL_UNORM = 2u;
const uint GBUFFER_NORMAL_OCTAHEDRAL_SNORM = 3u;
const uint GBUFFER_WORLD_SHIFT = 4u; // 1 bit: normals are in world space
const uint GBUFFER_ROUGHNESS_KIND_SHIFT = 5u;
const uint GBUFFER_ROUGHNESS_KIND_MASK = 3u; // CndRoughnessKind
const uint GBUFFER_ROUGHNESS_ALPHA = 1u;
const uint GBUFFER_ROUGHNESS_SMOOTHNESS = 2u;
const uint GBUFFER_SPECULAR_COLOUR_SHIFT = 7u; // 1 bit: CND_REFLECTANCE_SPECULAR
const uint GBUFFER_CHANNEL_MASK = 15u;         // CndGBufferChannel
const uint GBUFFER_ROUGHNESS_SHIFT = 8u;
const uint GBUFFER_METALNESS_SHIFT = 12u;
const uint GBUFFER_F90_SHIFT = 16u;

// The images, as a kernel binds them: their binding numbers relative to that of the first. What a
// layout stores as packed integers and what it stores as floats are different images to a shader.
const uint GBUFFER_PACKED_NORMAL = 0u;   // FULL, COMPACT
const uint GBUFFER_PACKED_ALBEDO = 1u;   // FULL
const uint GBUFFER_PACKED_SPECULAR = 2u; // FULL
const uint GBUFFER_NORMAL = 3u;          // HOST
const uint GBUFFER_ALBEDO = 4u;          // HOST, COMPACT
const uint GBUFFER_SPECULAR = 5u;        // HOST

GPU_END

#endif
