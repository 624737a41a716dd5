// SPDX-License-Identifier: Apache-2.0
// Devices that end loops after some iterations get long lists of lights in batches, one dispatch
// each.
#pragma once

#include <algorithm>

#include "candelabra/candelabra.h"
#include "gpu/device.h"
#include "shared/lighting.h"

namespace candelabra::lighting
{

// Lights of a list that a shader invocation can evaluate: UINT32_MAX where the device does not
// limit loops. `loopIterations`: those inside the evaluation of one light.
uint32_t lightsPerBatch(const gpu::Device& device, uint32_t loopIterations);
// The same for lights of a type. `sampleCount`: of CND_SPECULAR_SAMPLED.
uint32_t lightsPerBatch(const gpu::Device& device, uint32_t lightType, CndSpecularMethod method,
                        uint32_t sampleCount);

// Calls `record` with `params` for one batch of consecutive lights after another, until all lights
// of `params` have had their turn. `largest`: lights of a batch, at most.
template <typename Record>
void inBatches(gpu::ShadeParams params, uint32_t largest, Record&& record) noexcept
{
    const uint32_t end = params.firstLight + params.lightCount;
    for (; params.firstLight < end; params.firstLight += params.lightCount) {
        params.lightCount = std::min(largest, end - params.firstLight);
        record(params);
    }
}

} // namespace candelabra::lighting
