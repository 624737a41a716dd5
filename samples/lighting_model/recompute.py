#!/usr/bin/env python3
# SPDX-License-Identifier: Apache-2.0
"""Recomputes random pixels of a picture by the lighting model, and prints how far they are from the picture:

    candelabra render scene.json --shadows off --aa 1 -o picture.pfm
    python3 recompute.py scene.json picture.pfm

It knows the keys of scene.json and no others. There, each ball's material has one lobe, and each channel has one light
per layer, so that a row of the table compares one lobe and one light. Give the camera layer 1 in place of 0 for the
other lights. Pass --lobes and --energy-compensation as the program got them."""
import argparse
import json
import math
import random
import struct
import sys

sys.dont_write_bytecode = True  # the folder may be read-only
from lighting_model import (add, cap_directions, cap_form_factor, cross, directional_albedo, dot, length, lobe,
                            outline_directions, outline_form_factor, response, scaled, tube_outline, unit)


def surface(scene, x, y):
    """The position of what a pixel shows, its normal, the direction to the eye and its material, or None."""
    camera, (width, height) = scene["camera"], scene["resolution"]
    eye, forward = camera["position"], unit(add(camera["look_at"], camera["position"], -1))
    right = unit(cross(forward, camera["up"]))
    half = math.tan(math.radians(camera["vertical_fov_degrees"]) / 2)
    ray = add(forward, right, half * (2 * x + 1 - width) / height)
    ray = unit(add(ray, cross(right, forward), half * (height - 2 * y - 1) / height))
    hits = []
    for shape in scene["objects"]:
        if shape["type"] == "plane":
            t = dot(shape["normal"], add(shape["point"], eye, -1)) / dot(shape["normal"], ray)
        else:
            to_centre = add(shape["center"], eye, -1)
            square = dot(to_centre, ray) ** 2 - dot(to_centre, to_centre) + shape["radius"] ** 2
            t = dot(to_centre, ray) - math.sqrt(square) if square > 0 else 0
        if t > 0:
            p = add(eye, ray, t)
            n = shape["normal"] if shape["type"] == "plane" else unit(add(p, shape["center"], -1))
            hits.append((t, p, n, scaled(ray, -1), shape["material"]))
    return min(hits)[1:] if hits else None


def light_at(light, p, n, v, alpha):
    """The emission of a light as it reaches p, and what emission 1 adds: diffuse, A and B."""
    kind, emission, window = light["type"], light.get("luminance", light.get("intensity")), 1.0
    if kind == "distant_sphere":
        axis, sine = unit(scaled(light["direction"], -1)), light["sin_angular_radius"]
        emission = emission or [lux / (math.pi * sine * sine) for lux in light["illuminance"]]
        return emission, response(cap_form_factor(dot(n, axis), sine), cap_directions(axis, sine), n, v, alpha)
    ends = [add(light[key], p, -1) for key in (("start", "end") if kind == "tube" else ("position", "position"))]
    centre = scaled(add(*ends), 0.5)
    d, axis = length(centre), unit(centre)
    if "influence_radius" in light:
        window = max(1 - (d / light["influence_radius"]) ** 4, 0) ** 2
    if kind == "point":
        A, B = lobe(n, v, axis, alpha) if alpha else (0.0, 0.0)
        result = max(dot(n, axis), 0) / (math.pi * d * d), A / (d * d), B / (d * d)
    elif kind == "sphere":
        sine = light["radius"] / d
        result = response(cap_form_factor(dot(n, axis), sine), cap_directions(axis, sine), n, v, alpha)
    elif kind == "rectangle":
        u, w = light["axis_u"], light["axis_v"]  # this one is two-sided
        corners = [add(add(centre, u, i), w, j) for i, j in ((-1, -1), (1, -1), (1, 1), (-1, 1))]
        result = response(outline_form_factor(n, corners), outline_directions(centre, corners), n, v, alpha)
    else:
        fine, coarse = (tube_outline(*ends, light["radius"], count) for count in (256, 16))
        result = response(outline_form_factor(n, fine), outline_directions(centre, coarse), n, v, alpha)
    return [window * e for e in emission], result


def radiance(scene, p, n, v, material, conserving, compensated):
    """The luminance of a pixel in each channel, cd/m^2."""
    F0, F90 = (material["F0"], 1) if material.get("specular", True) else ((0, 0, 0), 0)
    albedo = material["albedo"] if material.get("diffuse", True) else (0, 0, 0)
    gain, share = (1, 1, 1), (0, 0, 0)
    if F90 and (conserving or compensated):
        A, B = directional_albedo(max(dot(n, v), 1e-4), material["alpha"])
        gain = [1 + f * (1 / A - 1) for f in F0] if compensated else gain
        share = [g * (f * (A - B) + F90 * B) for f, g in zip(F0, gain)] if conserving else share
    total = [0, 0, 0]
    for light in scene["lights"]:
        if not set(light["layers"]) & set(scene["camera"]["layers"]):
            continue
        emission, (form_factor, A, B) = light_at(light, p, n, v, material["alpha"] if F90 else 0)
        for c in range(3):
            diffuse = albedo[c] * max(1 - share[c], 0) * form_factor
            total[c] += emission[c] * (diffuse + gain[c] * (F0[c] * (A - B) + F90 * B))
    return total


def read_pfm(path):
    """The rows of a picture, from the top."""
    with open(path, "rb") as file:
        kind, size, order = (file.readline().strip() for _ in range(3))
        width, height = map(int, size.split())
        values = struct.unpack(f"{'<' if float(order) < 0 else '>'}{3 * width * height}f", file.read())
    assert kind == b"PF"
    return [[values[3 * (y * width + x):][:3] for x in range(width)] for y in reversed(range(height))]


def compare(scene, picture, options):
    """Returns the pairs of model and picture at random pixels, by material and channel."""
    chosen, pairs = random.Random(1), {}
    for _ in range(options.pixels):
        x, y = (chosen.randrange(size) for size in scene["resolution"])
        seen = surface(scene, x, y)
        if seen:
            model = radiance(scene, *seen, options.lobes == "conserving", options.energy_compensation == "on")
            for channel, value in zip(("red", "green", "blue"), zip(model, picture[y][x])):
                pairs.setdefault((seen[3]["name"], channel), []).append(value)
    return pairs


def main():
    parser = argparse.ArgumentParser(description=__doc__, formatter_class=argparse.RawDescriptionHelpFormatter)
    parser.add_argument("scene")
    parser.add_argument("picture")
    parser.add_argument("--lobes", choices=["sum", "conserving"], default="sum")
    parser.add_argument("--energy-compensation", choices=["off", "on"], default="off")
    parser.add_argument("--pixels", type=int, default=100)
    options = parser.parse_args()
    with open(options.scene, encoding="utf-8") as file:
        scene = json.load(file)
    print("Differences between picture and model. Median and largest are relative, and leave out pixels with less\n"
          "than a tenth of the light of the brightest. The last column is the largest of all, as a share of that light.")
    print("material channel lit brightest   median  largest of brightest")
    for (name, channel), values in sorted(compare(scene, read_pfm(options.picture), options).items()):
        top = max(model for model, _ in values)
        if top > 0:
            relative = sorted(abs(shown / model - 1) for model, shown in values if model >= 0.1 * top)
            print(f"{name:8} {channel:7} {sum(model > 0 for model, _ in values):3} {top:9.4g} "
                  f"{relative[len(relative) // 2]:8.1e} {relative[-1]:8.1e} "
                  f"{max(abs(shown - model) for model, shown in values) / top:12.1e}")


if __name__ == "__main__":
    main()
