// SPDX-License-Identifier: Apache-2.0
#include "measure/kernels/light_kernels.h"

#include <algorithm>
#include <cstring>
#include <iterator>
#include <limits>

#include "candelabra_bench_shaders.h"
#include "lights/pack_lights.h"
#include "render/setting_names.h"
#include "shading/light_family.h"
#include "shared/ltc.h"

namespace candelabra::app
{
namespace
{

template <typename T>
gpu::Buffer upload(const gpu::Device& device, const std::string& name, std::span<const T> data)
{
    gpu::Buffer buffer = gpu::createBuffer(device, name, data.size_bytes(),
                                           VK_BUFFER_USAGE_STORAGE_BUFFER_BIT |
                                               VK_BUFFER_USAGE_UNIFORM_TEXEL_BUFFER_BIT,
                                           gpu::MemoryUse::Upload);
    if (!data.empty())
        std::memcpy(buffer.mapped, data.data(), data.size_bytes());
    return buffer;
}

// Adds the corners of polygon i to the shapes, as prepare_lights.comp does with an identity view.
void addCorners(std::vector<gpu::LightShape>& shapes, size_t i, const CndLight& light)
{
    const glm::vec3 u = shapes[i].axisU, v = shapes[i].axisV;
    const gpu::PolygonRecord record = lighting::packPolygon(light, 0);
    shapes[i].radius = float(record.count);
    shapes[i].flags = (shapes[i].flags & gpu::LIGHT_TWO_SIDED) | uint32_t(shapes.size());
    const auto at = [&](uint32_t k) { return record.corners[k].x * u + record.corners[k].y * v; };
    for (uint32_t k = 0; k < gpu::MAX_RECORD_CORNERS; k += 2)
        shapes.push_back({.axisU = at(k), .radius = 0, .axisV = at(k + 1), .flags = 0});
}

// Lights that one dispatch takes: their storage buffers stay far below any device's limit.
constexpr size_t maxBatch = size_t(1) << 18;

} // namespace

std::string methodName(const MeasuredMethod& method)
{
    return method.rival == Rival::Ltc ? "ltc" : specularName(method.specular);
}

std::vector<CndSpecularMethod> methodsOf(uint32_t lightType)
{
    std::vector<CndSpecularMethod> out;
    for (const Choice<CndSpecularMethod>& choice : specularChoices)
        if (choice.value != CND_SPECULAR_NONE &&
            lighting::canonicalMethod(lightType, choice.value) == choice.value)
            out.push_back(choice.value);
    return out;
}

bool rivalKnows(uint32_t lightType)
{
    return lighting::isSphere(lightType) || lightType == CND_LIGHT_RECTANGLE ||
           lightType == CND_LIGHT_POLYGON;
}

std::vector<MeasuredMethod> comparedMethods(uint32_t lightType)
{
    std::vector<MeasuredMethod> out;
    for (const CndSpecularMethod method : methodsOf(lightType))
        out.push_back(method);
    if (rivalKnows(lightType))
        out.push_back(Rival::Ltc);
    return out;
}

const gpu::Spirv& ofFamily(std::span<const gpu::Spirv* const> families,
                           const Evaluation& evaluation)
{
    return *families[lighting::familyOf(evaluation.lightType, evaluation.method.specular)];
}

PreparedLights prepareLights(std::span<const CndLight> lights)
{
    lighting::validateLights("light kernels", lights);
    std::vector<gpu::LightRecord> records(lights.size());
    lighting::packLights(lights, records);
    PreparedLights out;
    for (const gpu::LightRecord& r : records) { // prepare_lights.comp with an identity view
        out.core.emplace_back(r.position, r.boundingRadius);
        out.core.emplace_back(r.emission, r.influenceRadius * r.influenceRadius);
        out.shapes.push_back(lighting::shapeOf(r));
    }
    for (size_t i = 0; i < lights.size(); ++i)
        if (lights[i].type == CND_LIGHT_POLYGON)
            addCorners(out.shapes, i, lights[i]);
    return out;
}

DeviceLights uploadLights(const gpu::Device& device, std::span<const CndLight> lights)
{
    const PreparedLights prepared = prepareLights(lights);
    DeviceLights out{.core = upload(device, "bench lights", std::span(prepared.core)),
                     .shapes = upload(device, "bench light shapes", std::span(prepared.shapes)),
                     .count = uint32_t(lights.size())};
    gpu::createTexelView(device, out.core);
    return out;
}

gpu::Buffer uploadReceivers(const gpu::Device& device,
                            std::span<const gpu::BenchReceiver> receivers)
{
    return upload(device, "bench receivers", receivers);
}

gpu::Buffer uploadLtcTable(const gpu::Device& device)
{
    constexpr size_t rowSize = 5;
    static constexpr double numbers[] = {
    // shared/ltc.h describes what they become
#include "measure/kernels/ltc_table.inc"
    };
    static_assert(std::size(numbers) == rowSize * gpu::LTC_TABLE_SIZE * gpu::LTC_TABLE_SIZE);
    std::vector<glm::vec4> texels;
    for (size_t i = 0; i < std::size(numbers); i += rowSize) {
        texels.emplace_back(numbers[i], numbers[i + 1], numbers[i + 2], numbers[i + 3]);
        texels.emplace_back(numbers[i + 4], 0, 0, 0);
    }
    gpu::Buffer out = upload(device, "transformed cosines", std::span<const glm::vec4>(texels));
    gpu::createTexelView(device, out);
    return out;
}

void shaderToHostBarrier(const gpu::Device& device, VkCommandBuffer cmd)
{
    const VkMemoryBarrier2 barrier{.sType = VK_STRUCTURE_TYPE_MEMORY_BARRIER_2,
                                   .srcStageMask = VK_PIPELINE_STAGE_2_COMPUTE_SHADER_BIT,
                                   .srcAccessMask = VK_ACCESS_2_SHADER_STORAGE_WRITE_BIT,
                                   .dstStageMask = VK_PIPELINE_STAGE_2_HOST_BIT,
                                   .dstAccessMask = VK_ACCESS_2_HOST_READ_BIT};
    const VkDependencyInfo info{.sType = VK_STRUCTURE_TYPE_DEPENDENCY_INFO,
                                .memoryBarrierCount = 1,
                                .pMemoryBarriers = &barrier};
    device.CmdPipelineBarrier2(cmd, &info);
}

void writeBindings(const gpu::Bindings& bindings, const DeviceLights& lights,
                   const gpu::Buffer& receivers, const gpu::Buffer& output,
                   const gpu::Buffer* ltcTable)
{
    using gpu::Binding;
    std::vector<Binding> more;
    if (ltcTable)
        more.push_back(Binding::ofTexels(gpu::BENCH_LTC, *ltcTable));
    bindings.write(
        0,
        {Binding::ofTexels(gpu::LIGHT_CORE_TEXELS, lights.core),
         Binding::of(gpu::LIGHT_CORE, lights.core), Binding::of(gpu::BENCH_SHAPES, lights.shapes),
         Binding::of(gpu::BENCH_INPUT, receivers), Binding::of(gpu::BENCH_OUTPUT, output)},
        more);
}

LightEvaluator::LightEvaluator(const VulkanContext& context, const Evaluation& evaluation)
    : context_(context),
      evaluation_(evaluation),
      isRival_(evaluation.method.rival != Rival::None),
      kernel_(context.device(),
              isRival_ ? spirv::evaluate_lights_comp_ltc
                       : ofFamily(spirv::evaluate_lights_comp, evaluation),
              {{gpu::SPEC_FOR_CPU, 0},
               {gpu::SPEC_SPECULAR_METHOD, evaluation.method.specular},
               {gpu::SPEC_LIGHT_TYPE, evaluation.lightType}}),
      bindings_(kernel_.createBindings(1)),
      ltcTable_(uploadLtcTable(context.device()))
{
}

std::vector<gpu::BenchResponse>
LightEvaluator::evaluateBatch(std::span<const gpu::BenchReceiver> receivers,
                              std::vector<CndLight> lights) const
{
    for (CndLight& light : lights) {
        light.influenceRadius = std::numeric_limits<float>::infinity();
        std::ranges::fill(light.emission, 1.0f);
    }
    const gpu::Device& device = context_.device();
    const DeviceLights onDevice = uploadLights(device, lights);
    const gpu::Buffer in = uploadReceivers(device, receivers);
    const gpu::Buffer result =
        gpu::createBuffer(device, "bench responses", receivers.size() * sizeof(gpu::BenchResponse),
                          VK_BUFFER_USAGE_STORAGE_BUFFER_BIT, gpu::MemoryUse::Readback);
    writeBindings(bindings_, onDevice, in, result, isRival_ ? &ltcTable_ : nullptr);
    const gpu::BenchParams params{.count = uint32_t(receivers.size()),
                                  .sampleCount = evaluation_.sampleCount};
    gpu::Timer timer(device, "bench", 1, false);
    context_.submitAndWait([&](VkCommandBuffer cmd) {
        timer.begin(cmd, 0);
        kernel_.dispatch(gpu::Frame{device, cmd, timer, 0}, bindings_.set(0), params,
                         gpu::divideUp(params.count, gpu::BENCH_GROUP));
        shaderToHostBarrier(device, cmd);
    });
    const auto values = result.as<gpu::BenchResponse>();
    return {values.begin(), values.begin() + ptrdiff_t(receivers.size())};
}

std::vector<gpu::BenchResponse>
LightEvaluator::evaluate(std::span<const gpu::BenchReceiver> receivers,
                         std::span<const CndLight> lights) const
{
    std::vector<gpu::BenchResponse> out;
    for (size_t first = 0; first < receivers.size(); first += maxBatch) {
        const size_t count = std::min(maxBatch, receivers.size() - first);
        const auto batch = lights.subspan(first, count);
        const auto responses =
            evaluateBatch(receivers.subspan(first, count), {batch.begin(), batch.end()});
        out.insert(out.end(), responses.begin(), responses.end());
    }
    return out;
}

} // namespace candelabra::app
