#!/usr/bin/env python3
# SPDX-License-Identifier: Apache-2.0
"""Rules about the tree that no compiler checks: who may include whom, how large a file may be, what
every file starts with. Usage: test_structure.py REPOSITORY"""
import pathlib
import re
import sys

root = pathlib.Path(sys.argv[1])
failures = []


def fail(path, why):
    failures.append(f"{path.relative_to(root)}: {why}")


# Folder -> what its quoted includes may start with. The first match wins.
ALLOWED = [
    ("engine/include", ["candelabra/"]),
    ("engine/gpu", ["gpu/", "candelabra/"]),
    ("engine/reference", ["reference/", "candelabra/candelabra.h"]),
    ("engine/tables", ["tables/", "gpu/", "shared/", "candelabra_shaders.h"]),
    # The rooms of the lighting engine, lowest first: each includes itself and rooms below it.
    *((f"engine/{room}", [f"{room}/", *below, "gpu/", "shared/", "candelabra/", "candelabra_shaders.h"])
      for room, below in (
          ("surfaces", []),
          ("lights", []),
          ("clusters", ["lights/", "surfaces/"]),
          ("shading", ["clusters/", "lights/", "surfaces/"]),
          ("view", ["shading/", "clusters/", "lights/", "surfaces/", "tables/"]),
          ("lighting", ["view/", "shading/", "lights/"]),
          ("environment", ["surfaces/", "tables/"]))),
    ("engine/exposure", ["exposure/", "gpu/", "shared/", "candelabra/", "candelabra_shaders.h"]),
    ("engine/compiler", ["compiler/", "candelabra/", "gpu/failure.h"]),
    ("engine/gbuffer", ["gbuffer/", "gpu/", "shared/", "candelabra/", "candelabra_gbuffer_shaders.h"]),
    # Scenes: what they are, then their three origins, then the one entry point that picks the origin.
    ("tools/candelabra/scene", ["scene/", "io/", "candelabra/", "reference/"]),
    ("tools/candelabra/gltf", ["gltf/", "scene/", "io/", "candelabra/"]),
    ("tools/candelabra/generate", ["generate/", "scene/", "io/", "candelabra/"]),
    ("tools/candelabra/json", ["json/", "gltf/", "generate/", "scene/", "io/", "candelabra/"]),
    ("tools/candelabra/load", ["load/", "json/", "gltf/", "generate/", "scene/", "io/", "candelabra/"]),
    # The benchmarks measure what lies below the public face, and against the double-precision truth.
    ("tools/candelabra/bench", ["bench/", "io/", "render/", "scene/", "load/", "generate/", "commands/",
                                "candelabra/", "gpu/",
                                "lights/", "shading/shade_kernels.h", "surfaces/camera.h", "tables/",
                                "reference/", "shared/", "candelabra_shaders.h", "candelabra_bench_shaders.h"]),
    # The program draws its frames through the public face; of the engine's inside it may use the gpu
    # floor and the raster pass, both of which are made to be used alone; and the reference, which is
    # what `candelabra truth` and the accuracy benchmark hand out and measure against.
    ("tools/candelabra", ["bench/", "commands/", "io/", "render/", "scene/", "gltf/", "generate/",
                          "json/", "load/", "viewer/", "cli.h",
                          "candelabra/", "gpu/", "gbuffer/", "reference/", "shared/specular_methods.h",
                          "shared/gbuffer.h",
                          "candelabra_commit.h"]),
    # Written as if in a project of their own.
    ("samples/embed_window", ["host.h", "boxes.", "panel.h", "window.h"]),
    ("samples", ["host.h", "ball", "lib/forward.glsl"]),
    ("tools/transcription", ["transcription/", "shared/conic_constants.h"]),
    ("tools/fit", ["fit/", "reference/", "shared/ltc.h"]),
    ("shaders/shared", ["shared/"]),
    # The name by which hosts' shaders include what shading/forward.glsl holds.
    ("shaders/lib/forward.glsl", ["shading/forward.glsl"]),
    ("shaders/lib", ["shared/", "lib/"]),
    ("shaders/shading", ["shared/", "lib/", "shading/"]),
    ("shaders/kernels", ["shared/", "lib/", "shading/", "kernels/common/"]),
    ("shaders/gbuffer", ["shared/", "lib/", "gbuffer/"]),
    ("shaders/bench", ["shared/", "lib/", "shading/", "kernels/common/", "bench/"]),
]
# Standard library and Vulkan only, in what hosts include.
PUBLIC_SYSTEM = re.compile(r"^(vulkan/vulkan_core\.h|[a-z_]+(\.h)?)$")

