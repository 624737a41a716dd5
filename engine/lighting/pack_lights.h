// SPDX-License-Identifier: Apache-2.0
// CndLight -> gpu::LightRecord: the one place where physical units become shader values.
#pragma once

#include <span>

#include "candelabra/candelabra.h"
#include "shared/lighting.h"

namespace candelabra::lighting
{

// Throws gpu::Failure naming the first light and field outside its documented range. Returns
// whether every light is a sphere.
bool validateLights(std::span<const CndLight> lights);

// Packs valid lights; `out` has at least lights.size() elements.
void packLights(std::span<const CndLight> lights, std::span<gpu::LightRecord> out);

} // namespace candelabra::lighting
