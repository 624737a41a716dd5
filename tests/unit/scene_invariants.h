// SPDX-License-Identifier: Apache-2.0
// What every loaded scene must satisfy, so that nothing behind the loader has to check again.
#pragma once

#include <string>

#include "scene/scene.h"

namespace candelabra::test
{

// Empty, or one sentence naming the first thing that is wrong.
std::string brokenInvariant(const app::Scene& scene);

} // namespace candelabra::test
