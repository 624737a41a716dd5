// SPDX-License-Identifier: Apache-2.0
// The functions that hosts' shaders get by including lib/forward.glsl, which says how to use them, and
// the bindings of the descriptor set FORWARD_SET.
#ifndef CND_SHADING_FORWARD_LIGHTS
#define CND_SHADING_FORWARD_LIGHTS

#extension GL_EXT_samplerless_texture_functions : require
#include "shared/forward_data.h"
#include "lib/gbuffer.glsl"
#include "lib/bounds.glsl"
#include "lib/brdf.glsl"
#include "lib/projection.glsl"
#include "lib/dfg.glsl"
#include "lib/joining.glsl"
#include "lib/light_tree_walk.glsl"

layout(scalar, set = FORWARD_SET, binding = FORWARD_VIEW) readonly buffer ForwardViewBuffer
{
    ForwardView forwardView;
};
layout(scalar, set = FORWARD_SET, binding = FORWARD_CORE) readonly buffer ForwardCore
{
    vec4 lightCore[];
};
layout(scalar, set = FORWARD_SET, binding = FORWARD_SHAPES) readonly buffer ForwardShapes
{
    LightShape lightShapes[];
};
layout(scalar, set = FORWARD_SET, binding = FORWARD_NODES) readonly buffer ForwardNodes
{
    vec4 treeNodes[];
};
layout(scalar, set = FORWARD_SET, binding = FORWARD_IDS) readonly buffer ForwardIds
{
    uint lightIds[]; // per light: low half of the CndLightId, or LIGHT_OF_DEVICE + an index
};
layout(set = FORWARD_SET, binding = FORWARD_DFG) uniform textureBuffer dfgTexels;

#define LIGHT_FAMILY_ALL
#define COUNTS_DIFFER true
#if defined(CANDELABRA_SHADOWS) || defined(CANDELABRA_VISIBLE_POINTS)
#define SHADOWS
#define FINDS_SHARES
#define OCCLUDER_SET FORWARD_SET
#include "shading/occluder_buffers.glsl"
const uint FOUND_LIGHTS = SHADOW_BLOCK;
#else
const uint FOUND_LIGHTS = PAGE_LIGHTS;
#endif

// lib/dfg.glsl reads its table through this function.
vec4 dfgTexel(int entry)
{
    return texelFetch(dfgTexels, entry);
}

vec4 lightCentre(uint light)
{
    return lightCore[light * LIGHT_CORE_STRIDE];
}

vec4 lightEmission(uint light)
{
    return lightCore[light * LIGHT_CORE_STRIDE + 1u];
}

// Lights that were found and are to be evaluated. All of them are of one type.
uint foundLights[FOUND_LIGHTS + 1u];

uint lightAt(uint k)
{
    return foundLights[k];
}

#include "shading/light_walk.glsl"

// Iterates over the lights of one type that reach a position. A shader may use one cursor at a time.
struct LightCursor {
    uint light; // the light that nextLight() has found, an argument for evaluateLight()
    vec3 position;
    uint next, end; // lights of the present leaf that are not tested yet
    TreeWalk walk;
};

// Returns a cursor that stands before the first light. Its light is one of the type, because lanes that
// wait for others read one.
LightCursor lightsAt(uint type, vec3 position)
{
    lightType = type;
    const TreeShape tree = forwardView.trees[type];
    if (IS_DISTANT) // every distant light reaches every position, so there is no tree
        return LightCursor(tree.firstLight, position, tree.firstLight,
                           tree.firstLight + tree.lightCount,
                           TreeWalk(0u, 0u, 0u, 0u, true));
    return LightCursor(tree.firstLight, position, 0u, 0u, beginTreeWalk(tree, TREE_LEVELS));
}

