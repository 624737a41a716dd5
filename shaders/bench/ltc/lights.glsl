// SPDX-License-Identifier: Apache-2.0
// A rival of the engine's closed forms: lights evaluated by linearly transformed cosines. The functions
// have the names of those in shading/light_eval.glsl and bench/evaluate_classified.glsl, for a receiver
// of their own. They are compiled for the family POLYGON. The form factor of polygons and rectangles is
// the contour integral by which the specular lobe is evaluated, too.
#ifndef CND_BENCH_LTC_LIGHTS
#define CND_BENCH_LTC_LIGHTS

#include "bench/ltc/lobes.glsl"
#include "shading/light_walk.glsl"
#include "lib/lights/sphere.glsl"
#include "lib/lights/sphere_cap.glsl"

struct LtcReceiver {
    Receiver base;
    LtcPoint ltc;
};

LtcReceiver makeLtcReceiver(Receiver base)
{
    return LtcReceiver(base, makeLtcPoint(base.p));
}

// `above`: the sphere is wholly above the horizon.
LightResponse sphereByCosines(LtcReceiver r, Light light, bool above)
{
    const SphereCap cap = makeSphereCap(r.base.p.n, light.toLight, light.boundingRadius);
    const float formFactor = above ? cap.NoC * cap.s2 : sphereFormFactor(cap.NoC, cap.s2);
    return LightResponse(formFactor, ltcSphere(r.ltc, cap.c, cap.s2));
}

LightResponse rectangleByCosines(LtcReceiver r, Light light, vec3 u, vec3 v, bool twoSided)
{
    const bool seen = facesRectangle(light.toLight, u, v, twoSided);
    const float f = parallelogramFormFactor(r.base.p.n, light.toLight, u, v);
    return LightResponse(seen ? f : 0.0, ltcRectangle(r.ltc, light.toLight, u, v, twoSided));
}

// Returns the form factor of a polygon after a linear map.
float polygonFormFactor(vec3 n, mat3 map, Polygon polygon)
{
    const float offset2 = length2(map * polygon.axisU) + length2(map * polygon.axisV);
    Contour k = beginContour(n, map * polygon.toCentre, offset2);
    vec3 from = map * cornerOf(polygon, polygon.count - 1u);
    for (uint i = 0u; i < polygon.count; ++i) {
        const vec3 to = map * cornerOf(polygon, i);
        contourEdge(k, 0.5 * (from + to), 0.5 * (to - from));
        from = to;
    }
    return contourFormFactor(k);
}

LightResponse polygonByCosines(LtcReceiver r, Polygon polygon)
{
    if (!facesRectangle(polygon.toCentre, polygon.axisU, polygon.axisV, polygon.twoSided))
        return LightResponse(0.0, vec2(0.0));
    const vec3 n = r.base.p.n;
    const float underLobe = polygonFormFactor(LTC_NORMAL, ltcMatrix(r.ltc.lobe, n), polygon);
    return LightResponse(polygonFormFactor(n, mat3(1.0), polygon), ltcResponse(r.ltc, underLobe));
}

// Returns the response to a light of unit emission. The light's type is a specialisation constant, so
// only one of the calls remains.
LightResponse responseByCosines(LtcReceiver r, Light given, bool above)
{
    const LightShape shape = lightShapes[given.index];
    float scale;
    const Light light = atUnitDistance(given, scale);
    const vec3 u = scale * shape.axisU, v = scale * shape.axisV;
    if (lightType == LIGHT_RECTANGLE)
        return rectangleByCosines(r, light, u, v, isTwoSided(shape));
    if (lightType == LIGHT_POLYGON)
        return polygonByCosines(r, Polygon(light.toLight, u, v, scale, light.boundingRadius,
                                           firstCornerShape(shape), cornerCount(shape),
                                           isTwoSided(shape)));
    return sphereByCosines(r, given, above);
}

vec3 evaluateByCosines(LtcReceiver r, uint index, bool above)
{
    const Light light = readLight(r.base, index);
    return emissionTowards(r.base, light, length2(light.toLight)) *
        reflected(r.base.p, responseByCosines(r, light, above));
}

vec3 evaluate_ABOVE(LtcReceiver r, uint light)
{
    return evaluateByCosines(r, light, true);
}

vec3 evaluate_GENERAL(LtcReceiver r, uint light)
{
    return evaluateByCosines(r, light, false);
}

// Evaluates a light unless it is wholly below the horizon.
vec3 evaluateClassified(LtcReceiver r, uint light)
{
    const Light seen = readLight(r.base, light);
    const bool reaches = dot(r.base.p.n, seen.toLight) > -seen.boundingRadius;
    return reaches ? evaluate_GENERAL(r, light) : vec3(0.0);
}

#endif
