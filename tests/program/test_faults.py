#!/usr/bin/env python3
# SPDX-License-Identifier: Apache-2.0
"""Tests faults around the program as a table of cases: malformed values of every option of every command,
files that cannot be read or written, full disks, signals at random times. Each case must end with its
exit code and one sentence on stderr, and must leave neither partial nor temporary files.

Usage: test_faults.py PROGRAM DATA [GROUP...]; the groups are options, files, disk and signals. Unless
CANDELABRA_FULL_TESTS=1, the last two groups run only cases that need no GPU, and only few signals."""
import contextlib
import json
import os
import pathlib
import random
import re
import resource
import shutil
import signal
import subprocess
import sys
import tempfile
import time

program, data = pathlib.Path(sys.argv[1]).resolve(), pathlib.Path(sys.argv[2]).resolve()
groups = sys.argv[3:] or ["options", "files", "disk", "signals"]
full = os.environ.get("CANDELABRA_FULL_TESTS") == "1"
device = os.environ.get("CANDELABRA_TEST_DEVICE")
USAGE, FAILED = 2, 1
failures, count = [], 0
caches = tempfile.TemporaryDirectory(prefix="candelabra_faults_")  # of all runs


def environment(**more):
    kept = {k: v for k, v in os.environ.items() if k not in ("DISPLAY", "WAYLAND_DISPLAY")}
    return kept | {"XDG_CACHE_HOME": caches.name, "MESA_SHADER_CACHE_DIR": caches.name} | more


def start(arguments, folder, executable=(program,), **options):
    if device and arguments and arguments[0] not in (
            "compare", "diff", "truth", "devices", "help", "examples") and "--device" not in arguments:
        arguments = [*arguments, "--device", device]
    options = {"stdout": subprocess.PIPE, "env": environment()} | options
    return subprocess.Popen([*executable, *arguments], cwd=folder, stdin=subprocess.DEVNULL,
                            stderr=subprocess.PIPE, text=True, errors="replace", **options)


def fault(what, why):
    failures.append(f"{what}: {why}")


def contents(path):
    """Returns the bytes of a file, or its size and time of change if this user may not read it."""
    try:
        return path.read_bytes()
    except PermissionError:
        status = path.stat()
        return f"{status.st_size} bytes of {status.st_mtime_ns}".encode()


def left(folder):
    """Every file below the folder, with its content."""
    return {str(p.relative_to(folder)): contents(p) for p in pathlib.Path(folder).rglob("*")
            if p.is_file() and not p.is_symlink()}


def refused(arguments, code, named, folder, timeout=120, may_change=(), **options):
    """Ends with `code` and one sentence that has `named` in it; the files in `folder` stay as they are."""
    global count
    count += 1
    what = " ".join(arguments)
    before = left(folder)
    process = start(arguments, folder, **options)
    try:
        out, err = process.communicate(timeout=timeout)
    except subprocess.TimeoutExpired:
        process.kill()
        process.communicate()
        return fault(what, f"still runs after {timeout} s")
    if process.returncode != code:
        fault(what, f"ended with {process.returncode} and not {code}: {err.strip()}")
    elif not re.fullmatch(r"candelabra: [^\n]+\n", err):
        fault(what, f"said this and not one sentence: {err!r}")
    elif named not in err:
        fault(what, f"does not name {named!r}: {err.strip()}")
    if out and options.get("stdout", subprocess.PIPE) == subprocess.PIPE and code == USAGE:
        fault(what, f"printed {out[:80]!r}")
    after = left(folder)
    changed = {n for n in before.keys() | after.keys() if before.get(n) != after.get(n)}
    wrong = {n for n in changed if not any(re.fullmatch(p, n) for p in may_change)}
    if wrong:
        fault(what, f"left or changed {sorted(wrong)}")


# ---- options ----------------------------------------------------------------------------------

SIZES = ["wide", "0x8", "8x", "8x8x8", "16385x1", "-8x8", "1e3x8"]
COUNTS = ["many", "-1", "1.5", "0x10", "99999999999", " 5", "5 "]
NUMBERS = ["x", "nan", "inf", "1e999", "1,5"]
NAMES = ["nonsense", "CONIC2"]
PLACES = ["no/such/folder/x.json", ".", "/dev/null"]

