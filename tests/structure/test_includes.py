#!/usr/bin/env python3
# SPDX-License-Identifier: Apache-2.0
"""Checks which file includes which. FOLDERS lists the folders of the tree from the lowest to the highest and says
what each may include. No file includes one of a folder later in that list, and no files or folders include each
other in a circle. Usage: test_includes.py REPOSITORY"""
import pathlib
import posixpath
import re
import sys

PUBLIC = "engine/include/candelabra"

# (folder, what its files may include besides each other: earlier folders or files in them, and headers
# that the build generates). A file belongs to the folder with the longest matching name.
FOLDERS = [
    ("shaders/shared", []),
    ("shaders/lib", ["shaders/shared"]),
    ("shaders/shading", ["shaders/lib", "shaders/shared"]),
    # Shaders of hosts include shaders/shading/forward_lights.glsl by this name.
    ("shaders/lib/forward.glsl", ["shaders/shading/forward_lights.glsl"]),
    ("shaders/kernels/common", ["shaders/shading", "shaders/lib", "shaders/shared"]),
    ("shaders/kernels/cpu", ["shaders/kernels/common", "shaders/shading", "shaders/lib", "shaders/shared"]),
    ("shaders/kernels", ["shaders/kernels/common", "shaders/shading", "shaders/lib", "shaders/shared"]),
    ("shaders/gbuffer", ["shaders/lib", "shaders/shared"]),
    ("shaders/bench", ["shaders/kernels/common", "shaders/shading", "shaders/lib", "shaders/shared"]),
    ("shaders/program", ["shaders/lib", "shaders/shared"]),
    ("shaders/probes", ["shaders/bench/evaluate_classified.glsl", "shaders/shading", "shaders/lib/forward.glsl",
                        "shaders/lib", "shaders/shared"]),

    (PUBLIC, []),
    # The double-precision reference shares no code with what it judges: no shader, no other folder.
    ("engine/reference", [f"{PUBLIC}/candelabra.h"]),
    # The engine.
    ("engine/gpu", [PUBLIC]),
    ("engine/tables", ["engine/gpu", "shaders/shared", "candelabra_shaders.h"]),
    ("engine/surfaces", ["engine/gpu", "shaders/shared", PUBLIC, "candelabra_shaders.h"]),
    ("engine/lights", ["engine/tables", "engine/gpu", "shaders/shared", PUBLIC, "candelabra_shaders.h"]),
    ("engine/occluders", ["engine/gpu", "shaders/shared", PUBLIC, "candelabra_shaders.h"]),
    ("engine/clusters", ["engine/lights", "engine/surfaces", "engine/tables", "engine/gpu", "shaders/shared",
                         PUBLIC, "candelabra_shaders.h"]),
    ("engine/shading", ["engine/clusters", "engine/lights", "engine/surfaces", "engine/tables", "engine/gpu",
                        "shaders/shared", PUBLIC, "candelabra_shaders.h"]),
    ("engine/view", ["engine/shading", "engine/occluders", "engine/clusters", "engine/lights", "engine/surfaces",
                     "engine/tables", "engine/gpu", "shaders/shared", PUBLIC, "candelabra_shaders.h"]),
    ("engine/lighting", ["engine/view", "engine/shading", "engine/occluders", "engine/clusters", "engine/lights",
                         "engine/surfaces", "engine/tables", "engine/gpu", "shaders/shared", PUBLIC, "candelabra_shaders.h"]),
    # Other modules, which lighting does not use.
    ("engine/environment", ["engine/surfaces", "engine/tables", "engine/gpu", "shaders/shared", PUBLIC,
                            "candelabra_shaders.h"]),
    ("engine/exposure", ["engine/gpu", "shaders/shared", PUBLIC, "candelabra_shaders.h"]),
    ("engine/gbuffer", ["engine/gpu", "shaders/shared", PUBLIC, "candelabra_gbuffer_shaders.h"]),
    ("engine/compiler", ["engine/shading/light_family.h", "engine/gpu/failure.h", PUBLIC]),

    # The program: files and text; scenes; the three origins of scenes (glTF, generators, JSON) and the
    # folder that chooses among them; the double-precision truth of a scene.
    ("tools/candelabra/io", []),
    ("tools/candelabra/scene", ["tools/candelabra/io", PUBLIC]),
    ("tools/candelabra/gltf", ["tools/candelabra/scene", PUBLIC]),
    ("tools/candelabra/generate", ["tools/candelabra/scene", "tools/candelabra/io", PUBLIC]),
    ("tools/candelabra/json", ["tools/candelabra/gltf", "tools/candelabra/generate", "tools/candelabra/scene",
                               PUBLIC]),
    ("tools/candelabra/load", ["tools/candelabra/json", "tools/candelabra/gltf", "tools/candelabra/generate",
                               "tools/candelabra/scene", "tools/candelabra/io", PUBLIC]),
    ("tools/candelabra/truth", ["tools/candelabra/scene", "tools/candelabra/io", "engine/reference", PUBLIC]),
    # The program renders through the public API. It may also use engine/gpu and the raster pass, which can both
    # be used alone.
    ("tools/candelabra/render", ["tools/candelabra/scene", "tools/candelabra/io", PUBLIC, "engine/gpu",
                                 "engine/gbuffer", "shaders/shared/specular_methods.h",
                                 "shaders/shared/accumulate.h", "shaders/shared/bloom.h",
                                 "shaders/shared/edge_filter.h", "shaders/shared/heat_map.h",
                                 "candelabra_commit.h",
                                 "candelabra_program_shaders.h"]),
    # The shaders' evaluation of lights and shadows in double precision. double_shaders.h contains shaders/shading
    # and everything that it includes, double_visibility.h shaders/lib/visibility.
    ("tools/formula", ["engine/shading/light_family.h", "engine/tables/point_table.h", "shaders/shared/conic_constants.h",
                       "shaders/shared/light_type_list.h", "shaders/shared/lighting_data.h",
                       "shaders/shared/occluder_data.h", PUBLIC, "double_shaders.h", "double_visibility.h"]),
    # The folders that measure compare with the double-precision truth. Some of them may use internals of
    # the engine, so their lists name more of the engine than PUBLIC.
    ("tools/candelabra/measure/frame", ["tools/candelabra/render", "tools/candelabra/truth", "tools/candelabra/scene",
                                        "tools/candelabra/io", PUBLIC, "engine/reference",
                                        "shaders/shared/gbuffer_data.h"]),
    ("tools/candelabra/measure/profile", ["tools/candelabra/measure/frame", "tools/candelabra/render",
                                          "tools/candelabra/scene", "tools/candelabra/io", PUBLIC]),
    ("tools/candelabra/measure/kernels", ["tools/formula", "tools/candelabra/render", "tools/candelabra/scene", PUBLIC,
                                          "engine/gpu", "engine/lights", "engine/shading/light_family.h",
                                          "shaders/shared/bench.h", "shaders/shared/ltc.h",
                                          "candelabra_bench_shaders.h"]),
    ("tools/candelabra/measure/accuracy", ["tools/candelabra/measure/kernels", "tools/formula", "tools/candelabra/render",
                                           "tools/candelabra/truth", "tools/candelabra/load",
                                           "tools/candelabra/generate", "tools/candelabra/scene",
                                           "tools/candelabra/io", PUBLIC, "engine/reference",
                                           "engine/lights", "engine/surfaces/frame_uniforms.h",
                                           "engine/surfaces/host_gbuffer.h", "engine/tables/dfg_table.h",
                                           "shaders/shared/bench.h", "shaders/shared/lighting_data.h",
                                           "candelabra_bench_shaders.h"]),
    ("tools/candelabra/measure/stability", ["tools/candelabra/measure/kernels", "tools/candelabra/render",
                                            "tools/candelabra/generate", "tools/candelabra/scene",
                                            "tools/candelabra/io", "engine/reference",
                                            "engine/shading/light_family.h", "candelabra_bench_shaders.h"]),
    ("tools/candelabra/measure/pipelines", ["tools/candelabra/render", "tools/candelabra/generate",
                                            "tools/candelabra/scene", "tools/candelabra/io", PUBLIC, "engine/gpu",
                                            "engine/gbuffer", "shaders/shared/lighting_data.h",
                                            "shaders/shared/raster.h"]),
    ("tools/candelabra/measure/visibility", ["tools/candelabra/measure/frame", "tools/candelabra/measure/profile",
                                             "tools/candelabra/render", "tools/candelabra/generate",
                                             "tools/candelabra/io", PUBLIC, "engine/reference"]),
    ("tools/candelabra/measure/culling", ["tools/candelabra/measure/frame", "tools/candelabra/measure/kernels",
                                          "tools/candelabra/render", "tools/candelabra/load",
                                          "tools/candelabra/scene", "tools/candelabra/io", PUBLIC, "engine/gpu",
                                          "engine/lights", "engine/surfaces/frame_uniforms.h",
                                          "engine/surfaces/host_gbuffer.h", "engine/tables/dfg_table.h",
                                          "shaders/shared/baselines.h", "shaders/shared/light_order_data.h",
                                          "candelabra_shaders.h", "candelabra_bench_shaders.h"]),
    ("tools/candelabra/measure", ["tools/candelabra/measure/frame", "tools/candelabra/render",
                                  "tools/candelabra/load", "tools/candelabra/scene", "tools/candelabra/io",
                                  PUBLIC, "engine/reference"]),
    ("tools/candelabra/viewer", ["tools/candelabra/measure", "tools/candelabra/render", "tools/candelabra/load",
                                 "tools/candelabra/json", "tools/candelabra/generate", "tools/candelabra/scene",
                                 "tools/candelabra/io", PUBLIC, "engine/reference"]),
    ("tools/candelabra/commands", ["tools/candelabra/viewer", "tools/candelabra/measure",
                                   "tools/candelabra/render", "tools/candelabra/truth", "tools/candelabra/load",
                                   "tools/candelabra/generate", "tools/candelabra/scene", "tools/candelabra/io",
                                   PUBLIC, "engine/reference"]),
    ("tools/candelabra", ["tools/candelabra/commands", "tools/candelabra/render", "tools/candelabra/scene",
                          "tools/candelabra/io"]),
    ("tools/fit", ["tools/formula", "tools/candelabra/measure/accuracy", "tools/candelabra/measure/kernels",
                   "tools/candelabra/render/provenance.h",
                   "tools/candelabra/generate/random.h", "tools/candelabra/io", "engine/reference",
                   "shaders/shared/conic_constants.h"]),

    # Each sample is written like a separate project that finds the installed engine.
    ("samples/common", []),
    ("samples/embed_c", ["samples/common"]),
    ("samples/embed_forward", ["samples/common", "shaders/lib/forward.glsl", "ball_frag.h", "ball_vert.h"]),
    ("samples/embed_minimal", ["samples/common"]),
    ("samples/embed_render_pass", ["samples/common", "wall_frag.h", "wall_vert.h"]),
    ("samples/embed_shadow_map", ["samples/common", "bar_vert.h"]),
    ("samples/embed_shadows", ["samples/common", "box_frag.h", "box_vert.h", "stalk_comp.h"]),
    ("samples/embed_split_screen", ["samples/common"]),
    ("samples/embed_visibility_buffer", ["samples/common", "shaders/lib/gbuffer.glsl", "scene_glsl.inc",
                                         "surface_glsl.inc", "ids_frag.h", "plain_frag.h", "scene_vert.h"]),
    ("samples/embed_window", ["samples/common", "boxes.frag.inc", "boxes.vert.inc"]),

    # Tests may include everything, and nothing includes tests.
    ("tests", ["engine", "shaders", "tools", "candelabra_probes.h"]),
]

