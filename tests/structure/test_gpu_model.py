#!/usr/bin/env python3
# SPDX-License-Identifier: Apache-2.0
"""The predictions of tools/gpu_model follow from its model: on a GPU that is simple enough to compute by hand,
and with the committed assumptions, which must name what the records hold. Usage: test_gpu_model.py REPOSITORY"""
import importlib.machinery
import importlib.util
import json
import pathlib
import sys
import tempfile

sys.dont_write_bytecode = True  # the sources may be read-only
root = pathlib.Path(sys.argv[1]).resolve()
loader = importlib.machinery.SourceFileLoader("gpu_model", str(root / "tools/gpu_model"))
gpu_model = importlib.util.module_from_spec(importlib.util.spec_from_loader("gpu_model", loader))
loader.exec_module(gpu_model)
failures = []


def require(holds, what):
    if not holds:
        failures.append(what)


def near(value, expected, what):
    require(abs(value - expected) < 1e-9 * max(1, abs(expected)), f"{what}: {value}, expected {expected}")


# One multiprocessor at 1 GHz, so that 1000 cycles are a microsecond. It holds two subgroups of a kernel with
# 32 registers, and issues one instruction every second cycle.
MODEL = {"gpus": {"toy": {"match": "Toy", "multiprocessors": 1, "issuesPerCycle": 1, "ghz": 1,
                          "gigabytesPerSecond": 1, "subgroups": 8, "registers": 2048, "code": "c"},
                  "simds": {"match": "-", "multiprocessors": 2, "issuesPerCycle": 2, "ghz": 1,
                            "gigabytesPerSecond": 1, "simds": 3, "code": "c"}},
         "stepCycles": {"low": 50, "expected": 100, "high": 200}, "issueShare": {"expected": 0.5},
         "instructions": {"cluster_lists": {"light tests": 10}, "shade_tiles": {"light tests": 10, "near it": 50}},
         "waits": {"cluster_lists": {"light tests": 3}, "shade_tiles": {"near it": 1}},
         "chainCycles": {"expected": 2}, "bytes": {"shade_tiles": 0},
         "steps": {"about": "", "tile_clusters": {"steps": 3, "lanesPer": "tile", "lanes": 2}},
         "dispatch": {"microseconds": 7, "count": {"tile_clusters": 1, "shade_unlisted": 1}}}
PIPELINES = {"measures": ["vectorRegisters", "subgroupsPerSimd"],
             "gpus": {"c": {"cluster_lists": [29, 4], "shade_tiles, sphere conic": [64, 1], "tile_clusters": [8, 9]}}}


def loop(name, slots32, longest):
    return {"name": name, "slots32": slots32, "longestWave32": longest}


LANES = {"widthPixels": 10, "heightPixels": 10,
         "points": [{"scene": "hall", "lights": 5, "tiles": 16, "splitTiles": 0,
                     "dispatches": [{"name": "cluster_lists, tiles", "loops": [loop("light tests", 320, 4)]},
                                    {"name": "shade_tiles", "loops": [loop("near it", 64, 1)]}]}]}


def toys_are_computed_by_hand():
    gpu = gpu_model.Gpu("toy", MODEL, PIPELINES)
    near(gpu.resident("cluster_lists"), 2, "subgroups that fit by registers, in units of 8")
    near(gpu.resident("tile_clusters"), 8, "subgroups that fit at most")
    near(gpu_model.Gpu("simds", MODEL, PIPELINES).resident("cluster_lists"), 2 * 3 * 4, "subgroups by SIMD")
    found = gpu_model.predict(gpu, LANES, LANES["points"][0], 100)
    # 10 turns of subgroups at 3 * 100 + 2 * 10 cycles, two at a time, then the longest with 4; issuing takes only
    # 200 cycles.
    near(found["cluster_lists"], (10 * 320 / 2 + 4 * 320) / 1e3 + 7, "lists")
    # 2 turns at 100 + 2 * 50 cycles, one at a time, and the longest.
    near(found["shade_tiles"], (2 * 200 + 200) / 1e3, "shading")
    # 32 lanes are one subgroup of 3 steps, of 8 that fit.
    near(found["tile_clusters"], (300 / 8 + 300) / 1e3 + 7, "bounds")
    near(found["shade_unlisted"], 7, "a dispatch without work")
    require(gpu_model.total(gpu_model.predict(gpu, LANES, LANES["points"][0], 50)) < gpu_model.total(found),
            "shorter steps do not take less time")
    # Reading 1e6 bytes takes 1000 us at 1 GB/s, issuing 600 instructions 1.2 us.
    near(gpu_model.bounded(gpu, "cluster_lists", 0, 0, 0, 1e6), 1000, "memory")
    near(gpu_model.bounded(gpu, "cluster_lists", 0, 600, 0), 1.2, "arithmetic")


def measurements_stand_beside_predictions():
    profile = {"provenance": {"device": "A Toy GPU"}, "image": {"widthPixels": 10, "heightPixels": 10},
               "scene": {"name": "hall", "lights": 5},
               "variants": [{"time": {"upload": {"medianMs": 0}, "passes": [{"name": "cluster_lists", "medianMs": 3},
                                                 {"name": "tone_map", "medianMs": 99}]}}]}
    with tempfile.TemporaryDirectory() as folder:
        path = pathlib.Path(folder) / "profile.json"

        def lighting(content, gpu="toy"):
            path.write_text(json.dumps(content))
            return next(gpu_model.rows(gpu_model.Gpu(gpu, MODEL, PIPELINES), LANES, [path]))[4]

        predicted = lighting([])
        require(lighting(profile) == f"{predicted} (3.00)", f"a measurement is not shown: {lighting(profile)}")
        require(lighting([profile]) == f"{predicted} (3.00)", "a measurement of several is not shown")
        require("(" not in lighting(profile, "simds"), "a measurement of another GPU is shown")
        wider, moving = json.loads(json.dumps([profile, profile]))
        wider["image"]["widthPixels"] = 11
        moving["variants"][0]["time"]["upload"]["medianMs"] = 1
        require(lighting([wider, moving]) == predicted, "a measurement of another size or of moving lights is shown")


def committed_records_fit_the_model():
    model, lanes = gpu_model.load(gpu_model.model_file), gpu_model.load(gpu_model.lanes_file)
    pipelines = gpu_model.load(gpu_model.pipelines_file)
    for name in model["gpus"]:
        for row in gpu_model.rows(gpu_model.Gpu(name, model, pipelines), lanes, []):
            require(float(row[4]) > 0, f"{name}: {row}")


toys_are_computed_by_hand()
measurements_stand_beside_predictions()
committed_records_fit_the_model()
print("\n".join(failures) or "the predictions follow from the model")
sys.exit(1 if failures else 0)