# By option: the values that every command must refuse. Values that are refused only once the scene
# or the device is known are listed too: nothing has been drawn by then.
BAD = {
    "--lights": COUNTS, "--seed": COUNTS, "--samples": [*COUNTS, "0", "4097"],
    "--frames": [*COUNTS, "0"], "--aa": [*COUNTS, "0", "4097"], "--fps": [*NUMBERS, "0"], "--overlaps": [*NUMBERS, "0", "-1"],
    "--size": SIZES, "--camera": ["nowhere", "99", "1,2", "0,0,0,0,0,0", "0,0,0,0,0,-1,200", "0,0,0,0,nan,1"],
    "--lights-visible": NAMES, "--exposure": ["bright", "41", "nan"], "--compensation": [*NUMBERS, "21"],
    "--metering": NAMES, "--tonemap": NAMES, "--specular": NAMES, "--gbuffer": NAMES,
    "--culling": NAMES, "--reuse": NAMES, "--debug": NAMES, "--lobes": NAMES, "--energy-compensation": NAMES,
    "--influence": NAMES,
    "--influence-error": [*NUMBERS, "0", "1.1", "1/0"], "--time": NUMBERS,
    "--punctual-radius": [*NUMBERS, "0"], "--sun-radius": [*NUMBERS, "0", "2"],
    "--environment": ["no_such.hdr", "sky.png", "folder.hdr", "empty.exr", "noise.pfm"],
    "--environment-rotation": [*NUMBERS, "361"], "--environment-scale": [*NUMBERS, "-1"],
    "--environment-illuminance": [*NUMBERS, "-1", "0"], "--default-light": NAMES, "--fit": NAMES,
    "--middle-grey": [*NUMBERS, "0", "1.1"], "--bloom": [*NUMBERS, "-0.1", "1.1"],
    "--committed": ["no/such/folder", "file.txt"],
    "--device": ["99", "no such device"], "--json": PLACES, "--csv": PLACES,
    "--out": ["file.txt", "/dev/null/x", "file.txt/x"],
    "--pick": ["4", "8,0", "0,8", "a,b", "-1,0", "1,2,3"],
    "--output": ["x.bmp", "x", "no/such/x.png", "/dev/full", "folder.png"],
    "--path": NAMES, "--check": NAMES, "--light-costs": COUNTS, "--what-if": ["reach=0.5", "influence=0", "method=phong"],
    "--rounds": [*COUNTS, "0"],
    "--brute-limit": [*NUMBERS, "-1"], "--groups": [*COUNTS, "0"],
    "--configs": [*NUMBERS, "-1", "0.5"], "--quadrature": [*NUMBERS, "-1"],
    "--sweeps": [*COUNTS], "--parts": ["everything", "profile,,culling", ","],
    "--scenes": ["village", "hall,village", ","], "--tolerance": [*NUMBERS, "-1"],
    "--lod": NAMES, "--cull-triangles": NAMES, "--warm-up": [*NUMBERS, "-1"], "--frames-in-flight": [*COUNTS, "0"],
    "--shadows": [*NAMES, "16"], "--shadow-seed": COUNTS, "--pixels": [*COUNTS, "0"],
    "--threads": [*COUNTS, "0"], "--shard": ["3/2", "0/2", "2", "1/0", "a/b", "1/2/3"],
    "--screenshot": ["x.jpg", "no/such/x.png"], "--while-moving": NAMES,
    "--merge": ["no_such.truth", "empty.truth", "noise.truth", "folder.truth"],
    "--scene": ["village", "no_such.glb", "empty.json", "folder.json"],
    "--types": NAMES, "--light-types": NAMES, "--methods": NAMES,
    "--max-relmse": [*NUMBERS, "-1"], "--pass": NAMES, "--fail-above": [*NUMBERS, "-1"],
    "--a": ["no_such.json", "empty.json", "noise.json"], "--b": ["no_such.json"],
}
# Exceptions by command and option. None: tested only together with other options, under
# COMBINATIONS below.
BAD_OF = {
    ("compare", "--json"): ["no/such/folder/x.json", "."], ("devices", "--json"): ["=maybe"],
    ("truth", "--output"): ["x.png", "x", "no/such/x.exr", "folder.exr"],
    ("diff", "--output"): ["x.exr", "x", "no/such/x.png", "folder.png", "/dev/full"],
    ("profile", "--ab"): None, ("truth", "--merge"): None,
    ("view", "--frames"): COUNTS, ("bench skip", "--scene"): ["village"],
    ("compare", "--a"): None, ("compare", "--b"): None,
    ("bench culling", "--lights"): [*COUNTS, "0", "1,,2"], ("bench culling", "--size"): [*SIZES, "8x8,"],
    ("bench pipelines", "--kernels"): None,  # tests/program/test_null_device.py
    ("bench culling", "--overlaps"): COUNTS, ("stress", "--lights"): [*COUNTS, "5,5", "5,,6"],
}
# The arguments before the option under test. Where the option is given twice, the `{}` of its first
# use is left out.
BASE = {
    "render": ["render", "hall", "--lights=5", "--size=8x8", "--output=x.png"],
    "stress": ["stress", "--lights=5", "--size=8x8", "--out=o", "-q"],
    "profile": ["profile", "hall", "--lights=5", "--size=8x8", "--frames=6"],
    "compare": ["compare", "run.json", "run.json"], "diff": ["diff", "dot.pfm", "dot.pfm"],
    "report": ["report", "--parts=profile", "--lights=5", "--size=8x8", "--out=o"],
    "view": ["view", "--scene=hall", "--lights=5", "--size=64x64", "--frames=1"],
    "truth": ["truth", "scene.json", "--size=4x4", "--output=x.exr"],
    "bench accuracy": ["bench", "accuracy", "--groups=10", "--size=8x8", "--out=o", "-q"],
    "bench culling": ["bench", "culling", "--scenes=hall", "--lights=5", "--size=8x8", "--out=o"],
    "bench pipelines": ["bench", "pipelines"],
    "bench skip": ["bench", "skip", "--lights=5", "--size=8x8", "--out=o"],
    "bench visibility": ["bench", "visibility", "hall", "--lights=5", "--size=8x8", "--pixels=1", "--rounds=1", "--out=o"],
    "bench stability": ["bench", "stability", "--configs=1000", "--out=o"],
    "devices": ["devices"], "help": ["help"], "examples": ["examples", "o"],
}
# Command lines that are wrong only as a whole; each single option is right.
COMBINATIONS = [
    ([], "no command"), (["paint"], "paint"), (["bench"], "no command of bench"), (["bench", "speed"], "speed"), (["bench", "skip", "hall"], "hall"),
    (["render"], "scene"), (["render", "hall"], "nothing to write"), (["render", "village", "-o", "x.png"], "village"),
    (["render", "hall", "more", "-o", "x.png"], "more"),
    (["render", "hall", "-o", "x.png", "-o", "./x.png"], "twice"), (["render", "hall", "-o"], "-o"),
    (["render", "hall", "-o", "x.png", "--json", "./x.png"], "--json"), (["render", "hall", "--lights"], "--lights"),
    (["render", "hall", "-o", "x.png", "--camera="], "--camera="), (["render", "hall", "-o", "x.png", "--lights", ""], "--lights"),
    (["render", "hall", "--pick", "1,1", "--specular", "sampled"], "--pick"), (["render", "hall", "-o", "x.png", "--frob"], "--frob"),
    (["render", "hall", "-o", "x.png", "--seed", "1", "--seed", "2"], "--seed"),
    (["render", "hall", "-o", "x.png", "--debug", "class", "--culling", "brute"], "--debug"),
    (["render", "hall", "--shard", "1/2", "-o", "x.png"], "f.%04d.png"),
    (["render", "hall", "--frames", "2", "--exposure", "9", "--shard", "1/3", "-o", "f.%d.png"], "fewer"),
    (["render", "hall", "--lights", "5", "--frames", "2", "--shard", "1/2", "-o", "f.%d.png"], "--exposure"),
    (["render", "hall", "--frames", "2", "--shard", "1/2", "-o", "f.%d.png", "--influence-error", "0.01"], "--influence-error"),
    (["render", "hall", "--pick", "1,1", "--influence", "uncut"], "--pick"),
    (["profile", "hall", "--light-costs", "5", "--influence-error", "0.5/255"], "--light-costs"),
    (["view", "hall", "--screenshot", "x.png"], "--frames"), (["view", "hall"], "display"),
    (["profile", "hall", "--ab", ""], "--ab"), (["profile", "hall", "--ab", "--specular foo", ""], "--specular"),
    (["profile", "hall", "--ab", "", "--size 8x8"], "--ab"), (["profile", "hall", "--ab", "", "", "--frames", "5"], "--ab"),
    (["profile", "hall", "--append"], "--append"), (["profile", "hall", "--json", "p", "--csv", "p"], "--csv"),
    (["profile", "hall", "--json", "noise.json", "--append"], "noise.json"),
    (["truth"], "-o"), (["truth", "-o", "x.exr"], "SCENE"),
    (["truth", "scene.json", "--merge", "a", "-o", "x.exr"], "--merge"), (["truth", "--merge", "no_such.truth", "-o", "x.exr"], "no_such.truth"),
    (["truth", "--merge", "noise.truth", "-o", "x.exr"], "noise.truth"), (["truth", "--merge", "empty.truth", "-o", "x.exr"], "empty.truth"),
    (["truth", "hall", "--pixels", "5", "-o", "x.hdr"], "NaN"), (["truth", "scene.json", "-o", "scene.json"], "scene.json"),
    (["render", "hall", "-o", "x.png", "--light", "100"], "did you mean --lights?"), (["help", "rendr"], "did you mean render?"),
    (["render", "hall", "-o", "f.%04d.png"], "--frames"), (["render", "hall", "--frames", "2", "-o", "%d%d.png"], "two places"),
    (["render", "hall", "--frames", "2", "-o", "%d.png", "-o", "x.png"], "x.png"),
    (["render", "hall", "-o", "x.png", "--aa", "2", "--debug", "class"], "--aa"),
    (["render", "hall", "--frames", "2", "-o", "f.%4d.png"], "%04d"),
    (["render", "hall", "-o", "x.png", "--aa", "2", "--influence-error", "0.5/255"], "--aa"),
    (["render", "hall", "-o", "x.png", "--aa", "2", "--edge-filter"], "--aa"),
    (["render", "hall", "-o", "x.png", "--edge-filter", "--debug", "class"], "--edge-filter"),
    (["render", "hall", "-o", "x.png", "--bloom", "0.1", "--debug", "class"], "--bloom"),
    (["render", "hall", "-o", "x.png", "--bloom", "0.1", "--influence-error", "1/255"], "--bloom"),
    (["stress", "--fps", "60", "--lights", "9"], "--lights"), (["stress", "--fps", "60", "--check", "none"], "--check"),
    (["examples", "."], "--replace"), (["examples", "no/such"], "no/such"),
    (["compare"], "A"), (["compare", "run.json"], "B"),
    (["compare", "--a", "run.json"], "B"), (["compare", "--a", "no_such.json", "--b", "run.json"], "no_such.json"),
    (["diff"], "A"), (["diff", "dot.pfm", "noise.pfm"], "noise.pfm"), (["diff", "sky.png", "dot.pfm"], "sky.png"),
    (["diff", "dot.pfm", "no_such.exr"], "no_such.exr"), (["diff", "sky.png", "sky.png"], "sky.png"),
    (["diff", "dot.pfm", "dot.pfm", "--json", "dot.pfm"], "dot.pfm"), (["compare", "sky.png", "run.json"], "sky.png"),
    (["compare", "run.json", "noise.json"], "noise.json"), (["compare", "run.json", "other.json"], "other.json"),
]


