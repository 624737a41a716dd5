// SPDX-License-Identifier: Apache-2.0
// The one table of what the program knows of each light type: its name, how scene descriptions
// write it, and what a lamp of that type looks like. All else follows from cndLightFields.
#pragma once

#include <string>
#include <vector>

#include "candelabra/candelabra.h"

namespace candelabra::app
{

// The meaning of a key of a scene description for a light.
enum class LightKeyMeaning {
    Position,     // its centre
    Direction,    // CndLight::direction, of any length
    Radius,       // metres
    Sine,         // CndLight::radius of a distant sphere
    SegmentStart, // with SegmentEnd: the ends of the segment whose half is CndLight::axisU
    SegmentEnd,   //
    AxisU,
    AxisV,     // metres; AxisV follows AxisU and is perpendicular to it
    InnerCone, // half angles in degrees; OuterCone follows InnerCone and is the larger one
    OuterCone, //
    TwoSided,  // true or false; may be missing, which is false
    Corners,   // of a polygon, in space
};

struct LightKey {
    const char* name;
    LightKeyMeaning meaning;
};

struct LightTypeInfo {
    const char* name; // in scene descriptions, reports and tables
    std::vector<LightKey> keys;
    // Keys of a scene description for the emission, of which a light has one. The first one is
    // CndLight::emission itself.
    std::vector<std::string> emission;
    // The size of a lamp for a table top: radius, cone, axisU, polygon and twoSided, and the length
    // of axisV in axisV[0].
    CndLight lamp;
};

// `type` must be a CndLightType.
const LightTypeInfo& lightTypeInfo(uint32_t type);

// The name of the table.
const char* lightTypeName(uint32_t type);
// The name for people to read: with spaces.
std::string lightTypeLabel(uint32_t type);

// Returns the types whose lights have a size, in the order of their ids.
std::vector<uint32_t> areaLightTypes();

} // namespace candelabra::app