MAX_LINES = {".cpp": 450, ".c": 450, ".h": 450, ".hpp": 450, ".comp": 140, ".glsl": 300}

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
    lines = text.count("\n")
    if lines > MAX_LINES.get(path.suffix, 450):
        fail(path, f"has {lines} lines, at most {MAX_LINES.get(path.suffix, 450)}")
    for number, line in enumerate(text.split("\n"), 1):
        columns = 104 if name.startswith("shaders/") else 100  # no formatter wraps GLSL for us
        if len(line) > columns:
            fail(path, f"line {number} has {len(line)} columns, at most {columns}")
    for folder, allowed in ALLOWED:
        if name != folder and not name.startswith(folder + "/"):
            continue
        for include in re.findall(r'#include "([^"]+)"', text):
            if not any(include.startswith(a) for a in allowed):
                fail(path, f'may not include "{include}"')
        if folder == "engine/include":
            for include in re.findall(r"#include <([^>]+)>", text):
                if not PUBLIC_SYSTEM.match(include) and \
                        not (path.name == "glm.hpp" and include.startswith("glm/")):
                    fail(path, f"may not include <{include}>")
        break
    if re.search(r"\b(TODO|FIXME|XXX)\b", text):
        fail(path, "holds an unfinished mark")

# The engine loads no Vulkan itself: prototypes may only be called above it.
for path in SOURCES:
    if path.relative_to(root).as_posix().startswith("engine/"):
        if re.search(r"\bvk[A-Z]\w+\(", re.sub(r"//.*", "", path.read_text())):
            fail(path, "calls a Vulkan prototype instead of the host's function table")

# What shaders/lib holds is pure: results follow from arguments and constants. Bindings, parameters,
# specialisation constants and the state of a lane belong to shaders/shading and shaders/kernels.
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

# One #ifdef __cplusplus in shaders: prelude.h.
for path in SOURCES:
    name = path.relative_to(root).as_posix()
    if name.startswith("shaders/") and name != "shaders/shared/prelude.h":
        if "__cplusplus" in path.read_text():
            fail(path, "only shaders/shared/prelude.h may ask for the language")

# Every kernel is in the build, and every file the build names exists.
listed = re.findall(r"(?:kernels|gbuffer|probes|bench)/\w+\.\w+", (root / "shaders/CMakeLists.txt").read_text())
for folder in ("kernels", "gbuffer", "probes", "bench"):
    for path in sorted((root / "shaders" / folder).glob("*")):
        if path.is_file() and path.suffix != ".glsl" and f"{folder}/{path.name}" not in listed:
            fail(path, "is not in shaders/CMakeLists.txt")

# Names that are banned because they do not say which quantity is meant.
BANNED = re.compile(r"\bfloat (brightness|roughness|color)\b\s*[;=]")
for path in SOURCES:
    name = path.relative_to(root).as_posix()
    if name.startswith(("engine/include", "shaders/lib")) and BANNED.search(path.read_text()):
        fail(path, "uses a banned quantity name (brightness, roughness, color)")

# The version that headers say is the one that packages carry.
project = re.search(r"project\(candelabra VERSION ([\d.]+)", (root / "CMakeLists.txt").read_text())[1]
core = root / "engine/include/candelabra/core.h"
header = re.findall(r"#define CND_VERSION_(?:MAJOR|MINOR|PATCH) (\d+)", core.read_text())
if ".".join(header) != project:
    fail(core, f"says version {'.'.join(header)}, CMakeLists.txt {project}")

TOP_LEVEL = {"CMakeLists.txt", "CMakePresets.json", "LICENSE", "README.md", "engine", "samples",
             "shaders", "tests", "tools", "build", "out"}
for path in root.iterdir():
    if path.name not in TOP_LEVEL and not path.name.startswith("."):
        fail(path, "does not belong at the top level")

print("\n".join(failures) or f"{len(SOURCES)} files keep the rules")
sys.exit(1 if failures else 0)