def furnish(folder):
    """Files to trip over."""
    (folder / "file.txt").write_text("here\n")
    for extension in ("json", "hdr", "exr", "png", "glb", "gltf", "truth"):
        (folder / f"folder.{extension}").mkdir()
    for extension in ("json", "exr", "hdr", "pfm", "glb", "gltf", "truth"):
        (folder / f"empty.{extension}").write_bytes(b"")
        (folder / f"noise.{extension}").write_bytes(random.Random(extension).randbytes(999))
    (folder / "dot.pfm").write_bytes(b"Pf\n1 1\n-1.0\n" + b"\0" * 4)
    (folder / "sky.png").write_bytes(b"\x89PNG\r\n\x1a\n")
    shutil.copy(data / "every_light.json", folder / "scene.json")
    passes = [{"name": "shade_tiles", "minMs": 12, "medianMs": 12.5}]
    figures = {"frames": 60, "passes": passes} | {n: {"minMs": 4, "medianMs": 5} for n in ("gpu", "record", "frame", "upload")}
    run = {"schema": "candelabra profile 1", "provenance": {"device": "d", "driver": "e", "commit": "c"},
           "scene": {"name": "hall"}, "image": {"widthPixels": 64}, "path": "still",
           "variants": [{"settings": {"specular": "conic"}, "time": figures}]}
    (folder / "run.json").write_text(json.dumps(run))
    (folder / "other.json").write_text(json.dumps(run | {"schema": "candelabra profile 999"}))


