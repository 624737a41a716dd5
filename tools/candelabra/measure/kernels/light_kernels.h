// SPDX-License-Identifier: Apache-2.0
// The shipping shader evaluation of lights on explicit receivers and lights, without G-buffer and
// lists: what the benchmarks of accuracy and stability measure.
#pragma once

#include <span>
#include <string>
#include <vector>

#include "candelabra/candelabra.h"
#include "gpu/kernel.h"
#include "render/vulkan_context.h"
#include "scene/light_types.h"
#include "shared/bench.h"

namespace candelabra::app
{

// Linearly transformed cosines (shaders/bench/ltc).
enum class Rival : uint32_t { None, Ltc };

// A specular method of the engine, or a competing one.
struct MeasuredMethod {
    MeasuredMethod(CndSpecularMethod method) : specular(method) {}
    MeasuredMethod(Rival which) : specular(CND_SPECULAR_KARIS), rival(which) {}
    friend bool operator==(const MeasuredMethod&, const MeasuredMethod&) = default;

    CndSpecularMethod specular; // with a competing method: for lights that it cannot evaluate
    Rival rival = Rival::None;
};

std::string methodName(const MeasuredMethod& method);

// Returns the engine's methods that differ from each other for a type, in the order of the list;
// NONE is not among them.
std::vector<CndSpecularMethod> methodsOf(uint32_t lightType);
// Tells whether linearly transformed cosines evaluate lights of a type.
bool rivalKnows(uint32_t lightType);
// Returns the engine's methods for a type, and the competing one if it can evaluate the type.
std::vector<MeasuredMethod> comparedMethods(uint32_t lightType);

// One light type under one specular method: a specialisation of the kernels.
struct Evaluation {
    uint32_t lightType = CND_LIGHT_SPHERE;
    MeasuredMethod method = CND_SPECULAR_CONIC;
    uint32_t sampleCount = 1024; // CND_SPECULAR_SAMPLED
};

// The module of a bench kernel, such as spirv::time_lights_comp, that evaluates a type by a method
// of the engine.
const gpu::Spirv& ofFamily(std::span<const gpu::Spirv* const> families,
                           const Evaluation& evaluation);

// Lights of one type as kernels read them, relative to receivers at the origin.
struct PreparedLights {
    std::vector<glm::vec4> core;
    std::vector<gpu::LightShape> shapes;
};
// Throws gpu::Failure for a light outside its documented range.
PreparedLights prepareLights(std::span<const CndLight> lights);

// The same in device memory.
struct DeviceLights {
    gpu::Buffer core, shapes;
    uint32_t count = 0;
};
DeviceLights uploadLights(const gpu::Device& device, std::span<const CndLight> lights);
gpu::Buffer uploadReceivers(const gpu::Device& device,
                            std::span<const gpu::BenchReceiver> receivers);

// Evaluates explicit lights; holds the pipeline.
class LightEvaluator
{
public:
    LightEvaluator(const VulkanContext& context, const Evaluation& evaluation);

    // Response of receiver i to light i, whatever the light's emission and influence. All lights
    // are of the evaluation's type.
    std::vector<gpu::BenchResponse> evaluate(std::span<const gpu::BenchReceiver> receivers,
                                             std::span<const CndLight> lights) const;

private:
    std::vector<gpu::BenchResponse> evaluateBatch(std::span<const gpu::BenchReceiver> receivers,
                                                  std::vector<CndLight> lights) const;

    const VulkanContext& context_;
    Evaluation evaluation_;
    bool isRival_;
    gpu::Kernel<gpu::BenchParams> kernel_;
    gpu::Bindings bindings_;
    gpu::Buffer ltcTable_; // read by linearly transformed cosines
};

// The table of shared/ltc.h, for BENCH_LTC.
gpu::Buffer uploadLtcTable(const gpu::Device& device);

// Makes what kernels wrote visible to the host once it has waited.
void shaderToHostBarrier(const gpu::Device& device, VkCommandBuffer cmd);

// Writes the bindings that every kernel with bench/bench_lights.glsl has. `ltcTable`: for rivals,
// which have one more binding; else null.
void writeBindings(const gpu::Bindings& bindings, const DeviceLights& lights,
                   const gpu::Buffer& receivers, const gpu::Buffer& output,
                   const gpu::Buffer* ltcTable);

} // namespace candelabra::app
