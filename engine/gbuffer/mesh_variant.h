// SPDX-License-Identifier: Apache-2.0
// MeshVariant: what a pipeline of meshes is made for, so that only what a material has costs
// anything.
#pragma once

#include <compare>
#include <cstdint>

#include "gbuffer/geometry.h"

namespace candelabra::gbuffer
{

struct MeshVariant {
    bool emissive = false; // writes radiance; drawn after everything that does not
    bool colored = false;  // vertex colours
    bool tintsF0 = false;  // vertex colours change F0
    Coverage coverage = Coverage::Full;
    bool unlit = false;
    uint32_t textures = 0; // mask of 1 << TEXTURE_*

    // Fragments read the material, and textures; otherwise the vertex shader packs the material.
    bool isSampled() const
    {
        return coverage != Coverage::Full || unlit || tintsF0 || textures != 0;
    }
    auto operator<=>(const MeshVariant&) const = default;
};

} // namespace candelabra::gbuffer