def options_of_commands():
    """"render" -> ["--seed", ...]: long names, and whether they take values, of the program's own lists."""
    found = {}

    def add(words):
        text = subprocess.run([program, *words, "--help"], capture_output=True, text=True, check=True).stdout
        parts = re.findall(r"^  ([a-z]+) ", text.partition("Subcommands:\n")[2].partition("\n\n")[0], re.MULTILINE)
        for part in parts:
            if part not in ("help", "options"):  # these print help and run nothing
                add([*words, part])
        if not parts:
            shared = re.search(r"\nShared options[^:]*:\n(.*?)\n\n", text, re.DOTALL)
            options = re.findall(r"^  (?:-\w,)?(--[\w-]+)( \S)?", text, re.MULTILINE)
            options += re.findall(r"(--[\w-]+)( \S)?", shared[1] if shared else "")
            found[" ".join(words)] = [(name, bool(value)) for name, value in options if name != "--help"]

    add([])
    return found


@contextlib.contextmanager
def display():
    """For `view`, which looks for a display before it reads the scene."""
    read, write = os.pipe()
    server = subprocess.Popen(["Xvfb", "-displayfd", str(write), "-nolisten", "tcp"], pass_fds=[write],
                              stderr=subprocess.DEVNULL)
    os.close(write)
    try:
        yield ":" + os.read(read, 16).decode().strip()
    finally:
        os.close(read)
        server.terminate()
        server.wait()


