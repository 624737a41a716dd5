// SPDX-License-Identifier: Apache-2.0
// Diffuse of a disc light: its exact form factor.
#ifndef CND_LIB_LIGHTS_DISC
#define CND_LIB_LIGHTS_DISC

#include "lib/contour.glsl"

const float DISC_SERIES_LIMIT = 0.35;
const int DISC_SERIES_TERMS = 9; // the first one left out is below 0.18^9 = 2e-7

vec2 complexProduct(vec2 a, vec2 b)
{
    return vec2(a.x * b.x - a.y * b.y, a.x * b.y + a.y * b.x);
}

// Integrals over phi, from one angle to another whose sines and cosines are given, `turn` apart, of
// cos(phi) / (1 + e cos(phi)) times 1, cos(phi) and sin(phi); 0 <= e < 1, root = sqrt(1 - e^2).
vec3 discArcIntegrals(float e, float root, vec2 from, vec2 to, float turn)
{
    const float delta = to.y - from.y;
    // In closed form. The integral of 1 / (1 + e cos(phi)) is E / root, with E Kepler's eccentric
    // anomaly of phi, written as a difference to phi that has no jumps.
    const float ratio = e / (1.0 + root);
    const float even = turn - 2.0 * (atan(ratio * to.y / (1.0 + ratio * to.x)) -
                                     atan(ratio * from.y / (1.0 + ratio * from.x)));
    const float invE = 1.0 / max(e, 1e-6);
    vec3 closed;
    closed.x = (turn - even / root) * invE;
    closed.y = (delta - closed.x) * invE;
    closed.z = (log((1.0 + e * to.x) / (1.0 + e * from.x)) * invE - (to.x - from.x)) * invE;
    // As Fourier series, whose ratio is about e / 2; the closed form cancels for small e.
    vec2 powerFrom = from;
    vec2 powerTo = to;
    float factor = 1.0;
    vec2 before = vec2(turn, 0.0); // integrals of cos(k phi), sin(k phi) for k = 0, then k = 1
    vec2 now = vec2(to.y - from.y, from.x - to.x);
    vec3 series = -e * vec3(turn, now.x, now.y);
    for (int k = 1; k <= DISC_SERIES_TERMS; ++k) {
        powerFrom = complexProduct(powerFrom, from);
        powerTo = complexProduct(powerTo, to);
        const vec2 next = vec2(powerTo.y - powerFrom.y, powerFrom.x - powerTo.x) / float(k + 1);
        series += factor * vec3(2.0 * now.x, next.x + before.x, next.y - before.y);
        before = now;
        now = next;
        factor *= -ratio;
    }
    return e > DISC_SERIES_LIMIT ? closed : series / (root + root * root);
}

// Form factor F = E / (pi L), 0..1: centre relative to the point, unit normal the way the disc faces.
// Contour integral (contour.glsl) along the circle, on which the squared distance is
// D^2 (1 + e cos phi), and along the horizon. 0 in the plane of the disc outside of it.
float discFormFactor(vec3 n, vec3 toCentre, vec3 normal, float radius, bool twoSided)
{
    const float h = dot(toCentre, normal);
    const vec3 inPlane = toCentre - h * normal;
    const float r2 = length2(inPlane);
    const bool offAxis = r2 > 1e-12 * h * h && r2 > MIN_LENGTH2;
    const vec3 u = offAxis ? inPlane * inversesqrt(r2) : anyPerpendicular(normal);
    const vec3 v = cross(normal, u);
    const float offset = offAxis ? sqrt(r2) : 0.0;

    Contour k = beginContour(n, toCentre, radius * radius);
    const float e = min(2.0 * offset * radius * k.invD2, 0.999999);
    const float nearer = (offset - radius) * (offset - radius) + h * h;
    const float farther = (offset + radius) * (offset + radius) + h * h;
    const float root = clamp(sqrt(nearer * k.invD2 * farther * k.invD2), 1e-6, 1.0);

    // The arc above the horizon: its middle is the direction (nu, nv), its half angle has this cosine.
    const float nu = dot(n, u);
    const float nv = dot(n, v);
    const float nw = dot(n, normal);
    const float tilt2 = nu * nu + nv * nv;
    const float inv = inversesqrt(max(tilt2, MIN_LENGTH2));
    const vec2 middle = tilt2 > MIN_LENGTH2 ? vec2(nu, nv) * inv : vec2(1.0, 0.0);
    const float height = dot(n, toCentre) / radius;
    const float c = clamp(-height * inv, -1.0, 1.0);
    const float s = sqrt(max(1.0 - c * c, 0.0));
    const vec2 from = vec2(middle.x * c + middle.y * s, middle.y * c - middle.x * s);
    const vec2 to = vec2(middle.x * c - middle.y * s, middle.y * c + middle.x * s);
    const float turn = 2.0 * atan(s, c);

    // n . (P x dP) = p + (q, r).(cos, sin), over the squared radius
    const float p = nw;
    const float q = (nw * offset - h * nu) / radius;
    const float r = -h * nv / radius;
    const vec3 integrals = discArcIntegrals(e, root, from, to, turn);
    k.sum = radius * radius * (nw * turn - e * dot(vec3(p, q, r), integrals));
    // Back along the horizon; where nothing crosses, s = 0 and this adds nothing.
    const vec3 chord = radius * c * (middle.x * u + middle.y * v);
    contourSegment(k, chord, (radius * s) * (middle.y * u - middle.x * v), -1.0, 1.0);
    const float f = contourFormFactor(k);
    return c < 1.0 && (twoSided || h < 0.0) ? f : 0.0;
}

#endif
