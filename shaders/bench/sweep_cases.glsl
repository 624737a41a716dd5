// SPDX-License-Identifier: Apache-2.0
// The random cases of sweep_inputs.comp, one kind per slice. Lights are within the documented ranges of
// CndLight; surface points may be anything that a G-buffer can hold.

// These functions return their argument. Every input that a record holds goes through one of them, so
// that compilers cannot tell how it was computed, and the evaluation sees what the record holds.
// NVIDIA's compiler simplifies centre - position, where centre is position + offset, back to the
// offset, even if the sum is `precise`. But rounding of the sum moves the light.
float opaque(float x)
{
    return uintBitsToFloat(floatBitsToUint(x) ^ params.zero);
}

vec3 opaque(vec3 x)
{
    return uintBitsToFloat(floatBitsToUint(x) ^ params.zero);
}

vec4 opaque(vec4 x)
{
    return uintBitsToFloat(floatBitsToUint(x) ^ params.zero);
}

struct SweepPoint {
    vec3 position, n, v;
    float perceptualRoughness;
    vec3 albedo, F0;
    float F90;
};

SweepPoint makeSweepPoint(uint slice)
{
    SweepPoint p;
    p.n = chance(0.5) ? vec3(0.0, 0.0, 1.0) : randomDirection();
    float NoV = chance(0.1) ? randomRange(-1.0, 1.0) : randomRange(0.0, 1.0);
    if (slice == SWEEP_GRAZING)
        NoV = hair();
    p.v = directionAt(p.n, NoV);
    if (slice == SWEEP_ALIGNED && chance(0.5))
        p.v = besides(p.n);
    p.perceptualRoughness = random01();
    if (slice == SWEEP_EXTREME_ALPHA) {
        const uint which = randomBelow(4u);
        p.perceptualRoughness = which == 0u ? 0.0 : which == 1u ? 0.0447213595 : which == 2u ? 1.0 :
            randomRange(0.0, 0.08);
    }
    p.position = vec3(0.0);
    if (slice == SWEEP_FAR_AWAY)
        p.position = randomLog10(5.0, 6.0) * randomDirection();
    else if (chance(0.3))
        p.position = randomLog10(-2.0, 3.0) * randomDirection();
    // The vectors towards the eye need not be unit: half of them are scaled as if computed from a
    // position.
    if (slice == SWEEP_DENORMAL && chance(0.5))
        p.v = p.v * 1e-10 + 1e-39 * randomDirection();
    p.albedo = vec3(random01(), random01(), chance(0.5) ? 0.0 : 1.0);
    p.F0 = vec3(random01(), 0.04, chance(0.5) ? 0.0 : 1.0);
    p.F90 = 1.0;
    p.position = opaque(p.position);
    p.n = opaque(p.n);
    p.v = opaque(p.v);
    p.perceptualRoughness = opaque(p.perceptualRoughness);
    return p;
}

// Returns the direction to the light, or to a point of its outline in the slice EDGE, and the sine of
// the light's half angle (in the last two slices its size divided by that distance).
vec4 sweepDirection(uint slice, SweepPoint p)
{
    const vec3 v = normalize(p.v * (slice == SWEEP_DENORMAL ? 1e10 : 1.0));
    const vec3 mirror = 2.0 * dot(p.n, v) * p.n - v;
    float s = randomLog10(-7.0, 0.0);
    if (chance(0.3))
        s = random01();
    if (slice == SWEEP_EDGE || slice == SWEEP_SLIVER)
        s = randomLog10(-4.0, 1.0);
    if (slice == SWEEP_EDGE)
        return vec4(besides(mirror), s);
    if (slice == SWEEP_TANGENT) {
        const float cosine = randomSign() * s * (1.0 + hair());
        return vec4(directionAt(p.n, cosine), s);
    }
    if (slice == SWEEP_GRAZING)
        return vec4(directionAt(p.n, chance(0.5) ? hair() : hair() - s), s);
    if (slice == SWEEP_ALIGNED) {
        const uint which = randomBelow(4u);
        return vec4(besides(which == 0u ? p.n : which == 1u ? mirror : which == 2u ? v : -p.n), s);
    }
    // Half of the lights are placed within the lobe.
    if (chance(0.5))
        return vec4(normalize(mirror + (s + p.perceptualRoughness * p.perceptualRoughness + 1e-4) *
                                           random01() * randomDirection()),
                    s);
    return vec4(directionAt(p.n, randomRange(-1.0, 1.0)), s);
}

