// SPDX-License-Identifier: Apache-2.0
// The names of what hosts say about occluders, inside the engine.
#pragma once

#include "candelabra/candelabra.h"

namespace candelabra::lighting
{

using OccluderMeshId = CndOccluderMeshId;
using OccluderId = CndOccluderId;
using OccluderMesh = CndOccluderMesh;
using DevicePositions = CndDevicePositions;
using OccluderInstance = CndOccluderInstance;
inline constexpr uint32_t occluderLayerCount = CND_OCCLUDER_LAYER_COUNT;

} // namespace candelabra::lighting
