// SPDX-License-Identifier: Apache-2.0
// The layout of the G-buffer, which may be one of the host (CndGBufferDesc), as the bit fields of
// one specialisation constant, and the bindings of its images.
#ifndef CND_SHARED_HOST_GBUFFER_DATA_H
#define CND_SHARED_HOST_GBUFFER_DATA_H

#include "shared/gbuffer_data.h"

GPU_BEGIN

const uint GBUFFER_LAYOUT_MASK = 3u; // CndGBufferLayout
// The fields from here to GBUFFER_F90_SHIFT describe GBUFFER_LAYOUT_HOST.
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
// The content of the depth image, in every layout.
const uint GBUFFER_DEPTH_KIND_SHIFT = 20u;
const uint GBUFFER_DEPTH_KIND_MASK = 3u; // CndDepthKind
const uint DEPTH_PROJECTED = 0u;
const uint DEPTH_LINEAR = 1u;
const uint DEPTH_POSITION_VIEW = 2u;
const uint DEPTH_POSITION_WORLD = 3u;

// The values that turn a texel of a depth image without projected depth into the z of view space.
struct StoredDepth {
    vec4 z;      // z = dot(z, vec4(stored position, 1)); z.x is the factor of a linear depth
    float clear; // value where there is no surface: of the linear depth, or of the position's alpha
};
GPU_SIZE(StoredDepth, 20)

// Specialisation constant: the layout of the G-buffer.
const uint SPEC_GBUFFER = 3u;

// Bindings of the images in all kernels that read them. What a layout stores as packed integers and
// what it stores as floats are different images to a shader.
const uint GBUFFER_PACKED_NORMAL = 16u;   // FULL, COMPACT
const uint GBUFFER_PACKED_ALBEDO = 17u;   // FULL
const uint GBUFFER_PACKED_SPECULAR = 18u; // FULL
const uint GBUFFER_NORMAL = 19u;          // HOST
const uint GBUFFER_ALBEDO = 20u;          // HOST, COMPACT
const uint GBUFFER_SPECULAR = 21u;        // HOST

GPU_END

#endif
