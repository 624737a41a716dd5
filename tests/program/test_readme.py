#!/usr/bin/env python3
# SPDX-License-Identifier: Apache-2.0
"""Runs every command of README.md as it is written there, in an empty folder, only smaller: options for that
are appended. A command that this test does not know is a fault. Then renders the example of SCENE_JSON.md.
Usage: test_readme.py PROGRAM REPOSITORY; with CANDELABRA_FULL_TESTS=1 pictures have their shadows"""
import os
import pathlib
import re
import shlex
import subprocess
import sys
import tempfile
import time

program, root = pathlib.Path(sys.argv[1]).resolve(), pathlib.Path(sys.argv[2]).resolve()
device = os.environ.get("CANDELABRA_TEST_DEVICE")
FRAME = "--size 64x36"
SHADOWS = "" if os.environ.get("CANDELABRA_FULL_TESTS") == "1" else "--shadows off"
# By command and its part: what makes it small. "device" in front: the command takes a --device.
SMALLER = {
    "examples": "", "help": "", "devices": "", "truth": "--size 16x9 --tolerance 1e-2 --lights 200",
    "render": f"device {FRAME} {SHADOWS}", "view": f"device {FRAME} {SHADOWS} --frames 2",
    "profile": f"device {FRAME} --frames 6", "report": "device --parts profile --lights 50 --size 64x36 --frames 2",
    "bench culling": f"device --scenes hall --overlaps 8 {FRAME} --rounds 1",
}
# Commands that build, install or test, with where they are run instead.
ELSEWHERE = {
    "git clone": "every machine that tests has the repository", "tools/test": "it runs this test",
}
NO_GPU_TO_COMPILE_FOR = 77  # tools/gpu_stats: the driver that it compiles with is not installed
failures = []


def commands_of_readme():
    """The command lines in README's listings, without comments, and the program's commands in its sentences."""
    text = (root / "README.md").read_text(encoding="utf-8")
    listings = re.findall(r"^```\n(.*?)^```$", text, re.DOTALL | re.MULTILINE)
    listed = [line.split("#")[0].strip() for listing in listings for line in listing.splitlines()]
    quoted = [quote.replace("\n", " ") for quote in re.findall(r"`(candelabra [^`]+)`", text)]
    return list(dict.fromkeys([*filter(None, listed), *quoted]))


def run(command, folder, environment, allowed=(0,)):
    start = time.monotonic()
    done = subprocess.run(["bash", "-euc", command], cwd=folder, env=environment, text=True, errors="replace",
                          stdin=subprocess.DEVNULL, stdout=subprocess.PIPE, stderr=subprocess.STDOUT)
    print(f"{time.monotonic() - start:5.1f} s  {command}", flush=True)
    if done.returncode not in allowed:
        failures.append(f"{command}: ended with {done.returncode}: {done.stdout[-2000:]}")
    for place in re.findall(r" -o (\S+)", command):
        if not (folder / place).is_file():
            failures.append(f"{command}: wrote no {place}")


def smaller(command):
    """The command with the options that make it small, or None if it is not in the table."""
    words = shlex.split(command)
    options = SMALLER.get(" ".join(words[1:3]), SMALLER.get(words[1]))
    if options is None or "--help" in words:
        return options and command
    if "--pick" in words:  # the pixel is one of the image in its full size
        options = options.replace(FRAME, "--lights 20")
    if options.startswith("device"):
        options = options[len("device"):] + (f" --device {shlex.quote(device)}" if device else "")
    return f"{'xvfb-run -a ' if words[1] == 'view' else ''}{command} {options}"


def main(folder):
    (folder / "bin").mkdir()
    (folder / "bin/candelabra").symlink_to(program)
    # tools/demo runs as it is, but what it would build is this build.
    (folder / "bin/cmake").write_text("#!/bin/sh\nexit 0\n")
    (folder / "bin/cmake").chmod(0o755)
    empty = folder / "empty"
    empty.mkdir()
    (empty / "tools").symlink_to(root / "tools")
    environment = os.environ | {"PATH": f"{folder / 'bin'}:{os.environ['PATH']}", "CANDELABRA_BUILD": str(folder)}
    environment.pop("DISPLAY", None)
    known = 0
    for command in commands_of_readme():
        elsewhere = [why for start, why in ELSEWHERE.items() if command.startswith(start)]
        if elsewhere:
            print(f"         {command}: not run, {elsewhere[0]}")
        elif command == "tools/demo":
            run(f"{command} --lights 20 --size 64x36 --frames 1", empty, environment)
        elif command == "tools/gpu_stats":
            run(f"{command} --program {shlex.quote(str(program))} --kernels tone_map --gpus navi21-wave32", empty, environment,
                allowed=(0, NO_GPU_TO_COMPILE_FOR))
        elif command.startswith("candelabra ") and smaller(command):
            run(smaller(command), empty, environment)
        else:
            failures.append(f"{command}: this test does not know how to make it small")
        known += not elsewhere
    listing = re.search(r"^```json\n(.*?)^```$", (root / "tools/SCENE_JSON.md").read_text(encoding="utf-8"),
                        re.DOTALL | re.MULTILINE)
    (empty / "two_balls.json").write_text(listing[1], encoding="utf-8")
    run(smaller("candelabra render two_balls.json -o two_balls.png"), empty, environment)
    if known < 10:
        failures.append(f"README lists only {known} commands")


with tempfile.TemporaryDirectory(prefix="candelabra_readme_") as place:
    main(pathlib.Path(place))
print("\n".join(failures) or "every command of README.md runs")
sys.exit(1 if failures else 0)