// Tells whether lights of the type use a field of CndLight; `types` is TYPES_WITH_*.
bool usesField(uint types)
{
    return (types >> lightType & 1u) != 0u;
}

vec2 sweepCorner(uint i, uint count)
{
    const float angle = 2.0 * PI * float(i) / float(count);
    return vec2(cos(angle), sin(angle));
}

// Gives the shape the corners of a regular polygon, stretched by its axes.
void makeSweepCorners(uint count, inout LightShape shape)
{
    PolygonRecord polygon;
    polygon.count = count;
    for (uint i = 0u; i < MAX_RECORD_CORNERS; ++i)
        polygon.corners[i] = sweepCorner(min(i, count - 1u), count);
    for (uint i = 0u; i < CORNER_SHAPES; ++i)
        lightShapes[1u + i] = shapeOfCorners(polygon, i, shape.axisU, shape.axisV);
    shape.radius = float(count);
    shape.flags |= 1u; // index of the first shape of corners
}

// Returns the shape of a light that has a position, about `size` metres large. A flat light has axes
// along w and cross(u, w), any other along u; u and w are unit vectors. A polygon has `corners`
// corners. Sets the bounding radius.
LightShape makeSweepShape(float size, vec3 u, vec3 w, float aspect, uint corners,
                          out float boundingRadius)
{
    const bool hasRadius = usesField(TYPES_WITH_RADIUS);
    const bool hasAxisU = usesField(TYPES_WITH_AXIS_U);
    const bool hasAxisV = usesField(TYPES_WITH_AXIS_V);
    LightShape shape = LightShape(vec3(0.0), 0.0, vec3(0.0), 0u);
    boundingRadius = 0.0;
    if (hasAxisV) {
        shape.axisU = max(size, 2e-15) * w;
        shape.axisV = max(size * aspect, 2e-15) * cross(u, w);
        boundingRadius = length(vec2(length(shape.axisU), length(shape.axisV)));
    } else if (hasAxisU) {
        shape.axisU = max(size, 2e-15) * u;
        boundingRadius = length(shape.axisU);
    } else if (usesField(TYPES_WITH_DIRECTION)) {
        shape.axisU = u;
    }
    if (hasRadius) {
        // A light along one axis is slender.
        shape.radius = max(hasAxisU && !hasAxisV ? size * aspect : size, 1e-30);
        boundingRadius += shape.radius;
        if (hasAxisV)
            shape.radius = boundingRadius; // as in shapeOfRecord()
    }
    shape.axisU = opaque(shape.axisU);
    shape.axisV = opaque(shape.axisV);
    shape.radius = opaque(shape.radius);
    if (usesField(TYPES_WITH_SIDES))
        shape.flags = chance(0.5) ? LIGHT_TWO_SIDED : 0u;
    if (usesField(TYPES_WITH_CORNERS))
        makeSweepCorners(corners, shape);
    if (usesField(TYPES_WITH_CONE)) {
        const float outer = randomRange(0.01, 1.5);
        const float between = max(cos(outer * random01()) - cos(outer), 1e-6);
        shape.axisV = vec3(1.0 / between, -cos(outer) / between, 0.0);
    }
    return shape;
}

