// SPDX-License-Identifier: Apache-2.0
// Points and circles of an emitter's outline (outline.glsl explains the terms).
#ifndef CND_LIB_OUTLINE_POINTS
#define CND_LIB_OUTLINE_POINTS

#include "lib/specular/conic_shading.glsl"

// Divisors that are proportional to the solid angle of a light are at least this. Floats above it have
// all their digits, and its inverse is finite.
const float SMALLEST_ANGLE = 1e-36;

// Returns a / |a|, or 0 for a = 0. The squares of the components of a may be too small for a float.
vec3 unitDirection(vec3 a)
{
    const vec3 b = a / max(max(abs(a.x), abs(a.y)), max(abs(a.z), SMALLEST_ANGLE));
    return b * inversesqrt(max(length2(b), MIN_LENGTH2));
}

// The frame of a receiver.
struct OutlineFrame {
    vec3 y, z;    // x is their product
    float vx, vz; // the direction to the eye is vx x + vz z
};

OutlineFrame makeOutlineFrame(ConicPoint p)
{
    OutlineFrame f;
    f.z = p.n;
    f.vz = p.NoV;
    f.vx = sqrt(p.vv);
    // The product of two nearly equal vectors is mostly rounding, which is not perpendicular to them.
    // If the view is along the normal, any direction in the plane will do.
    const vec3 side = p.vxn - dot(p.vxn, p.n) * p.n;
    const float side2 = length2(side);
    f.y = side2 > 1e-12 ? -side * inversesqrt(side2) : anyPerpendicular(p.n);
    return f;
}

vec3 toFrame(OutlineFrame f, vec3 a)
{
    return vec3(dot(cross(f.y, f.z), a), dot(f.y, a), dot(f.z, a));
}

vec3 stretched(float alpha, vec3 a)
{
    return vec3(a.x, a.y, alpha * a.z);
}

// A point of an outline. Lengths of w are in units of Outline::D.
struct OutlinePoint {
    vec3 dl; // the unit direction to the point, minus Outline::lc
    float e; // |w|^2 - 1
    float i; // 1 / |w|
};

// The cases for which the evaluation of an outline is prepared. A caller that knows that a light is
// easy saves time.
struct OutlineNeeds {
    bool across; // it may cross the horizon
    bool lobe;   // the specular response is wanted as well
    bool cuts;   // its arcs may need to be cut, or pieces of its rim halved (lens.glsl, disc_lobe.glsl)
    // The inputs of an arc's cuts are computed at each cut, which saves registers. Otherwise they are
    // computed once for the arc, which saves time on devices that run branches that no lane takes.
    bool lateCuts;
};

struct Outline {
    OutlineNeeds needs;
    float alpha;
    vec2 v;         // x and z of the direction to the eye
    vec3 lc;        // unit direction to the centre
    float distance; // of the centre, in any unit; offsets of points are in the same unit
    float invD;     // 1 / D; D^2 is |A (v + lc)|^2 plus the typical |A dl|^2 of the outline's points
    float spread2;  // that typical |A dl|^2, in units of D^2
    vec3 wc;        // A (v + lc), in units of D
    vec2 tilt;      // of the plane above which the light is walked; 0 for the horizon (bands.glsl)
    vec3 diffuse, specular; // sums over arcs: 2 pi f and 2 pi Phi
    float low, high;        // lowest and highest n . l of the points so far
    // The sums and the lowest n . l of the lower band. Without one, all of them are 0.
    vec3 lowerDiffuse, lowerSpecular;
    float lowerLow;
    bool inside;     // n is on the inner side of all arcs so far
    // Where the outline leaves the part that is walked and where it comes back, as OutlinePoint::dl.
    bool crosses;
    vec3 leaves, enters;
};

// Begins an outline around a centre, which is given relative to the receiver in world and in frame
// coordinates. `size2`: typical |A offset|^2 of its points.
Outline beginOutline(ConicPoint p, OutlineFrame f, vec3 worldCentre, vec3 centre, float size2,
                     OutlineNeeds needs)
{
    Outline k;
    k.needs = needs;
    k.alpha = p.alpha;
    k.v = vec2(f.vx, f.vz);
    k.distance = sqrt(max(length2(centre), MIN_LENGTH2));
    const float invDistance = 1.0 / k.distance;
    k.lc = invDistance * centre;
    // In the plane of the surface, v + lc is the difference of lc and the mirror direction, which has
    // more digits near the middle of the lobe.
    const vec3 fromMirror = toFrame(f, invDistance * worldCentre - (2.0 * p.NoV * p.n - p.v));
    const vec3 w = vec3(fromMirror.xy, p.alpha * (f.vz + k.lc.z));
    const float spread2 = min(size2 * invDistance * invDistance, 4.0);
    k.invD = inversesqrt(max(length2(w) + spread2, MIN_LENGTH2));
    k.wc = k.invD * w;
    k.spread2 = spread2 * k.invD * k.invD;
    k.tilt = vec2(0.0);
    k.diffuse = vec3(0.0);
    k.specular = vec3(0.0);
    k.lowerDiffuse = vec3(0.0);
    k.lowerSpecular = vec3(0.0);
    k.lowerLow = 0.0;
    k.low = 1.0;
    k.high = 0.0;
    k.inside = true;
    k.crosses = false;
    k.leaves = vec3(0.0);
    k.enters = vec3(0.0);
    return k;
}

