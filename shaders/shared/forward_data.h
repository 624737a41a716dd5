// SPDX-License-Identifier: Apache-2.0
// The descriptor set through which shaders of a host read the lights of a view (lib/forward.glsl).
#ifndef CND_SHARED_FORWARD_DATA_H
#define CND_SHARED_FORWARD_DATA_H

#include "shared/cluster_data.h"

GPU_BEGIN

const uint FORWARD_VIEW = 0u;
const uint FORWARD_CORE = 1u; // lights (shared/lighting_data.h)
const uint FORWARD_SHAPES = 2u;
const uint FORWARD_NODES = 3u; // nodes of the light trees (shared/cluster_data.h)
const uint FORWARD_DFG = 4u;   // texel buffer (shared/dfg.h)
const uint FORWARD_IDS = 5u;   // ids of the lights

struct ForwardView {
    Projection projection;
    uint lobes;                        // as FrameParams::lobes
    TreeShape trees[LIGHT_TYPE_COUNT]; // by light type; distant types have lights but no nodes
};
GPU_SIZE(ForwardView, 60 + 12 * LIGHT_TYPE_COUNT)

GPU_END

#endif
