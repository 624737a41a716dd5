// SPDX-License-Identifier: Apache-2.0
// Each lane finds the visible shares of a block of lights itself, before light_walk.glsl evaluates
// them. The lanes of a group walk for different lights, which is slower than pair_visibility. It is for
// pixels that have no slots, and for hosts' shaders.
#ifndef CND_SHADING_BLOCK_VISIBILITY
#define CND_SHADING_BLOCK_VISIBILITY

#extension GL_KHR_shader_subgroup_vote : require
#include "shading/classify_lights.glsl"
#include "shading/light_visibility.glsl"

// The host's function needs no occluders (light_visibility.glsl).
#ifdef CANDELABRA_VISIBLE_POINTS
#define HAS_SHADOWS (shadowView.asks != 0u)
#else
#define HAS_SHADOWS (shadowView.layers != 0u)
#endif

// A kernel defines SHARES_LANES, the number of lanes of a group, and shared memory keeps the shares.
#ifdef SHARES_LANES
shared uint blockShares[SHADOW_BLOCK * SHARES_LANES];
#define BLOCK_SHARES(k) blockShares[(k) * SHARES_LANES + gl_LocalInvocationIndex]
#else
uint blockShares[SHADOW_BLOCK];
#define BLOCK_SHARES(k) blockShares[k]
#endif

uint unfinishedPairs = 0u; // lights whose occluders were not all found (lightVisibility)
float pointDepthError = 0.0; // of the point that is lit (lightVisibility)

// Returns the visible shares of the k-th light. Blocks begin at 0.
uint visibleSharesAt(uint k)
{
    return HAS_SHADOWS ? BLOCK_SHARES(k) : SHARES_LIT;
}

// Finds the visible shares of these lights of a block.
void findShares(Receiver r, uvec2 found)
{
    uint left = HAS_SHADOWS ? found.x : 0u;
    // All lanes stay in this loop until the last one leaves it: they walk together.
    while (subgroupAny(left != 0u)) {
        const bool asks = left != 0u;
        const uint k = asks ? uint(findLSB(left)) : 0u;
        bool isFinished;
        const uint shares = lightVisibility(lightAt(k), r.p, pointDepthError, asks, isFinished);
        if (asks) {
            BLOCK_SHARES(k) = shares;
            unfinishedPairs += isFinished ? 0u : 1u;
        }
        left &= left - 1u;
    }
}

#endif
