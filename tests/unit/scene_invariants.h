// SPDX-License-Identifier: Apache-2.0
// Invariants that every loaded scene must satisfy, so that the code after the loader need not check
// them.
#pragma once

#include <string>

#include "scene/scene.h"

namespace candelabra::test
{

// Returns one sentence naming the first violation; empty if there is none.
std::string brokenInvariant(const app::Scene& scene);

} // namespace candelabra::test