# (folder, where quoted includes of its files are looked for after the includer's own folder)
SEARCHED = [
    ("engine", ["engine", "engine/include", "shaders"]),
    ("shaders", ["shaders"]),
    ("tools/candelabra", ["tools/candelabra", "tools", "engine", "engine/include", "shaders"]),
    ("tools", ["tools", "tools/candelabra", "engine", "engine/include", "shaders"]),
    ("samples", ["samples/common", "shaders"]),
    ("tests", ["tests", "tests/data", "tools/candelabra", "tools", "engine", "engine/include", "shaders"]),
]

# Public headers may include these with angle brackets: the standard library and Vulkan.
PUBLIC_SYSTEM = re.compile(r"^(vulkan/vulkan_core\.h|[a-z_]+(\.h)?)$")

SUFFIXES = {".c", ".comp", ".cpp", ".frag", ".glsl", ".h", ".hpp", ".vert"}


def within(path, place):
    return path == place or path.startswith(place + "/")


def is_generated(place):
    """Tells whether an entry of a folder's list is a header that the build generates."""
    return "/" not in place and "." in place


def folder_of(path, folders):
    """Returns the folder that a file belongs to, or None if there is none."""
    return max((folder for folder, _ in folders if within(path, folder)), key=len, default=None)


def resolve(path, include, files):
    """Returns the files that an include may mean."""
    searched = next((places for folder, places in SEARCHED if within(path, folder)), [])
    places = [path.rpartition("/")[0]] + searched
    return {posixpath.normpath(f"{place}/{include}") for place in places} & files.keys()