// Returns the offset from the centre to a point of the outline of a light with such a shape, as a
// receiver sees it in the direction `at`.
vec3 outlineOffset(vec3 at, float size, vec3 u, vec3 w, float aspect, uint corners)
{
    if (usesField(TYPES_WITH_CORNERS)) {
        const vec2 onEdge = mix(sweepCorner(0u, corners), sweepCorner(1u, corners),
                                chance(0.3) ? 0.0 : random01());
        return size * (onEdge.x * w + onEdge.y * aspect * cross(u, w));
    }
    const bool hasAxisU = usesField(TYPES_WITH_AXIS_U);
    const vec2 along = vec2(randomRange(-1.0, 1.0), 1.0);
    vec2 corner = chance(0.5) ? along.xy : along.yx;
    if (chance(0.3))
        corner = vec2(1.0);
    corner *= vec2(randomSign(), randomSign());
    if (usesField(TYPES_WITH_AXIS_V))
        return size * (corner.x * w + corner.y * aspect * cross(u, w));
    if (!hasAxisU && usesField(TYPES_WITH_DIRECTION))
        return size * normalize(w + corner.x * cross(u, w));
    const vec3 side = normalize(cross(at, randomDirection()));
    return hasAxisU ? size * (corner.x * u + aspect * side) : size * side;
}

void makeSweepLight(uint slice, SweepPoint p)
{
    const vec4 at = sweepDirection(slice, p);
    float d = randomLog10(-1.0, 2.0);
    if (slice == SWEEP_SCALES)
        d = randomLog10(-6.0, 7.0);
    else if (slice == SWEEP_DENORMAL)
        d = randomLog10(-14.0, -6.0);
    float size = max(at.w, 1e-7) * d;
    if (slice == SWEEP_CONTACT) {
        size = max(d, 1e-6);
        const uint which = randomBelow(4u);
        d = which == 0u ? 0.0 : which == 1u ? size * random01() : size * (1.0 + hair());
    }
    vec3 u = randomDirection();
    if (chance(0.3))
        u = besides(-at.xyz); // faces the receiver
    if (slice >= SWEEP_EDGE && chance(0.2))
        u = besides(normalize(cross(at.xyz, randomDirection()))); // is seen from the side
    const vec3 w = normalize(cross(u, abs(u.z) < 0.9 ? vec3(0.0, 0.0, 1.0) : vec3(1.0, 0.0, 0.0)));
    float aspect = randomLog10(-2.0, 0.0);
    if (slice == SWEEP_SLIVER) {
        aspect = randomLog10(-15.0, -2.0);
        if (chance(0.3)) { // a tube without length, and rectangles that are long the other way
            size *= aspect;
            aspect = 1.0 / aspect;
        }
        // No length is below its documented range.
        size = max(size, 2e-15);
        aspect = max(aspect, 2e-15 / size);
    }
    const uint corners = usesField(TYPES_WITH_CORNERS) ? 3u + randomBelow(MAX_CORNERS - 2u) : 0u;
    vec3 offset = d * at.xyz;
    if (slice == SWEEP_EDGE)
        offset -= outlineOffset(at.xyz, size, u, w, aspect, corners);
    float emission = randomLog10(-2.0, 4.0);
    if (slice == SWEEP_EMISSION)
        emission = randomLog10(-8.0, 9.0);
    else if (slice == SWEEP_DENORMAL)
        emission = 1e-30 * randomLog10(-15.0, 0.0);
    const vec3 tint = vec3(1.0, random01(), chance(0.2) ? 0.0 : random01());
    float boundingRadius = 0.0;
    if (IS_DISTANT) {
        const float sine = usesField(TYPES_WITH_RADIUS) ? max(at.w, 1e-7) : 0.0;
        lightShapes[0] = LightShape(vec3(0.0), opaque(sine), vec3(0.0), 0u);
        centreRadius = opaque(vec4(normalize(at.xyz), min(sine, 1.0)));
    } else {
        lightShapes[0] = makeSweepShape(size, u, w, aspect, corners, boundingRadius);
        centreRadius = opaque(vec4(p.position + offset, boundingRadius));
    }
    const float limited = boundingRadius * 1.01 + 3.0 * length(offset) + 1e-12;
    const float influence = chance(0.5) ? UNBOUNDED : limited;
    emissionInfluence = opaque(vec4(emission * tint, influence * influence));
}
