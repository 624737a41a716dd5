// SPDX-License-Identifier: Apache-2.0
// What every kernel that reads surfaces knows about the frame: its image, its camera and the
// settings of its shading. It lies in a uniform buffer, so that the push constants of these kernels
// hold only what differs from dispatch to dispatch.
#ifndef CND_SHARED_FRAME_H
#define CND_SHARED_FRAME_H

#include "shared/prelude.h"

GPU_BEGIN

// Non-zero elements of clipFromView (m<column><row>), enough for perspective and orthographic, and
// the way back from pixel and depth to view space.
struct Projection {
    float m00, m11, m20, m21, m30, m31, m22, m32, m23, m33;
    vec3 eye;         // position of the eye (perspective: 0) or direction towards it (orthographic)
    float eyeIsPoint; // 1 perspective, 0 orthographic
};
GPU_SIZE(Projection, 56)

const uint COMPENSATE_ENERGY = 256u; // bit of FrameParams::lobes

struct FrameParams {
    mat3 viewFromWorld; // rotation
    Projection projection;
    uvec2 size;         // of the image, in pixels
    vec2 invImageSize;  // 1 / size; the host divides, since divisions on the GPU may differ between
                        //   kernels in the last bit
    float clearDepth;   // depth of pixels without a surface
    float dielectricF0; // F0 of non-metals, for layouts of the G-buffer that do not store F0
    uint lobes;         // LOBES_* (shared/dfg.h), plus COMPENSATE_ENERGY
    // The lighting module alone sets these; in frames of the environment module they are 0:
    float errorBudget; // relative to the highest response; 0: every light in full
    uint sampleCount;  // SPECULAR_SAMPLED: samples per light
    uint sampleSeed;
};
GPU_SIZE(FrameParams, 132)

GPU_END

#endif