def test_options(folder):
    furnish(folder)
    for arguments, named in COMBINATIONS:
        refused(arguments, USAGE, named, folder)
    with display() as name:
        for command, options in options_of_commands().items():
            for option, takes_value in options:
                flag = BAD_OF.get((command, option), BAD.get(option)) if takes_value else ["=maybe"]
                if (command, option) in BAD_OF and BAD_OF[command, option] is None:
                    continue
                if not flag:
                    fault(f"{command} {option}", "is not in the table of this test")
                    continue
                base = [a for a in BASE[command] if not a.startswith(option + "=")]
                values = flag if full else flag[:1]
                for value in values:
                    given = [option + value] if value.startswith("=") else [option, value]
                    environ = environment(DISPLAY=name) if command == "view" else environment()
                    shown = "-o" if option == "--output" else option
                    # For files and places the sentence must contain the given name instead of the
                    # option's.
                    named = value if option in ("--environment", "--scene") else shown
                    named = "size" if option == "--size" and value == "16385x1" else named
                    refused([*base, *given], USAGE, named, folder, env=environ, may_change=[r"o/.*"])


# ---- files ------------------------------------------------------------------------------------

def test_files(folder):
    furnish(folder)
    os.mkfifo(folder / "pipe.json")
    os.mkfifo(folder / "pipe.glb")
    os.mkfifo(folder / "pipe.hdr")
    os.mkfifo(folder / "pipe.truth")
    (folder / "loop.json").symlink_to("loop.json")
    (folder / "nowhere.png").symlink_to("no/such/x.png")
    for name in ("no_such.json", "no_such.glb", "folder.json", "folder.glb", "empty.json", "empty.glb",
                 "empty.gltf", "noise.json", "noise.glb", "noise.gltf", "pipe.json", "pipe.glb", "loop.json",
                 "file.txt", "/dev/null", "no_such"):
        refused(["render", name, "-o", "x.png"], USAGE, name, folder, timeout=20)
    for name in ("pipe.hdr", "noise.hdr", "noise.exr", "empty.hdr", "empty.pfm", "folder.exr"):
        refused(["render", "hall", "--lights", "2", "--environment", name, "-o", "x.png"], USAGE, name,
                folder, timeout=20)
    for name in ("pipe.truth", "folder.truth", "noise.truth"):
        refused(["truth", "--merge", name, "-o", "x.exr"], USAGE, name, folder, timeout=20)
    for name in ("pipe.json", "folder.json", "empty.json", "noise.json", "loop.json", "/dev/null"):
        refused(["compare", "run.json", name], USAGE, name, folder, timeout=20)
    long = "x" * 300
    for arguments, named in ((["render", "hall", "-o", long + ".png"], "too long"),
                             (["render", "hall", "-o", "pipe.hdr"], "pipe.hdr"),
                             (["render", "hall", "-o", "/proc/x.png"], "/proc/x.png"),
                             (["truth", "scene.json", "-o", "folder.exr"], "folder.exr"),
                             (["profile", "hall", "--json", long], "too long"),
                             (["stress", "--out", "file.txt"], "file.txt"),
                             (["bench", "skip", "--out", "file.txt/below"], "file.txt/below"),
                             (["report", "--out", "pipe.json"], "pipe.json")):
        refused(arguments, USAGE, named, folder, timeout=20)
    unwritable(folder)


