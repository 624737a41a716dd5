// SPDX-License-Identifier: Apache-2.0
// The methods that the benchmarks compare: the engine's specular methods, and rivals that only the
// benchmarks have.
#pragma once

#include <string>
#include <vector>

#include "candelabra/lighting.h"

namespace candelabra::app
{

// Linearly transformed cosines (shaders/bench/ltc). `Ltc` has one lobe for spheres and two for the
// other area lights. `LtcOneLobe` has one for these too, as the method was published.
enum class Rival : uint32_t { None, Ltc, LtcOneLobe };

// A specular method of the engine, or a rival.
struct MeasuredMethod {
    MeasuredMethod(CndSpecularMethod method) : specular(method) {}
    MeasuredMethod(Rival which) : specular(CND_SPECULAR_KARIS), rival(which) {}
    friend bool operator==(const MeasuredMethod&, const MeasuredMethod&) = default;

    CndSpecularMethod specular; // with a rival: of lights that it does not know
    Rival rival = Rival::None;
};

std::string methodName(const MeasuredMethod& method);

// Returns the engine's methods that differ from each other for a type, in the order of the list;
// NONE is not among them.
std::vector<CndSpecularMethod> methodsOf(uint32_t lightType);
// Returns these methods and the rivals that know the type.
std::vector<MeasuredMethod> comparedMethods(uint32_t lightType);

} // namespace candelabra::app
