// SPDX-License-Identifier: Apache-2.0
// Diffuse lighting by a disc light: its exact form factor.
#ifndef CND_LIB_LIGHTS_DISC
#define CND_LIB_LIGHTS_DISC

#include "lib/contour.glsl"

const float DISC_SERIES_LIMIT = 0.35; // discArcIntegrals uses the series up to this e
const int DISC_SERIES_TERMS = 9;      // the first term left out is below 0.18^9 = 2e-7

vec2 complexProduct(vec2 a, vec2 b)
{
    return vec2(a.x * b.x - a.y * b.y, a.x * b.y + a.y * b.x);
}

// Returns the integrals over phi of cos(phi) / (1 + e cos(phi)) times 1, times cos(phi) and times
// sin(phi), for 0 <= e < 1 and root = sqrt(1 - e^2). `from` and `to` are (cos, sin) of the first and
// the last phi, which are the angle `turn` apart.
vec3 discArcIntegrals(float e, float root, vec2 from, vec2 to, float turn)
{
    const float delta = to.y - from.y;
    // The closed form. The integral of 1 / (1 + e cos(phi)) is E / root, where E is Kepler's eccentric
    // anomaly of the true anomaly phi. It is computed from E - phi, which has no jumps.
    const float ratio = e / (1.0 + root);
    const float even = turn - 2.0 * (atan(ratio * to.y / (1.0 + ratio * to.x)) -
                                     atan(ratio * from.y / (1.0 + ratio * from.x)));
    const float invE = 1.0 / max(e, 1e-6);
    vec3 closed;
    closed.x = (turn - even / root) * invE;
    closed.y = (delta - closed.x) * invE;
    closed.z = (log((1.0 + e * to.x) / (1.0 + e * from.x)) * invE - (to.x - from.x)) * invE;
    // The Fourier series, whose terms fall by a ratio of about e / 2. It serves small e, for which the
    // closed form cancels.
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

// Returns the form factor F = E / (pi L), 0..1. `toCentre`: the centre relative to the point; `normal`:
// unit vector in the direction that the disc faces. It is the contour integral (contour.glsl) along the
// circle, on which the squared distance is D^2 (1 + e cos(phi)), and along the horizon. It is 0 at
// points of the disc's plane outside the disc.
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

    // The arc above the horizon: (nu, nv) is the direction of its middle, c and s are the cosine and
    // the sine of its half angle.
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

    // n . (P x dP) / (radius^2 dphi) = p + q cos(phi) + r sin(phi)
    const float p = nw;
    const float q = (nw * offset - h * nu) / radius;
    const float r = -h * nv / radius;
    const vec3 integrals = discArcIntegrals(e, root, from, to, turn);
    k.sum = radius * radius * (nw * turn - e * dot(vec3(p, q, r), integrals));
    // The chord along the horizon. If the circle does not cross it, s = 0 and this adds nothing.
    const vec3 chord = radius * c * (middle.x * u + middle.y * v);
    contourSegment(k, chord, (radius * s) * (middle.y * u - middle.x * v), -1.0, 1.0);
    const float f = contourFormFactor(k);
    return c < 1.0 && (twoSided || h < 0.0) ? f : 0.0;
}

#endif