@contextlib.contextmanager
def ordinary():
    """Options of start() under which permissions of files count. Root may read and write everything, so
    the program is started without the two capabilities that allow it (capabilities(7)). Without them root
    may not enter the private home of another user either, where the program may lie, so it is started
    from a copy in memory. Other users start it as always."""
    if os.geteuid() != 0:
        yield {}
        return
    rights = "-dac_override,-dac_read_search"
    copy = os.memfd_create("candelabra", flags=0)
    try:
        with open(copy, "wb", closefd=False) as out:
            out.write(program.read_bytes())
        yield {"executable": ["setpriv", f"--inh-caps={rights}", f"--bounding-set={rights}", "--", f"/proc/self/fd/{copy}"],
               "pass_fds": [copy]}
    finally:
        os.close(copy)


def unwritable(folder):
    """Folders that nothing may be written into, and a file that may not be read."""
    closed = folder / "closed"
    closed.mkdir()
    closed.chmod(0o555)
    (folder / "secret.json").write_text("{}")
    (folder / "secret.json").chmod(0o000)
    with ordinary() as options:
        refused_without_permission(folder, options)


def refused_without_permission(folder, options):
    for arguments in (["render", "hall", "-o", "closed/x.png"], ["render", "hall", "-q", "--json", "closed/x.json"],
                      ["profile", "hall", "--csv", "closed/x.csv"],
                      ["truth", "scene.json", "-o", "closed/x.exr"], ["stress", "--out", "closed/o"],
                      ["bench", "skip", "--out", "closed"], ["report", "--out", "closed/r"],
                      ["compare", "run.json", "run.json", "--json", "closed/x.json"]):
        refused(arguments, USAGE, "closed", folder, timeout=20, **options)
    refused(["compare", "secret.json", "run.json"], USAGE, "secret.json", folder, timeout=20, **options)
    refused(["render", "secret.json", "--explain"], USAGE, "secret.json", folder, timeout=20, **options)


# ---- full disks -------------------------------------------------------------------------------

