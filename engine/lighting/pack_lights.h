// SPDX-License-Identifier: Apache-2.0
// CndLight -> gpu::LightRecord: the one place where physical units become shader values.
#pragma once

#include <array>
#include <span>
#include <vector>

#include "candelabra/candelabra.h"
#include "shared/lighting.h"

namespace candelabra::lighting
{

using LightTypeCounts = std::array<uint32_t, CND_LIGHT_TYPE_COUNT>;

// Throws gpu::Failure naming the first light and field outside its documented range.
void validateLights(std::span<const CndLight> lights);

// Of valid lights.
LightTypeCounts countTypes(std::span<const CndLight> lights);

// Which record each of these valid lights becomes: by type, in their order within a type. `counts`:
// room for each type, at least what there is.
std::vector<uint32_t> recordsOf(std::span<const CndLight> lights, const LightTypeCounts& counts);

// Valid lights into their records, as many numbers as lights.
void packLights(std::span<const CndLight> lights, std::span<const uint32_t> recordOf,
                std::span<gpu::LightRecord> records) noexcept;

} // namespace candelabra::lighting