// Returns the unit normal of the plane above which the light is walked.
vec3 upOf(Outline k)
{
    return vec3(k.tilt, sqrt(max(1.0 - dot(k.tilt, k.tilt), 0.0)));
}

// Returns A dl of a point.
vec3 stretchedOffset(Outline k, OutlinePoint o)
{
    return k.invD * stretched(k.alpha, o.dl);
}

// Returns w of a point from its A dl. Compilers would otherwise take the factor invD out of the sum and
// keep A (v + lc) in registers as well as wc.
vec3 stretchedPoint(Outline k, vec3 dw)
{
    precise const vec3 w = k.wc + dw;
    return w;
}

// Returns w / |w| of a point.
vec3 stretchedDirection(Outline k, OutlinePoint o)
{
    return o.i * stretchedPoint(k, stretchedOffset(k, o));
}

OutlinePoint pointInDirection(Outline k, vec3 dl)
{
    OutlinePoint o = OutlinePoint(dl, 0.0, 1.0);
    const vec3 dw = stretchedOffset(k, o);
    const float e = 2.0 * dot(k.wc, dw) + length2(dw) - k.spread2;
    // Near the middle of a narrow lobe the sum cancels, but there |w|^2 can be computed as it is.
    o.e = e < -0.5 ? max(length2(stretchedPoint(k, dw)), 1e-14) - 1.0 : e;
    o.i = inversesqrt(1.0 + o.e);
    return o;
}

// The distance of a point from the receiver.
struct PointDistance {
    float longer; // than that of the centre
    float inverse;
};

PointDistance distanceOf(Outline k, vec3 offset)
{
    const vec3 centre = k.distance * k.lc;
    const float inverse = inversesqrt(max(length2(centre + offset), MIN_LENGTH2));
    const float longer2 = 2.0 * dot(centre, offset) + length2(offset); // |P|^2 - |centre|^2
    return PointDistance(longer2 * inverse / (1.0 + k.distance * inverse), inverse);
}

// Returns the unit direction to centre + offset, minus lc.
vec3 differenceTo(Outline k, vec3 offset)
{
    const PointDistance d = distanceOf(k, offset);
    return d.inverse * (offset - d.longer * k.lc);
}

OutlinePoint pointAt(Outline k, vec3 offset)
{
    return pointInDirection(k, differenceTo(k, offset));
}

// Returns (h - sin h cos h) / (sin h (1 - cos h)) for q = cos h in 0..1, with a largest error of
// 2.2e-6. It is 4/3 at q = 1. For q up to 1.5, which stands for a hyperbola, the error is below 0.4%.
// Two things have this form. The angle between the ends of an arc of a great circle, divided by its
// sine, is 1 + (1 - q) segmentShare(q) / q, where q is the cosine of half the angle. And the area
// between an arc of a conic and its chord is 3/4 segmentShare(q) times that of a parabola with the same
// chord and height, where q is the arc's weight as a rational Bezier curve.
float segmentShare(float q)
{
    float k = 0.0197597923;
    k = k * q - 0.0910466485;
    k = k * q + 0.196522217;
    k = k * q - 0.286230214;
    k = k * q + 0.352519894;
    k = k * q - 0.42898467;
    return k * q + 1.57079411;
}

// The circle that an arc belongs to, on the unit sphere: the directions l with dot(axis, l) = kappa. It
// lies counterclockwise around its axis. For a great circle kappa is 0 and s2 is 1.
struct ArcCircle {
    vec3 axis;
    float kappa, s2; // cosine and squared sine of the circle's half angle
    vec3 centre;     // kappa axis - Outline::lc; if it is small, it has digits that the axis has not
};

// Returns the product of two complex numbers, which turns a by the angle of b if b has length 1.
vec2 complexProduct(vec2 a, vec2 b)
{
    return vec2(a.x * b.x - a.y * b.y, a.x * b.y + a.y * b.x);
}

// The half angle of an arc.
struct HalfAngle {
    float sin2, cosine;
};

HalfAngle halfAngleOf(float chord2, float s2)
{
    const float sin2 = min(0.25 * chord2 / s2, 1.0);
    return HalfAngle(sin2, sqrt(max(1.0 - sin2, 1e-8)));
}

#endif
