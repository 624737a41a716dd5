#!/usr/bin/env python3
# SPDX-License-Identifier: Apache-2.0
"""The example of engine/LIGHTING_MODEL.md recomputes pixels that the program has rendered, three lights on a floor and
three balls: with lobes that are added, and three other lights with lobes that conserve energy.
Usage: test_lighting_model.py PROGRAM REPOSITORY"""
import os
import pathlib
import subprocess
import sys
import tempfile

program, root = pathlib.Path(sys.argv[1]).resolve(), pathlib.Path(sys.argv[2]).resolve()
example = root / "samples/lighting_model"
device = os.environ.get("CANDELABRA_TEST_DEVICE")
CONSERVING = ["--lobes", "conserving", "--energy-compensation", "on"]
# Largest differences. DIFFUSE is relative, where a pixel has a tenth of the light of the brightest or more. LOBE is a
# share of the brightest pixel of the same material and light, and is within the stated errors of the closed forms.
DIFFUSE, LOBE = 1e-5, 0.02
failures = []


def table(scene, picture, options):
    """Renders a scene and returns the rows that the example prints: the largest differences by material and light."""
    command = [program, "-q", "render", scene, "--shadows", "off", "--aa", "1", "-o", picture, *options]
    command += ["--culling", "brute"]  # for a few lights it needs fewer pipelines, which take most of the time
    subprocess.run(command + (["--device", device] if device else []), check=True)
    printed = subprocess.run([sys.executable, example / "recompute.py", scene, picture, *options],
                             check=True, stdout=subprocess.PIPE, text=True).stdout
    print(printed)
    rows = [line.split() for line in printed.splitlines() if line.split()[1] in ("red", "green", "blue")]
    return {(row[0], row[1]): (float(row[-2]), float(row[-1])) for row in rows}


def check(name, rows):
    expected = {(material, light) for material in ("matte", "plastic", "gloss", "metal")
                for light in ("red", "green", "blue")}
    if rows.keys() != expected:
        failures.append(f"{name}: the table has rows for {sorted(rows)}")
    for (material, light), (relative, share) in rows.items():
        if share > LOBE or material == "matte" and relative > DIFFUSE:
            failures.append(f"{name}, {material}, {light}: off by {relative} of a pixel, {share} of the brightest")


with tempfile.TemporaryDirectory() as folder:
    text = (example / "scene.json").read_text(encoding="utf-8")
    other = pathlib.Path(folder) / "other.json"
    other.write_text(text.replace('21, "layers": [0]', '21, "layers": [1]'), encoding="utf-8")
    check("layer 0", table(example / "scene.json", f"{folder}/sum.pfm", []))
    check("layer 1", table(other, f"{folder}/conserving.pfm", CONSERVING))
print("\n".join(failures) or "the formulas agree with the pictures")
sys.exit(1 if failures else 0)