// Goes to the next light. Returns false after the last one.
bool nextLight(inout LightCursor c)
{
    const TreeShape tree = forwardView.trees[lightType];
    bool found = false;
    while (!found && (c.next < c.end || !c.walk.done)) {
        if (c.next < c.end) {
            c.light = c.next;
            ++c.next;
            const float d2 = length2(towardsLight(lightCentre(c.light).xyz, c.position));
            found = d2 < lightEmission(c.light).w;
        } else {
            const uint at = treeNodeIndex(c.walk) * TREE_NODE_STRIDE;
            const bool inside =
                boxHolds(Box(treeNodes[at].xyz, treeNodes[at + 1u].xyz), c.position);
            if (inside && c.walk.level == 1u) {
                c.next = tree.firstLight + c.walk.index * TREE_WIDTH;
                c.end = min(c.next + TREE_WIDTH, tree.firstLight + tree.lightCount);
            }
            if (inside && c.walk.level > 1u)
                descend(tree, c.walk);
            else
                skipSubtree(tree, c.walk);
        }
    }
    return found;
}

// Returns what a surface prepares once for all lights.
Receiver forwardReceiver(Surface surface, vec3 position)
{
    ShadingPoint p =
        makeShadingPoint(surface, position, towardsEye(forwardView.projection, position));
    if (forwardView.lobes != LOBES_SUM)
        joinLobes(p, directionalAlbedo(p.NoV, p.alpha),
                  forwardView.lobes & (COMPENSATE_ENERGY - 1u),
                  forwardView.lobes & COMPENSATE_ENERGY);
    return makeReceiver(p, 1u, 0u);
}

// Returns the luminance towards the eye, in cd/m^2, that a light of the cursor's type adds.
vec3 evaluateLight(Receiver receiver, uint light)
{
    foundLights[0] = light;
    Sums sums = noLight();
    shadeBlock(sums, receiver, 0u, 1u, true);
    return total(sums);
}

// Returns `type` or the next type that has lights, or LIGHT_TYPE_COUNT if there is none.
uint typeWithLights(uint type)
{
    while (type < LIGHT_TYPE_COUNT &&
           forwardView.trees[min(type, LIGHT_TYPE_COUNT - 1u)].lightCount == 0u)
        ++type;
    return min(type, LIGHT_TYPE_COUNT);
}

// Returns the luminance towards the eye, in cd/m^2, of a surface under all lights. It is what the
// view's own pass adds to the radiance of an opaque surface with SPECULAR_CONIC, summed in the same
// order.
vec3 litSurface(Surface surface, vec3 position)
{
    const Receiver receiver = forwardReceiver(surface, position);
    vec3 luminance = vec3(0.0);
    uint type = typeWithLights(0u);
    if (type == LIGHT_TYPE_COUNT)
        return luminance;
    LightCursor cursor = lightsAt(type, position);
    Sums sums = noLight();
    // The loops test their conditions at the end, as SHADE_FOUND does. A lane whose condition is false
    // may run once more (software_drivers.glsl). Its cursor is then after the last light, or
    // foundLights has room for one more.
    do {
        uint count = 0u;
        bool more;
        do {
            more = nextLight(cursor);
            foundLights[count] = cursor.light;
            count += more ? 1u : 0u;
        } while (more && count < FOUND_LIGHTS);
        shadeBlock(sums, receiver, 0u, count, true);
        if (!more) {
            luminance += total(sums);
            sums = noLight();
            type = typeWithLights(type + 1u);
            if (type < LIGHT_TYPE_COUNT)
                cursor = lightsAt(type, position);
        }
    } while (type < LIGHT_TYPE_COUNT);
    return luminance;
}

// Returns the illuminance, in lx, that a light of the cursor's type gives a surface that faces its
// centre, and the unit direction to the centre. It is meant for volumes, which evaluate their phase
// function for this direction.
vec3 illuminanceTowards(uint light, vec3 position, out vec3 direction)
{
    direction = normalize(towardsLight(lightCentre(light).xyz, position));
    Surface surface;
    surface.normal = direction;
    surface.albedo = vec3(PI);
    surface.F0 = vec3(0.0);
    surface.specularWeight = 0.0;
    surface.perceptualRoughness = 1.0;
    return evaluateLight(makeReceiver(makeShadingPoint(surface, position, direction), 1u, 0u),
                         light);
}

#endif
