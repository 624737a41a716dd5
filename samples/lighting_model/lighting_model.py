# SPDX-License-Identifier: Apache-2.0
"""The lighting model (LIGHTING_MODEL.md) in double precision: closed forms for diffuse light, quadrature for
highlights. Vectors are tuples. Points are relative to the surface point, n is its normal, v points to the eye."""
from math import acos, atan2, ceil, cos, pi, sin, sqrt


def add(a, b, k=1.0): return (a[0] + k * b[0], a[1] + k * b[1], a[2] + k * b[2])
def scaled(a, k): return (a[0] * k, a[1] * k, a[2] * k)
def dot(a, b): return a[0] * b[0] + a[1] * b[1] + a[2] * b[2]
def cross(a, b): return (a[1] * b[2] - a[2] * b[1], a[2] * b[0] - a[0] * b[2], a[0] * b[1] - a[1] * b[0])
def length(a): return sqrt(dot(a, a))
def unit(a): return scaled(a, 1 / length(a))


def lobe(n, v, l, alpha):
    """The specular lobe times the cosine: with F = 1, and with F = (1 - VoH)^5."""
    NoL, NoV, a2 = dot(n, l), max(dot(n, v), 1e-4), alpha * alpha
    if NoL <= 0:
        return 0.0, 0.0
    h = unit(add(v, l))
    D = a2 / (pi * (1 - dot(n, h) ** 2 * (1 - a2)) ** 2)
    V = 0.5 / (NoL * sqrt(a2 + (1 - a2) * NoV * NoV) + NoV * sqrt(a2 + (1 - a2) * NoL * NoL))
    return D * V * NoL, D * V * NoL * (1 - dot(v, h)) ** 5


def rule(n):
    """Quadrature on 0..1: the midpoint rule after a substitution that makes both ends smooth."""
    steps = [(k + 0.5) / n for k in range(n)]
    return [(t ** 3 * (10 - 15 * t + 6 * t * t), 30 * (t * (1 - t)) ** 2 / n) for t in steps]


FEW, MANY = rule(12), rule(48)


def directional_albedo(NoV, alpha):
    """A and B, the integrals of both parts of the lobe over the hemisphere. With tan(h) = alpha sqrt(t / (1 - t)),
    t is uniform in 0..1 where half vectors have the density D cos(h)."""
    n, v, A, B = (0, 0, 1), (sqrt(1 - NoV * NoV), 0, NoV), 0.0, 0.0
    for t, weight in MANY:
        for turn in (pi * (k + 0.5) / 24 for k in range(24)):  # half a turn; the other half is the same
            slope = alpha * sqrt(t / (1 - t))
            h = unit((slope * cos(turn), slope * sin(turn), 1))
            VoH = dot(v, h)
            a, b = lobe(n, v, add(scaled(h, 2 * VoH), v, -1), alpha) if VoH > 0 else (0.0, 0.0)
            scale = 4 * VoH * pi * (alpha / (1 - t)) ** 2 * h[2] ** 3 * weight / 24
            A, B = A + scale * a, B + scale * b
    return A, B


def cap_form_factor(c, s):
    """The form factor of a sphere. c: cosine between n and its centre, s: sine of its angular radius."""
    if abs(c) >= s:
        return max(c, 0) * s * s
    m, q = sqrt(s * s - c * c), sqrt(1 - s * s)
    return (c * s * s * atan2(m, -c * q) + atan2(m, q) - m * q) / pi


def outline_form_factor(n, outline):
    """The form factor of what a loop of points encloses: Lambert's formula for a polygon, cut at the horizon."""
    cut, total = [], 0.0
    for a, b in zip(outline, outline[1:] + outline[:1]):
        ha, hb = dot(n, a), dot(n, b)
        cut += [a] if ha > 0 else []
        cut += [add(a, add(b, a, -1), ha / (ha - hb))] if ha * hb < 0 else []
    for a, b in zip(cut, cut[1:] + cut[:1]):
        normal = cross(a, b)
        sine = length(normal)
        total += atan2(sine, dot(a, b)) * dot(n, normal) / sine if sine > 0 else 0
    return abs(total) / (2 * pi)


def arc(axis, sine, side, reach, count):
    """Directions on the rim of a cap, within the angle `reach` of the side to which `side` points."""
    x = unit(add(side, axis, -dot(side, axis)))
    y = cross(axis, x)
    turns = [reach * (2 * k / count - 1) for k in range(count + 1)]
    return [add(scaled(axis, sqrt(1 - sine * sine)), add(scaled(x, cos(t)), y, sin(t)), sine) for t in turns]


def tube_outline(start, end, radius, count):
    """An arc of the rim of each end's sphere, as far as it is not hidden by the other end; lines join them."""
    outline = []
    for centre, outwards in (start, unit(add(start, end, -1))), (end, unit(add(end, start, -1))):
        axis, sine, tilt = unit(centre), radius / length(centre), dot(unit(centre), outwards)
        reach = acos(min(max(sine * tilt / sqrt((1 - sine * sine) * (1 - tilt * tilt)), -1), 1))
        rim = arc(axis, sine, outwards, reach, count)
        outline += [scaled(l, length(centre) * sqrt(1 - sine * sine)) for l in rim]
    return outline


def cap_directions(axis, sine):
    """Directions in a cap, and the solid angle that each stands for."""
    depth = 1 - sqrt(1 - sine * sine)
    for t, weight in FEW:
        for l in arc(axis, sqrt(1 - (1 - t * depth) ** 2), (0.6, 0.64, 0.48), pi, 32)[1:]:
            yield l, 2 * pi / 32 * depth * weight


def outline_directions(middle, outline):
    """The same for what a loop encloses, of which `middle` is an inner point: triangles from there to the edges."""
    edges = list(zip(outline, outline[1:] + outline[:1]))
    step = sum(length(add(b, a, -1)) for a, b in edges) / 48
    for a, b in edges:
        pieces = ceil(length(add(b, a, -1)) / step)
        volume = abs(dot(middle, cross(a, b))) / pieces
        for k in range(pieces):
            edge = add(add(a, add(b, a, -1), (k + 0.5) / pieces), middle, -1)
            for s, weight in FEW:
                q = add(middle, edge, s)
                yield unit(q), s * volume / length(q) ** 3 * weight


def response(form_factor, directions, n, v, alpha):
    """What an area light of luminance 1 adds: the form factor, A and B. With alpha = 0 there is no lobe."""
    A = B = 0.0
    for l, solid_angle in directions if alpha else ():
        a, b = lobe(n, v, l, alpha)
        A, B = A + a * solid_angle, B + b * solid_angle
    return form_factor, A, B
