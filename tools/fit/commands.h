// SPDX-License-Identifier: Apache-2.0
// The fit of candelabra_fit. It prints what it finds, and throws app::RunError or app::UsageError
// (io/error.h).
#pragma once

#include <cstdint>
#include <string>

#include "fit/conic_objective.h"

namespace candelabra::fit
{

struct ConicSettings {
    TrainingSize training;
    // Number of groups that nothing is fitted to; errors are given for them.
    uint32_t heldOut = 5000;
    // Largest number of evaluations of the objective per search; 0: no search.
    uint32_t evaluations = 4000;
    // The second search starts from bad constants: the committed ones times exp(perturbation u),
    // with a random u from -1 to 1 for each. 0: no second search.
    double perturbation = 0.7;
    // File that the record is written to; empty: no record.
    std::string json;
};
// Searches for the constants of the closed form of spheres from the committed constants and from
// bad ones. Writes the record and no other file.
void runConic(const ConicSettings& settings, const std::string& commandLine);

} // namespace candelabra::fit
