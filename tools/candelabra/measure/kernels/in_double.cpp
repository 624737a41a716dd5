// SPDX-License-Identifier: Apache-2.0
#include "measure/kernels/in_double.h"

#include "measure/kernels/parallel.h"

namespace candelabra::app
{

formula::Receiver receiverInDouble(const gpu::BenchReceiver& receiver)
{
    return {.n = glm::dvec3(receiver.n),
            .v = glm::dvec3(receiver.v),
            .perceptualRoughness = receiver.perceptualRoughness};
}

formula::Light lightInDouble(uint32_t type, const PreparedLights& lights, uint32_t index)
{
    const glm::vec4 core = lights.core[gpu::LIGHT_CORE_STRIDE * index];
    formula::Light out{.type = type,
                       .centre = glm::dvec3(core),
                       .boundingRadius = core.w,
                       .shape = lights.shapes[index],
                       .index = index};
    if (type == CND_LIGHT_POLYGON)
        out.corners = std::span(lights.shapes)
                          .subspan(out.shape.flags & ~gpu::LIGHT_TWO_SIDED, gpu::CORNER_SHAPES);
    return out;
}

std::vector<formula::Response> respondInDouble(const Evaluation& evaluation,
                                               std::span<const gpu::BenchReceiver> receivers,
                                               std::span<const CndLight> lights)
{
    const PreparedLights prepared = prepareLights(lights);
    const formula::Settings settings{.method = evaluation.method.specular,
                                     .sampleCount = evaluation.sampleCount,
                                     .constants = {}};
    std::vector<formula::Response> out(receivers.size());
    parallelFor(
        out.size(),
        [&](size_t i) {
            out[i] = formula::respond(settings, receiverInDouble(receivers[i]),
                                      lightInDouble(evaluation.lightType, prepared, uint32_t(i)));
        },
        [](size_t) {});
    return out;
}

} // namespace candelabra::app
