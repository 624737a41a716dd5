// SPDX-License-Identifier: Apache-2.0
#include "shading/light_batches.h"

#include "shading/light_family.h"
#include "shared/cluster_data.h"

namespace candelabra::lighting
{
namespace
{

// Returns an upper bound of the loop iterations inside the evaluation of one light.
uint32_t loopIterations(uint32_t lightType, CndSpecularMethod method, uint32_t sampleCount)
{
#define X(index, NAME, iterations) iterations,
    static constexpr uint32_t iterationsOfFamilies[] = {CND_LIGHT_FAMILIES(X)};
#undef X
    // Each sample of a polygon looks for its triangle.
    const uint32_t perSample = hasField(lightType, gpu::LIGHT_HAS_CORNERS) ? gpu::MAX_CORNERS : 1;
    return iterationsOfFamilies[familyOf(lightType, method)] +
           (method == CND_SPECULAR_SAMPLED ? perSample * sampleCount : 0);
}

} // namespace

// Shading a list takes at most 5 loop iterations per light outside of its evaluation: one
// for the test, and one in each of the four loops that evaluate (the invocations that run together
// may each need another loop). The exits of the loops of a block take up to 8 per 32 lights.
uint32_t lightsPerBatch(const gpu::Device& device, uint32_t loopIterations)
{
    if (device.maxLoopIterations == UINT32_MAX)
        return UINT32_MAX;
    constexpr uint32_t fixedIterations = 1024; // of loops before and after the walk
    const uint64_t per32 = 32 * (5 + uint64_t(loopIterations)) + 8;
    const uint64_t lights = uint64_t(device.maxLoopIterations - fixedIterations) * 32 / per32;
    return uint32_t(std::max<uint64_t>(lights, gpu::TREE_WIDTH));
}

uint32_t walkTurns(const gpu::Device& device)
{
    constexpr uint32_t others = 8192; // from one leaf to the next, and of loops beside the walk
    return device.maxLoopIterations == UINT32_MAX ? 0 : device.maxLoopIterations - others;
}

uint32_t lightsPerBatch(const gpu::Device& device, uint32_t lightType, CndSpecularMethod method,
                        uint32_t sampleCount)
{
    return lightsPerBatch(device, loopIterations(lightType, method, sampleCount));
}

} // namespace candelabra::lighting
