// SPDX-License-Identifier: Apache-2.0
// The methods that the benchmarks compare: the engine's specular methods, and a competing method
// that only the benchmarks have.
#pragma once

#include <string>
#include <vector>

#include "candelabra/lighting.h"

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

} // namespace candelabra::app