TRUTH = ["truth", "scene.json", "--size", "32x32", "--tolerance", "1e-2", "--shadows", "off", "-q"]
# Commands, the file name that the sentence must contain, and whether they need a device.
WRITERS = [
    ([*TRUTH, "-o", "{}/x.exr"], "x.exr", False),
    ([*TRUTH, "-o", "{}/x.pfm"], "x.pfm", False),
    ([*TRUTH, "-o", "{}/x.hdr"], "x.hdr", False),
    ([*TRUTH, "--shard", "1/1", "-o", "{}/x.truth"], "x.truth", False),
    (["compare", "run.json", "run.json", "--json", "{}/x.json"], "x.json", False),
    (["diff", "dot.pfm", "dot.pfm", "--json", "{}/x.json"], "x.json", False),
    (["diff", "dot.pfm", "dot.pfm", "-q", "-o", "{}/x.png"], "x.png", False),
] + [(["render", "hall", "--lights", "5", "--size", "96x96", "-q", "-o", "{}/x." + e], "x." + e, True)
     for e in ("png", "exr", "pfm", "hdr")] + [
    (["render", "hall", "--lights", "5", "--size", "8x8", "-q", "--json", "{}/x.json"], "x.json", True),
    (["render", "hall", "--lights", "5", "--size", "96x96", "-q", "--debug", "class", "-o", "{}/x.png"], "x.png", True),
    (["profile", "hall", "--lights", "5", "--size", "8x8", "--frames", "4", "-q", "--json", "{}/x.json"], "x.json", True),
    (["profile", "hall", "--lights", "5", "--size", "8x8", "--frames", "4", "-q", "--csv", "{}/x.csv"], "x.csv", True),
    (["stress", "--lights", "5", "--size", "64x64", "--frames", "1", "-q", "--out", "{}"], "hall_5.png", True),
    (["bench", "skip", "--lights", "5", "--size", "16x16", "--rounds", "1", "-q", "--out", "{}"], "bench_skip.json", True),
    (["bench", "stability", "--configs", "1000", "--quadrature", "10", "--sweeps", "1", "-q", "--out", "{}"], "bench_stability.json", True),
    (["bench", "culling", "--scenes", "hall", "--lights", "20", "--overlaps", "8", "--size", "32x32", "--rounds", "1", "-q", "--out", "{}"], "bench_culling", True),
    (["report", "--parts", "profile", "--lights", "5", "--size", "32x32", "--frames", "2", "-q", "--out", "{}"], "picture0.png", True),
    (["view", "hall", "--lights", "5", "--size", "64x64", "--frames", "2", "-q", "--screenshot", "{}/x.png"], "x.png", True),
]
PRINTERS = [(["--help"], False), (["render", "--help"], False),
            (["--version"], False), (["compare", "run.json", "run.json"], False),
            (["compare", "run.json", "run.json", "--json", "-"], False), (["diff", "dot.pfm", "dot.pfm"], False), (["devices"], True), (["devices", "--json"], True),
            (["render", "hall", "--lights", "5", "--size", "8x8", "-q", "--json", "-"], True),
            (["render", "hall", "--lights", "5", "--size", "8x8", "-q", "--pick", "4,4"], True),
            (["profile", "hall", "--lights", "5", "--size", "8x8", "--frames", "2", "-q", "--json", "-"], True)]


@contextlib.contextmanager
def full_disk(folder):
    """A file system of one page, full; None where mounting is not allowed."""
    disk = folder / "disk"
    disk.mkdir()
    mounted = not subprocess.run(["mount", "-t", "tmpfs", "-o", "size=4096", "tmpfs", disk], capture_output=True,
                                 check=False).returncode
    try:
        if mounted:
            (disk / "ballast").write_bytes(b"x" * 4096)
        yield disk if mounted else None
    finally:
        if mounted:
            subprocess.run(["umount", disk], check=True)


def limit_files():
    resource.setrlimit(resource.RLIMIT_FSIZE, (128, 128))


def test_disk(folder):
    furnish(folder)
    wanted = [w for w in WRITERS if full or not w[2]]
    with full_disk(folder) as disk, display() as name:
        if not disk:
            print("no file system may be mounted here: limits of file sizes stand in for full disks")
        for number, (command, named, takes_device) in enumerate(wanted):
            # Benchmarks create all kernels, which takes an idle core half a minute without a GPU.
            options = {"env": environment(DISPLAY=name), "timeout": 600 if takes_device else 120}
            if disk:
                refused([a.format("disk") for a in command], FAILED, named, folder, **options)
            if disk and number % 4:  # both ways are tried for every kind
                continue
            shutil.rmtree(folder / "limited", ignore_errors=True)
            (folder / "limited").mkdir()
            if named.startswith("x."):
                (folder / "limited" / named).write_bytes(b"what was there")
            refused([a.format("limited") for a in command], FAILED, named, folder, preexec_fn=limit_files, **options)
    for command, takes_device in PRINTERS:
        if full or not takes_device:
            with open("/dev/full", "w", encoding="utf-8") as out:
                refused(command, FAILED, "standard output", folder, stdout=out)


# ---- signals ----------------------------------------------------------------------------------