def cycles(edges):
    """Returns the circles: strongly connected components with more than one node, and nodes with an edge
    to themselves (Tarjan 1972). Each is sorted."""
    index, low, stack, found = {}, {}, [], []

    def visit(node):
        index[node] = low[node] = len(index)
        stack.append(node)
        for other in edges.get(node, ()):
            if other not in index:
                visit(other)
            if other in stack:
                low[node] = min(low[node], low[other])
        if low[node] == index[node]:
            component = stack[stack.index(node):]
            del stack[stack.index(node):]
            if len(component) > 1 or node in edges.get(node, ()):
                found.append(sorted(component))

    for node in sorted(edges):
        if node not in index:
            visit(node)
    return found


def check_table(folders):
    """Yields what is wrong with the list of folders itself."""
    order = [folder for folder, _ in folders]
    for at, (folder, allowed) in enumerate(folders):
        for place in allowed:
            if not is_generated(place) and not any(
                    within(place, below) or within(below, place) for below in order[:at]):
                yield f"the list of folders: {folder} may include {place}, which is not listed before it"


def check(files, folders):
    """Yields what is wrong with the includes of `files`, a dictionary from path to text."""
    yield from check_table(folders)
    allowed = dict(folders)
    generated = {place for places in allowed.values() for place in places if is_generated(place)}
    by_file, by_folder = {}, {}
    for path, text in sorted(files.items()):
        if pathlib.Path(path).suffix not in SUFFIXES:
            continue
        folder = folder_of(path, folders)
        if folder is None:
            yield f"{path}: is in no listed folder"
            continue
        for include in re.findall(r'^\s*#\s*include "([^"]+)"', text, re.MULTILINE):
            if include in generated:
                if include not in allowed[folder] and folder != "tests":
                    yield f'{path}: may not include "{include}"'
                continue
            targets = resolve(path, include, files)
            if len(targets) != 1:
                yield f'{path}: "{include}" ' + (f"means {' and '.join(sorted(targets))}" if targets
                                                  else "is not a file of the repository")
                continue
            target = targets.pop()
            by_file.setdefault(path, set()).add(target)
            other = folder_of(target, folders)
            if other != folder:
                by_folder.setdefault(folder, set()).add(other)
                if not any(within(target, place) for place in allowed[folder]):
                    yield f'{path}: may not include "{include}": {folder} may not include {other}'
    for component in cycles(by_file):
        yield "files include each other in a circle: " + ", ".join(component)
    for component in cycles(by_folder):
        yield "folders include each other in a circle: " + ", ".join(component)


