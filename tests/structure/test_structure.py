#!/usr/bin/env python3
# SPDX-License-Identifier: Apache-2.0
"""Rules about files that no compiler checks: the first line of a file, the width of lines, banned names,
pure shader functions, complete lists of kernels, one version, the files at the top level.
Usage: test_structure.py REPOSITORY"""
import json
import pathlib
import re
import sys

root = pathlib.Path(sys.argv[1])
failures = []


def fail(path, why):
    failures.append(f"{path.relative_to(root)}: {why}")


SOURCES = [p for folder in ("engine", "samples", "shaders", "tools", "tests")
           for p in sorted((root / folder).rglob("*"))
           if p.suffix in (".c", ".cpp", ".h", ".hpp", ".comp", ".glsl", ".vert", ".frag")]

for path in SOURCES:
    text = path.read_text(encoding="utf-8")
    name = path.relative_to(root).as_posix()
    if not text.startswith("// SPDX-License-Identifier: Apache-2.0\n"):
        fail(path, "does not start with the SPDX line")
    if path.suffix in (".h",) and "#pragma once" not in text and "#ifndef CND_" not in text \
            and "#ifndef CANDELABRA_" not in text:
        fail(path, "has no include guard")
    for number, line in enumerate(text.split("\n"), 1):
        columns = 104 if name.startswith("shaders/") else 100  # no formatter wraps GLSL for us
        if len(line) > columns:
            fail(path, f"line {number} has {len(line)} columns, at most {columns}")
    if re.search(r"\b(TODO|FIXME|XXX)\b", text):
        fail(path, "holds an unfinished mark")

# The engine loads no Vulkan itself: prototypes may only be called above it.
for path in SOURCES:
    if path.relative_to(root).as_posix().startswith("engine/"):
        if re.search(r"\bvk[A-Z]\w+\(", re.sub(r"//.*", "", path.read_text())):
            fail(path, "calls a Vulkan prototype instead of the host's function table")

# The functions of shaders/lib are pure: results follow from arguments and constants. Bindings,
# parameters, specialisation constants and the state of a lane belong to shaders/shading and
# shaders/kernels.
IMPURE = {
    "a layout": r"\blayout\s*\(",
    "the includer's params": r"\bparams\b",
    "the includer's counters": r"\bcounters\b",
    "a built-in variable": r"\bgl_\w+",
    "shared memory": r"^shared\b",
    "a variable outside functions": r"^(?!const\b|struct\b)\w+ \w+(\[[^\]]*\])?\s*[=,;]",
}
for path in sorted((root / "shaders/lib").rglob("*.glsl")):
    code = re.sub(r"//.*", "", path.read_text(encoding="utf-8"))
    for what, pattern in IMPURE.items():
        if found := re.search(pattern, code, re.MULTILINE):
            fail(path, f"is not pure: it uses {what}: {found[0]}")

# The only #ifdef __cplusplus of the shaders is in prelude.h.
for path in SOURCES:
    name = path.relative_to(root).as_posix()
    if name.startswith("shaders/") and name != "shaders/shared/prelude.h":
        if "__cplusplus" in path.read_text():
            fail(path, "only shaders/shared/prelude.h may ask for the language")

# Every kernel is in the build, and every file the build names exists.
listed = re.findall(r"(?:kernels|gbuffer|program|probes|bench)/\w+\.\w+", (root / "shaders/CMakeLists.txt").read_text())
for folder in ("kernels", "gbuffer", "program", "probes", "bench"):
    for path in sorted((root / "shaders" / folder).glob("*")):
        if path.is_file() and path.suffix != ".glsl" and f"{folder}/{path.name}" not in listed:
            fail(path, "is not in shaders/CMakeLists.txt")

# Names that are banned because they do not say which quantity is meant.
BANNED = re.compile(r"\bfloat (brightness|roughness|color)\b\s*[;=]")
for path in SOURCES:
    name = path.relative_to(root).as_posix()
    if name.startswith(("engine/include", "shaders/lib")) and BANNED.search(path.read_text()):
        fail(path, "uses a banned quantity name (brightness, roughness, color)")

# The public header and the packages have the same version.
project = re.search(r"project\(candelabra VERSION ([\d.]+)", (root / "CMakeLists.txt").read_text())[1]
core = root / "engine/include/candelabra/core.h"
header = re.findall(r"#define CND_VERSION_(?:MAJOR|MINOR|PATCH) (\d+)", core.read_text())
if ".".join(header) != project:
    fail(core, f"says version {'.'.join(header)}, CMakeLists.txt {project}")
port = root / "engine/package/vcpkg/vcpkg.json"
if json.loads(port.read_text())["version"] != project:
    fail(port, f"does not have the version of CMakeLists.txt, {project}")

TOP_LEVEL = {"CMakeLists.txt", "CMakePresets.json", "LICENSE", "README.md", "engine", "samples",
             "shaders", "tests", "tools", "build", "out"}
for path in root.iterdir():
    if path.name not in TOP_LEVEL and not path.name.startswith("."):
        fail(path, "does not belong at the top level")

print("\n".join(failures) or f"{len(SOURCES)} files keep the rules")
sys.exit(1 if failures else 0)
