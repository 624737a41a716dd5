// SPDX-License-Identifier: Apache-2.0
// Checks lights and turns each CndLight into a gpu::LightRecord: the one place where physical units
// become the values that shaders read.
#pragma once

#include <span>

#include "candelabra/candelabra.h"
#include "lights/influence_box.h"
#include "lights/light_types.h"
#include "shared/lighting_data.h"

namespace candelabra::lighting
{

// Properties of a group of lights.
struct LightSummary {
    LightTypeCounts types{};
    InfluenceBoxes boxes = influenceBoxesOf({});
};
// Throws gpu::Failure naming `call` and the first light and field outside its documented range.
// `ids`: those of lights that exist already.
LightSummary validateLights(const char* call, std::span<const CndLight> lights,
                            std::span<const CndLightId> ids = {});

// Writes one record for each light. The lights must be valid. The id of a polygon's record is the
// light's, like all others: the caller replaces it by the index of the light's PolygonRecord.
void packLights(std::span<const CndLight> lights, std::span<gpu::LightRecord> records,
                uint32_t firstId = 0) noexcept;

// Returns the corners of a polygon light, which must be valid.
gpu::PolygonRecord packPolygon(const CndLight& light, uint32_t id) noexcept;

// Returns the shape that prepare_lights reads from a record, in the coordinates of the light set.
gpu::LightShape shapeOf(const gpu::LightRecord& record);

} // namespace candelabra::lighting
