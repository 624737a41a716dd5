// SPDX-License-Identifier: Apache-2.0
#include "shading/light_batches.h"

#include "lights/light_types.h"
#include "shared/clusters.h"

namespace candelabra::lighting
{
namespace
{

// Loop iterations inside the evaluation of one light, at most: the outline of a tube has 16 edges
// and is walked for the diffuse lobe and two specular ones; discs have a series of 9 terms.
uint32_t loopIterations(uint32_t lightType, CndSpecularMethod method, uint32_t sampleCount)
{
    const uint32_t shape = lightType == CND_LIGHT_TUBE ? 64 : isSphere(lightType) ? 0 : 24;
    return shape + (method == CND_SPECULAR_SAMPLED ? sampleCount : 0);
}

} // namespace

// Shading a list takes at most this many loop iterations per light: a test, a turn in each of four
// classes (the lanes of a vector may differ), and per block of 63 the exits of its loops.
uint32_t lightsPerBatch(const gpu::Device& device, uint32_t loopIterations)
{
    if (device.maxLoopIterations == UINT32_MAX)
        return UINT32_MAX;
    constexpr uint32_t fixedIterations = 1024; // before and after the walk
    const uint64_t per32 = 32 * (5 + uint64_t(loopIterations)) + 8;
    const uint64_t lights = uint64_t(device.maxLoopIterations - fixedIterations) * 32 / per32;
    return uint32_t(std::max<uint64_t>(lights, gpu::TREE_WIDTH));
}

uint32_t lightsPerBatch(const gpu::Device& device, uint32_t lightType, CndSpecularMethod method,
                        uint32_t sampleCount)
{
    return lightsPerBatch(device, loopIterations(lightType, method, sampleCount));
}

} // namespace candelabra::lighting
