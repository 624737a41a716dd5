// SPDX-License-Identifier: Apache-2.0
// The inputs of LightEvaluator for the same formulas in double precision (tools/formula).
#pragma once

#include <span>
#include <vector>

#include "formula/formula.h"
#include "measure/kernels/light_kernels.h"

namespace candelabra::app
{

formula::Receiver receiverInDouble(const gpu::BenchReceiver& receiver);
// Light `index` of lights of one type; refers to `lights`.
formula::Light lightInDouble(uint32_t type, const PreparedLights& lights, uint32_t index);

// Returns the result of LightEvaluator::evaluate without rounding. The method is one of the
// engine's. Uses every core.
std::vector<formula::Response> respondInDouble(const Evaluation& evaluation,
                                               std::span<const gpu::BenchReceiver> receivers,
                                               std::span<const CndLight> lights);

} // namespace candelabra::app
