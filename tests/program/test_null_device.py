#!/usr/bin/env python3
# SPDX-License-Identifier: Apache-2.0
"""Runs the program on the null device of Mesa's driver for AMD GPUs, which compiles and does nothing else:
what draws is refused in one sentence, and the pipelines of the engine stay below the committed record
(tools/gpu_stats). Exits with 77 (skipped) where the driver is missing or has another version.
Usage: test_null_device.py PROGRAM REPOSITORY; with CANDELABRA_FULL_TESTS=1 all pipelines for all GPUs"""
import glob
import json
import os
import pathlib
import re
import subprocess
import sys
import tempfile

sys.dont_write_bytecode = True  # the sources may be read-only
program, root = sys.argv[1], pathlib.Path(sys.argv[2]).resolve()
RECORD = root / "tools/bench/results/pipelines-radv.csv"
failures = []


def require(holds, what):
    if not holds:
        failures.append(what)


def run(*arguments):
    return subprocess.run([str(a) for a in arguments], capture_output=True, text=True, env=environment)


def add_keys(value, path, found):
    """Adds the keys of all objects in a value, as tests/harness/json_keys.h does."""
    if isinstance(value, list):
        for element in value:
            add_keys(element, f"{path}[]", found)
    elif isinstance(value, dict):
        found.setdefault(path, set()).update(value)
        for key, member in value.items():
            add_keys(member, f"{path}.{key}", found)


def gpu_stats(*arguments):
    outcome = run(sys.executable, root / "tools/gpu_stats", "--program", program, *arguments)
    print(outcome.stdout + outcome.stderr, end="")
    return outcome


drivers = glob.glob("/usr/share/vulkan/icd.d/radeon_icd*.json")
if not drivers:
    print("RADV is not installed (Debian package mesa-vulkan-drivers): nothing was tested")
    sys.exit(77)
environment = dict(os.environ, VK_ICD_FILENAMES=drivers[0], RADV_FORCE_FAMILY="NAVI21", RADV_DEBUG="nocache")

with tempfile.TemporaryDirectory() as folder:
    for command in (["render", "hall", "--lights", "10", "-o", f"{folder}/a.png"], ["profile", "hall"],
                    ["bench", "skip", "--out", folder]):
        drawn = run(program, *command)
        require(drawn.returncode == 1 and drawn.stderr.count("\n") == 1 and
                "lacks: memory that the CPU can write" in drawn.stderr,
                f"{' '.join(command)} on the null device: exit code {drawn.returncode}, {drawn.stderr!r}")

    for arguments, word in ((["--kernels", "no_such"], "no pipeline"), (["--types", "moon"], "moon"),
                            (["--methods", "phong"], "phong")):
        refused = run(program, "bench", "pipelines", *arguments)
        require(refused.returncode == 2 and word in refused.stderr, f"{arguments}: {refused.stderr!r}")

    chosen = ["--kernels", "cluster_lists,tone_map"]
    shown = run(program, "bench", "pipelines", *chosen, "--all-statistics", "--json", "-")
    require(shown.returncode == 0, shown.stderr)
    data = json.loads(shown.stdout)
    for row in data["pipelines"]:
        row["others"] = sorted(row["others"])  # what drivers call their other measures
    found = {}
    add_keys(data, "bench-pipelines", found)
    listed = {line for line in (root / "tests/data/json_keys.txt").read_text(encoding="utf-8").split("\n")
              if line.startswith("bench-pipelines")}
    lines = {f"{path}: {' '.join(sorted(keys))}" for path, keys in found.items()}
    require(lines == listed, f"keys: {lines ^ listed}")
    require({p["kernel"] for p in data["pipelines"]} == {"cluster_lists", "tone_map"} and
            {p["variant"] for p in data["pipelines"]} >= {"aces", "neutral"},
            "--kernels does not choose the kernels")
    require(all(p["vectorRegisters"] and p["instructions"] and p["others"] for p in data["pipelines"]),
            "a measure of RADV was not found")
    of_shadows = run(program, "bench", "pipelines", "--kernels", "ask_pairs", "--shadows", "32", "--json", "-")
    require(of_shadows.returncode == 0 and json.loads(of_shadows.stdout)["shadows"] == "32" and
            len(json.loads(of_shadows.stdout)["pipelines"]) == 1, f"--shadows: {of_shadows}")
    table = run(program, "bench", "pipelines", *chosen)
    require("tone_map, aces" in table.stdout, table.stdout)

    # A rise fails, and what falls does not.
    lines = RECORD.read_text(encoding="utf-8").splitlines()
    first = next(i for i, line in enumerate(lines) if line.startswith("cluster_lists,"))
    name, registers, rest = re.fullmatch(r"(\w+,)(\d+)(,.*)", lines[first]).groups()  # of navi21-wave32
    for change, code, said in ((-8, 1, "vectorRegisters rose"), (8, 0, "fell below the record")):
        planted = [*lines[:first], f"{name}{int(registers) + change}{rest}", *lines[first + 1:]]
        path = pathlib.Path(folder) / "record.csv"
        path.write_text("\n".join(planted) + "\n", encoding="utf-8")
        outcome = gpu_stats("--gpus", "navi21-wave32", "--kernels", "cluster_lists", "--record", path)
        if outcome.returncode == 77:
            sys.exit(77)
        require(outcome.returncode == code and said in outcome.stdout, f"a change by {change} gives {outcome}")

full = os.environ.get("CANDELABRA_FULL_TESTS") == "1"
# The default run compiles shade_tiles and pair_visibility for all types of light, and the other kernels for spheres.
for chosen in [[]] if full else [["--kernels", "shade_tiles,pair_visibility"], ["--types", "sphere"]]:
    outcome = gpu_stats(*chosen, *([] if full else ["--gpus", "navi21-wave32", "--no-classes", "--methods", "conic"]))
    require(outcome.returncode == 0, f"the pipelines are not those of the record: {chosen}")
print("\n".join(failures) or "the null device compiles, and refuses to draw")
sys.exit(1 if failures else 0)
