// SPDX-License-Identifier: Apache-2.0
// The parameters of a frame, which every kernel that reads surfaces shares: its image, its camera
// and the settings of its shading. They are in a uniform buffer, so that the push constants of
// these kernels hold only what differs from dispatch to dispatch.
#ifndef CND_SHARED_FRAME_H
#define CND_SHARED_FRAME_H

#include "shared/prelude.h"

GPU_BEGIN

// The elements of clipFromView (m<column><row>) that are not 0 in perspective and orthographic
// projections. They suffice to compute view-space positions from pixels and depths.
struct Projection {
    float m00, m11, m20, m21, m30, m31, m22, m32, m23, m33;
    vec3 eye;         // perspective: position of the eye, 0; orthographic: direction to the eye
    float eyeIsPoint; // 1: perspective; 0: orthographic
};
GPU_SIZE(Projection, 56)

// Bindings that are the same in all kernels of the lighting and the environment module that have
// them.
const uint RADIANCE_IMAGE = 7u; // the scene radiance
const uint FRAME_PARAMS = 23u;

const uint COMPENSATE_ENERGY = 256u; // bit of FrameParams::lobes

struct FrameParams {
    mat3 viewFromWorld; // rotation
    Projection projection;
    uvec2 size;         // size of the frame in pixels
    vec2 invImageSize;  // 1 / size; divided on the CPU, because kernels may differ in the last bit
                        //   of a division
    float clearDepth;   // depth of pixels without a surface
    float dielectricF0; // F0 of non-metals, for layouts of the G-buffer that do not store F0
    uint lobes;         // LOBES_* (shared/dfg.h), plus COMPENSATE_ENERGY
    // Only the lighting module sets these. In frames of the environment module they are 0.
    uint sampleCount; // SPECULAR_SAMPLED: samples per light
    uint sampleSeed;
    float largestRadiance; // the largest value that the scene radiance image can hold
    // Where a layout of the host has no such channel.
    float constantRoughness; // perceptual
    float constantMetalness;
    // The frame is a rectangle inside the host's images, which begins at this texel.
    uvec2 firstTexel;
    uvec2 firstDepthTexel; // the same for the depth image; 0 if project_depth has written it
};
GPU_SIZE(FrameParams, 156)

GPU_END

#endif