# Commands whose files do not differ between runs, or whose completeness can be seen from their end.
LONG = [
    (["truth", "scene.json", "--size", "16x12", "--tolerance", "1e-3", "-q", "-o", "x.exr"], False),
    (["truth", "scene.json", "--size", "16x12", "--tolerance", "1e-3", "-q", "--shard", "1/2", "-o", "x.truth"], False),
    (["render", "hall", "--lights", "50", "--size", "256x256", "--frames", "4", "-q", "-o", "x.png", "-o", "x.exr",
      "-o", "x.pfm", "-o", "x.hdr", "--json", "x.json"], True),
    (["stress", "--lights", "20,40", "--size", "64x36", "--frames", "2", "-q", "--out", "o"], True),
    (["profile", "hall", "--lights", "50", "--size", "64x36", "--frames", "20", "-q", "--json", "x.json", "--csv", "x.csv"], True),
    (["bench", "skip", "--lights", "50", "--size", "64x36", "--rounds", "1", "-q", "--out", "o"], True),
    (["report", "--parts", "profile", "--lights", "60", "--size", "64x36", "--frames", "2", "-q", "--out", "o"], True),
]
ENDS = {".svg": b"</svg>", ".html": b"</html>", ".csv": b""}


def whole(name, content, reference):
    suffix = pathlib.Path(name).suffix
    if suffix == ".json":
        try:
            return isinstance(json.loads(content), (dict, list))
        except ValueError:
            return False
    if suffix in ENDS:
        lines = reference[name].count(b"\n")
        return content.endswith(ENDS[suffix] + b"\n") and (suffix != ".csv" or content.count(b"\n") == lines)
    return content == reference[name]


def interrupted(command, which, delay, reference):
    """One run with `which` sent after `delay` s. None when that ended it, else how long it ran, in s."""
    global count
    count += 1
    what = f"{' '.join(command)}: {which.name} after {delay:.3f} s"
    with tempfile.TemporaryDirectory(prefix="candelabra_faults_") as name:
        folder = pathlib.Path(name)
        furnish(folder)
        before = left(folder)
        began = time.monotonic()
        process = start(command, folder)
        try:
            _, err = process.communicate(timeout=delay)
        except subprocess.TimeoutExpired:
            process.send_signal(which)
            try:
                _, err = process.communicate(timeout=60)
            except subprocess.TimeoutExpired:
                process.kill()
                process.communicate()
                fault(what, "runs on")
                return time.monotonic() - began
        took = time.monotonic() - began
        if process.returncode not in (0, -which):
            fault(what, f"ended with {process.returncode}: {err}")
        if err:
            fault(what, f"said {err!r}")
        for path, content in left(folder).items():
            if path not in before and (path not in reference or not whole(path, content, reference)):
                fault(what, f"left {path}, which is no whole file of a finished run")
        return None if process.returncode == -which else took


def test_signals(folder):
    chance = random.Random(20)
    wanted = 10 if full else 4
    ended = tried = 0
    for command, takes_device in LONG:
        if takes_device and not full:
            continue
        shutil.rmtree(folder)
        folder.mkdir()
        furnish(folder)
        before = left(folder)
        began = time.monotonic()
        process = start(command, folder)
        _, err = process.communicate(timeout=300)
        duration = time.monotonic() - began
        if process.returncode:
            fault(" ".join(command), f"ended with {process.returncode}: {err}")
            continue
        reference = {n: c for n, c in left(folder).items() if n not in before}
        # The first run may have been slow because it shared the machine, and later runs may finish
        # before their signal. Such a run updates the expected duration, and is replaced by another
        # one.
        hits = 0
        for _ in range(8 * wanted):
            if hits == wanted:
                break
            tried += 1
            took = interrupted(command, (signal.SIGINT, signal.SIGTERM)[hits % 2], chance.uniform(0, duration), reference)
            if took is None:
                hits += 1
            else:
                duration = min(duration, took)
        if hits < wanted:
            fault(" ".join(command), f"only {hits} of {wanted} signals came before its end")
        ended += hits
    print(f"{ended} of {tried} runs were ended by their signal, the others had finished")


for group in groups:
    begun, already = time.monotonic(), count
    with tempfile.TemporaryDirectory(prefix="candelabra_faults_") as place:
        {"options": test_options, "files": test_files, "disk": test_disk,
         "signals": test_signals}[group](pathlib.Path(place))
    print(f"{group}: {count - already} cases, {time.monotonic() - begun:.1f} s", flush=True)
for line in failures:
    print("FAILED", line)
if failures:
    sys.exit(f"{len(failures)} of {count} cases failed")