def check_public(files):
    """Yields forbidden includes with angle brackets in the headers that hosts include."""
    for path, text in sorted(files.items()):
        if within(path, PUBLIC):
            for include in re.findall(r"^\s*#\s*include <([^>]+)>", text, re.MULTILINE):
                if not PUBLIC_SYSTEM.match(include) and \
                        not (path.endswith("/glm.hpp") and include.startswith("glm/")):
                    yield f"{path}: may not include <{include}>"


def test_the_test():
    """Checks that this test finds each kind of fault, and finds nothing in correct files."""
    folders = [("engine/low", []), ("engine/high", ["engine/low"])]
    low, high = "engine/low/a.h", "engine/high/b.h"

    def found(files, folders=folders):
        return [fault.split(": ")[0] for fault in check(files, folders)]

    around = "files include each other in a circle"
    assert found({low: "", high: '#include "low/a.h"\n'}) == []
    assert found({low: '#include "high/b.h"\n', high: ""}) == [low]  # upward
    assert found({low: '#include "c.h"\n', "engine/low/c.h": '#include "low/a.h"\n'}) == [around]
    assert found({low: '#include "a.h"\n'}) == [around]
    three = {low: '#include "c.h"\n', "engine/low/c.h": '#include "d.h"\n', "engine/low/d.h": '#include "a.h"\n'}
    assert found(three) == [around]
    assert found({low: '#include "high/b.h"\n', high: "", "engine/high/c.h": '#include "low/a.h"\n'}) == \
        [low, "folders include each other in a circle"]
    assert found({low: '#include "nowhere.h"\n'}) == [low]
    assert found({"engine/other/a.h": ""}) == ["engine/other/a.h"]  # in no listed folder
    assert found({}, [("engine/low", ["engine/high"]), ("engine/high", [])]) == ["the list of folders"]
    # The reference does not include any version of the formulas that it judges.
    formulas = {"tools/formula/formula.h": "", "shaders/lib/math.glsl": ""}
    for include in ("formula/formula.h", "../../tools/formula/formula.h", "double_shaders.h", "lib/math.glsl"):
        assert "engine/reference/a.h" in found({"engine/reference/a.h": f'#include "{include}"\n', **formulas}, FOLDERS)
    assert list(check_public({f"{PUBLIC}/a.h": "#include <vulkan/vulkan.h>\n"})) != []
    assert list(check_public({f"{PUBLIC}/a.h": "#include <vulkan/vulkan_core.h>\n"})) == []


def main():
    test_the_test()
    root = pathlib.Path(sys.argv[1]).resolve()
    files = {path.relative_to(root).as_posix(): path.read_text(encoding="utf-8")
             for folder in ("engine", "samples", "shaders", "tests", "tools")
             for path in sorted((root / folder).rglob("*")) if path.suffix in SUFFIXES | {".inc"}}
    failures = list(check(files, FOLDERS)) + list(check_public(files))
    print("\n".join(failures) or f"{len(files)} files in {len(FOLDERS)} folders include only what they may")
    return 1 if failures else 0


if __name__ == "__main__":  # test_documents.py reads FOLDERS
    sys.setrecursionlimit(10_000)
    sys.exit(main())
