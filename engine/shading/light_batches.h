// SPDX-License-Identifier: Apache-2.0
// Some devices end loops after a number of iterations. On these, lights are shaded in batches, with
// one dispatch each.
#pragma once

#include <algorithm>

#include "candelabra/candelabra.h"
#include "gpu/device.h"
#include "shared/cluster_data.h"

namespace candelabra::lighting
{

// Returns how many lights one shader invocation can evaluate: UINT32_MAX if the device does not
// limit loops. `loopIterations`: loop iterations inside the evaluation of one light.
uint32_t lightsPerBatch(const gpu::Device& device, uint32_t loopIterations);
// Returns the same for lights of a type. `sampleCount`: samples per light of CND_SPECULAR_SAMPLED.
uint32_t lightsPerBatch(const gpu::Device& device, uint32_t lightType, CndSpecularMethod method,
                        uint32_t sampleCount);

// Returns how many turns of loops walks through occluders may take in one invocation
// (SPEC_WALK_TURNS), which leaves some for other loops; 0: as many as they like.
uint32_t walkTurns(const gpu::Device& device);
// How many lights of a tree a dispatch takes on devices that limit loops if each pixel walks
// through the occluders of each light. Most walks take some hundred turns.
constexpr uint32_t walkedLightsPerBatch = gpu::TREE_WIDTH * gpu::TREE_WIDTH;

// Splits `lights` into consecutive batches of at most `largest` lights and calls `record` with
// each.
template <typename Record>
void inBatches(gpu::LightBatch lights, uint32_t largest, Record&& record) noexcept
{
    const uint32_t end = lights.first + lights.count;
    for (gpu::LightBatch batch{lights.first, 0}; batch.first < end; batch.first += batch.count) {
        batch.count = std::min(largest, end - batch.first);
        record(batch);
    }
}

} // namespace candelabra::lighting
