#!/usr/bin/env python3
# SPDX-License-Identifier: Apache-2.0
"""Tests Candelabra as other projects get it: installed into a folder that is then moved, found from
clean build folders, fetched, added to a source tree, or by a package manager. The samples use the
compilers that BUILD has found. Usage: test_package.py STEP SOURCE BUILD GENERATOR; the step `install` must run first. Everything is written to BUILD/package."""
import os
import pathlib
import re
import shlex
import shutil
import runpy
import subprocess
import sys
import types
import unittest.mock

step, source, build, generator = sys.argv[1], *map(pathlib.Path, sys.argv[2:4]), sys.argv[4]
work = build / "package"
prefix = work / "prefix"
launcher = [path] if (path := shutil.which("ccache")) else []
# The samples run with validation and synchronization validation; the loader's log names its layers.
LAYERS = {"VK_INSTANCE_LAYERS": "VK_LAYER_KHRONOS_validation",
          "VK_LAYER_ENABLES": "VK_VALIDATION_FEATURE_ENABLE_SYNCHRONIZATION_VALIDATION_EXT",
          "VK_LOADER_DEBUG": "layer"}


def run(*command, **environment):
    """What the command prints; ends the test when it fails."""
    print("$", *command, flush=True)
    done = subprocess.run([str(c) for c in command], env=os.environ | environment, text=True,
                          stdout=subprocess.PIPE, stderr=subprocess.STDOUT)
    if done.returncode:
        sys.exit(f"{done.stdout}\nended with {done.returncode}")
    return done.stdout


def require(condition, why):
    if not condition:
        sys.exit(why)


def clean(folder):
    shutil.rmtree(folder, ignore_errors=True)
    return folder


# This option makes CMake use what a build folder already says about compilers. CMake does not document it, and a
# version that does not know it looks for the compilers again.
COMPILERS_ARE_KNOWN = "-DCMAKE_PLATFORM_INFO_INITIALIZED=ON"


def copy_compilers(folder):
    """Copies what CMake knows about the compilers of BUILD to a new build folder, for COMPILERS_ARE_KNOWN."""
    for known in (build / "CMakeFiles").glob("*/CMake*Compiler.cmake"):
        copy = folder / known.relative_to(build)
        copy.parent.mkdir(parents=True, exist_ok=True)
        shutil.copy(known, copy)


def configure_and_build(project, folder, *options):
    launchers = [f"-DCMAKE_{l}_COMPILER_LAUNCHER={launcher[0]}" for l in ("C", "CXX") if launcher]
    run("cmake", "-G", generator, "-S", project, "-B", folder, *launchers, *options)
    run("cmake", "--build", folder, "--parallel", 2)


def run_sample(*command):
    os.chdir(work)  # the sample may write pictures here
    log = run(*command, **LAYERS)
    require(re.search(r"Insert instance layer.*VK_LAYER_KHRONOS_validation", log),
            log + "\nvalidation was not active")
    require(not re.search("VUID|SYNC-HAZARD|Validation Error|Validation Warning", log), log)
    print("\n".join(line for line in log.split("\n") if not line.startswith("[Vulkan Loader]")))


def libdir():
    return next(prefix.glob("lib*/**/libcandelabra.so")).parent


def install():
    clean(work)
    run("cmake", "--install", build, "--prefix", work / "first")
    (work / "first").rename(prefix)  # finds out whether anything remembers the first place

    compiler = [h for h in (prefix / "include").rglob("*.h") if h.stem == "compiler"]
    others = [h for h in (prefix / "include").rglob("*.h") if h.stem != "compiler"]
    for name, headers in {"libcandelabra": others, "libcandelabra_compiler": compiler}.items():
        library = libdir() / f"{name}.so"
        symbols = {line.split()[-1] for line in run("nm", "-D", "--defined-only", library).splitlines()}
        declared = set(re.findall(r"CND_API[^;(]*?\b(cnd\w+)\(",
                                  "".join(h.read_text(encoding="utf-8") for h in headers)))
        require(symbols == declared, f"{name}: exported and declared differ in {symbols ^ declared}")
        major_minor = re.search(r"SONAME.*\[(.*)\]", run("readelf", "-d", library))
        require(re.fullmatch(rf"{name}\.so\.\d+\.\d+", major_minor[1]), f"SONAME {major_minor[1]}")
        require("glslang" not in run("readelf", "-d", library), f"{name} needs a glslang of the system")

    documents = sorted((prefix / "share/doc/candelabra").glob("*.md"))
    require(len(documents) == 9, f"installed {documents}")
    for document in documents:
        text = document.read_text(encoding="utf-8")
        named = re.findall(r"\b[A-Z_]+\.md\b|\bsamples/\w+", text)
        linked = [link.partition("#")[0] for link in re.findall(r"\]\(([^)]+)\)", text)]
        for name in {*named, *filter(None, linked)}:
            require((document.parent / name).exists(), f"{document} refers to {name}, which is not installed")
    texts = [p for folder in ("include", "lib", "share/candelabra") for p in (prefix / folder).rglob("*")
             if p.suffix in (".h", ".hpp", ".glsl", ".cmake", ".pc") and p.is_file()]
    require(len(texts) > 10, f"only {len(texts)} files were installed")
    for path in texts:
        text = path.read_text(encoding="utf-8")
        require("glm" not in text.lower() or path.name == "glm.hpp", f"{path} names GLM")
        for place in (source, build, work / "first"):
            require(f"{place}/" not in text, f"{path} names {place}")
    run("glslangValidator", "-V", "--target-env", "vulkan1.3", f"-I{prefix}/share/candelabra/shaders",
        "-o", work / "pack.spv", source / "tests/package/pack.frag")


def sample(name):
    copy_compilers(clean(work / name))
    configure_and_build(prefix / "share/doc/candelabra/samples" / name, work / name, f"-DCMAKE_PREFIX_PATH={prefix}",
                        COMPILERS_ARE_KNOWN)
    {"embed_window": show_window}.get(name, run_sample)(work / name / name)


def show_window(program):
    """Pictures of a window that changed its size half way: lit, and what Candelabra read."""
    for name, options in {"lit": (), "faults": ("--overlay", "6")}.items():
        file = work / f"{name}.ppm"
        run_sample("xvfb-run", "-a", program, "--size", "640x360", "--frames", "12", "--resize",
                   "--screenshot", file, *options)
        _, size, _, pixels = file.read_bytes().split(b"\n", 3)
        require(size == b"480 270" and len(pixels) == 480 * 270 * 3, f"{file} is {size}")
        # The part of the picture to the right of the panel.
        shown = [pixels[i:i + 3] for y in range(270) for i in range((480 * y + 300) * 3,
                                                                    480 * (y + 1) * 3, 3)]
        mean = sum(map(sum, shown)) / len(shown) / 3
        require(20 < mean < 150 and len(set(shown)) > 50, f"{file}: mean {mean}, {len(set(shown))} colours")
        coloured = sum(max(p) - min(p) > 2 for p in shown)
        require((coloured == 0) == (name == "faults"), f"{file}: {coloured} coloured pixels")


CPP = ("cpp17", "cpp20")


def consume(folder, options, *names):
    configure_and_build(source / "tests/package/consumer", clean(folder), *options)
    run_hosts(folder, *names)


def run_hosts(folder, *names):
    hosts = sorted(folder.glob("with_*[a-z0-9]"))
    require({h.name for h in hosts} == {f"with_{n}" for n in ("candelabra", "candelabra_static", *names)},
            f"built {hosts}")
    for host in hosts:
        print(host.name, run(host), end="")
    dynamic = run("readelf", "-d", folder / "with_candelabra_static")
    require("libcandelabra" not in dynamic, "the static library was linked as a shared one")


# Neither the library nor its hosts need these. CMake stops if one of them is required.
WITHOUT = [f"-DCMAKE_DISABLE_FIND_PACKAGE_{name}=TRUE" for name in
           ("Vulkan", "glslang", "glfw3", "GTest", "CLI11", "fmt", "meshoptimizer", "nlohmann_json", "spdlog",
            "TinyGLTF", "OpenEXR", "draco", "PkgConfig", "Python3")]


def found():
    """Projects that find the installed package: one in C alone, one in C and C++."""
    options = [f"-DCMAKE_PREFIX_PATH={prefix}", *WITHOUT]
    consume(work / "found_c", options, "compiler")
    consume(work / "found", [*options, "-DCPP=ON"], "compiler", *CPP)


def fetched():
    """Fetched by the commands of the guide, from a repository whose branch is main; then by add_subdirectory, which
    also installs the static library alone. The second project has the source and build folders of the first one, so
    nothing is compiled twice."""
    repository = clean(work / "repository")
    shutil.copytree(source, repository, ignore=lambda folder, names: [
        n for n in names if n == ".git" or folder == str(source) and n in ("build", "out")])
    author = ("-c", "user.name=test", "-c", "user.email=test@localhost")
    run("git", "init", "-q", "-b", "main", repository)
    run("git", "-C", repository, "add", "-A")
    run("git", "-C", repository, *author, "commit", "-q", "-m", "The source")
    guide = (source / "engine/INTEGRATION.md").read_text(encoding="utf-8")
    commands, = re.findall(r"```cmake\n(include\(FetchContent\).*?)```", guide, re.DOTALL)
    require("https://ADDRESS/candelabra.git" in commands, f"no address to replace in {commands}")
    get, folder = work / "get.cmake", work / "fetched"
    get.write_text(commands.replace("https://ADDRESS/candelabra.git", f'"{repository.as_uri()}"'), encoding="utf-8")
    options = [f"-DGET={get}", "-DCPP=ON"]
    if os.environ.get("CANDELABRA_FULL_TESTS") == "1":
        options.append("-DCMAKE_BUILD_TYPE=Release")
    else:  # compiling the shaders again takes a minute, and optimising the library again half a minute
        options += [f"-DCANDELABRA_COMPILED_SHADERS={build}/shaders", "-DCMAKE_BUILD_TYPE=Debug",
                    "-DCMAKE_CXX_FLAGS_DEBUG="]
    consume(folder, [*options, f"-DSAMPLE={source}/samples/embed_minimal"], *CPP)
    run_sample(folder / "sample/embed_minimal")

    fetched_source, fetched_build = folder / "_deps/candelabra-src", folder / "_deps/candelabra-build"
    get.write_text(f'add_subdirectory("{fetched_source}" "{fetched_build}")\n', encoding="utf-8")
    for stale in (folder / "CMakeCache.txt", *folder.glob("with_*[a-z0-9]")):
        stale.unlink()
    configure_and_build(source / "tests/package/consumer", folder, *options, *WITHOUT, COMPILERS_ARE_KNOWN,
                        "-DCANDELABRA_INSTALL=ON", "-DBUILD_SHARED_LIBS=OFF")
    run_hosts(folder, *CPP)
    static = clean(work / "static")
    run("cmake", "--install", folder, "--prefix", static)
    require(not list(static.rglob("*.so*")), "the shared library was installed too")
    consume(work / "found_static", [f"-DCMAKE_PREFIX_PATH={static}", *WITHOUT])


def configured(folder, log):
    """Fails if CMake was given an option that the project does not know, or chose another build."""
    require("not used by the project" not in log, log)
    cache = (folder / "CMakeCache.txt").read_text(encoding="utf-8")
    for option in ("CANDELABRA_BUILD_TOOLS", "CANDELABRA_BUILD_COMPILER"):
        require(f"{option}:BOOL=OFF" in cache, f"{option} is not OFF in {folder}")


def conan():
    """The Conan recipe, with stand-ins for Conan's modules: the files that it exports can be configured."""
    exported = clean(work / "conan")

    def copy(recipe, pattern, origin, target):
        for path in pathlib.Path(origin).glob(pattern):
            to = pathlib.Path(target) / path.relative_to(origin)
            to.parent.mkdir(parents=True, exist_ok=True)
            (shutil.copytree if path.is_dir() else shutil.copy)(path, to)

    toolchain = types.SimpleNamespace(cache_variables={}, generate=lambda: None)
    modules = {name: unittest.mock.MagicMock() for name in ("conan", "conan.tools", "conan.tools.build",
                                                            "conan.tools.cmake", "conan.tools.files")}
    modules["conan"].ConanFile = object
    modules["conan.tools.cmake"].CMakeToolchain = lambda recipe: toolchain
    modules["conan.tools.files"].copy = copy
    modules["conan.tools.files"].load = lambda recipe, path: pathlib.Path(path).read_text(encoding="utf-8")
    file = source / "engine/package/conan/conanfile.py"
    with unittest.mock.patch.dict(sys.modules, modules):
        recipe = runpy.run_path(str(file))["Candelabra"]()
    recipe.recipe_folder, recipe.export_sources_folder = str(file.parent), str(exported)
    recipe.set_version()
    version = (libdir() / "cmake/candelabra/candelabraConfigVersion.cmake").read_text(encoding="utf-8")
    require(f'PACKAGE_VERSION "{recipe.version}"' in version, f"the recipe's version is {recipe.version}")
    recipe.export_sources()
    recipe.generate()
    options = [f"-D{name}={value}" for name, value in toolchain.cache_variables.items()]
    options += ["-DBUILD_SHARED_LIBS=ON", COMPILERS_ARE_KNOWN]
    copy_compilers(exported / "build")
    configured(exported / "build", run("cmake", "-G", generator, "-S", exported, "-B", exported / "build", *options))


def vcpkg():
    """The vcpkg port, with stand-ins for vcpkg's functions: its options can be configured."""
    folder = clean(work / "vcpkg")
    copy_compilers(folder / "build")
    port = source / "engine/package/vcpkg/portfile.cmake"
    script = folder / "stand_ins.cmake"
    script.write_text("\n".join(f"function({name})\nendfunction()" for name in sorted(set(
        re.findall(r"^(vcpkg_\w+)", port.read_text(encoding="utf-8"), re.MULTILINE)) - {"vcpkg_cmake_configure"})) + f"""
function(vcpkg_cmake_configure)
    cmake_parse_arguments(PARSE_ARGV 0 arg "" SOURCE_PATH OPTIONS)
    execute_process(COMMAND ${{CMAKE_COMMAND}} -G "{generator}" -S ${{arg_SOURCE_PATH}} -B "{folder}/build"
        -DBUILD_SHARED_LIBS=OFF {COMPILERS_ARE_KNOWN} ${{arg_OPTIONS}} COMMAND_ERROR_IS_FATAL ANY)
endfunction()
set(CURRENT_PACKAGES_DIR "{folder}/packages")
include("{port}")
""", encoding="utf-8")
    configured(folder / "build", run("cmake", "-P", script))


# What the first listing of the guide takes from the host.
HOST = """VkInstance instance, VkPhysicalDevice physicalDevice, VkDevice vkDevice, VkPhysicalDeviceFeatures2 features2,
    uint32_t width, uint32_t height, uint32_t slot, CndCamera camera, VkCommandBuffer cmd, VkImageView normalView,
    VkImageView baseColourView, VkImageView roughnessMetalnessView, VkImageView depthView, VkImageView radianceView"""


def guide(flags):
    """The guide begins with the first light: at most 25 lines of code, which compile."""
    text = (source / "engine/INTEGRATION.md").read_text(encoding="utf-8")
    start = text[text.index("## The first light"):text.index("## 1. ")]
    lines = [line for block in re.findall(r"```\w+\n(.*?)```", start, re.DOTALL) for line in block.split("\n") if line]
    require(len(lines) <= 25, f"the first light takes {len(lines)} lines")
    include, code = re.search(r"```cpp\n(#include.*?\n)(.*?)```", start, re.DOTALL).groups()
    listing = work / "first_light.cpp"
    listing.write_text(f"{include}void host({HOST})\n{{\n{code}}}\n", encoding="utf-8")
    run("c++", "-std=c++20", "-fsyntax-only", listing, *flags)


def pkg_config():
    where = {"PKG_CONFIG_PATH": str(libdir() / "pkgconfig")}
    flags = shlex.split(run("pkg-config", "--cflags", "--libs", "candelabra", **where))
    static = shlex.split(run("pkg-config", "--cflags", "--libs", "--static", "candelabra", **where))
    guide([flag for flag in flags if not flag.startswith("-l")])
    main = source / "tests/package/consumer/main.c"
    compiled = [[flag for flag in either if not flag.startswith(("-l", "-L"))] for either in (flags, static)]
    require(set(compiled[0]) == set(compiled[1]), f"hosts would be compiled with other flags for --static: {compiled}")
    archive = [f.replace("-lcandelabra", "-l:libcandelabra.a") for f in static]
    for name, compiler in {"c": ("cc", main),
                           "cpp17": ("c++", "-std=c++17", main.with_name("host.cpp")),
                           "cpp20": ("c++", "-std=c++20", main.with_name("host.cpp"))}.items():
        run(*launcher, *compiler, "-c", "-o", work / f"pc_{name}.o", *flags)
        run(compiler[0], work / f"pc_{name}.o", "-o", work / f"pc_{name}_shared", *flags)
        run(work / f"pc_{name}_shared", LD_LIBRARY_PATH=str(libdir()))
        run(compiler[0], work / f"pc_{name}.o", "-o", work / f"pc_{name}_static", *archive)
        run(work / f"pc_{name}_static")
        require("libcandelabra" not in run("readelf", "-d", work / f"pc_{name}_static"),
                "the static library was linked as a shared one")
    shaders, = shlex.split(run("pkg-config", "--variable=shaderdir", "candelabra", **where))
    require((pathlib.Path(shaders) / "lib/gbuffer.glsl").exists(), f"no shaders in {shaders}")
    flags = shlex.split(run("pkg-config", "--cflags", "--libs", "candelabra_compiler", **where))
    run("cc", main.with_name("compile.c"), "-o", work / "pc_compiler", *flags)
    run(work / "pc_compiler", LD_LIBRARY_PATH=str(libdir()))


def program():
    """The component of the program alone: it runs, and only it and what makes its report are installed."""
    folder = clean(work / "program")
    run("cmake", "--install", build, "--component", "program", "--prefix", folder)
    files = {str(p.relative_to(folder)) for p in folder.rglob("*") if p.is_file()}
    of_report = {name for name in files if name.startswith("share/candelabra/report/")}
    pages = {f"share/doc/candelabra/{name}" for name in ("BLENDER.md", "MANY_MACHINES.md", "SCENE_JSON.md",
                                                         "scenes/every_light.json", "scenes/noon.json")}
    require(files - of_report - pages == {"bin/candelabra"}, f"{files} are installed")
    scripts = {pathlib.PurePath(name).name for name in of_report if name.endswith(".py")}
    require(scripts == {"report.py", "figures.py"} and any(n.endswith(".csv") for n in of_report), f"{of_report}")
    require(re.match(r"candelabra \d+\.\d+\.\d+\n", run(folder / "bin/candelabra", "--version")),
            "--version")
    libraries = run("readelf", "-d", folder / "bin/candelabra")
    require("libcandelabra" not in libraries and not re.search("R(UN)?PATH", libraries), libraries)


# This stand-in for cmake runs `cmake -E env COMMAND` without starting CMake.
ENV_IS_CHEAP = """#!/bin/sh
[ "$1 $2" != "-E env" ] || { shift 2; exec env "$@"; }
exec cmake "$@"
"""


def debian():
    folder = clean(work / "debian")
    os.umask(0o077)  # a package is the same whatever the umask of the person who makes it
    # CPack would spend most of its time on compression, and on starting `cmake -E env` for every file.
    folder.mkdir()
    (folder / "cmake").write_text(ENV_IS_CHEAP)
    (folder / "cmake").chmod(0o755)
    run("cpack", "--config", build / "CPackConfig.cmake", "-B", folder, "-D", "CPACK_DEBIAN_COMPRESSION_TYPE=none",
        "-D", f"CMAKE_COMMAND={folder}/cmake")
    wanted = {"libcandelabra-dev": (r"lib/(.*/)?libcandelabra\.so\.\d+\.\d+\.\d+",
                                    "include/candelabra/candelabra.h"),
              "candelabra": ("bin/candelabra",)}
    packages = {run("dpkg-deb", "--field", p, "Package").strip(): p for p in folder.glob("*.deb")}
    require(packages.keys() == wanted.keys(), f"made {packages}")
    for name, package in packages.items():
        listing = run("dpkg-deb", "--contents", package)
        for line in listing.splitlines():
            require(re.match("drwxr-xr-x|-r..r-.r-.|l", line), f"others cannot read {line} of {name}")
        for path in wanted[name]:
            require(re.search(f"/usr/{path}\n", listing), f"no {path} in\n{listing}")
        for path in (p for other in wanted if other != name for p in wanted[other]):
            require(not re.search(f"/usr/{path}\n", listing), f"{path} in\n{listing}")
        fields = run("dpkg-deb", "--field", package)
        require(re.search("^Depends:.*libstdc", fields, re.MULTILINE), fields)
        print(fields)


if step.startswith("sample:"):
    sample(step.removeprefix("sample:"))
else:
    {"install": install, "found": found, "fetched": fetched, "pkg_config": pkg_config, "conan": conan,
     "vcpkg": vcpkg, "program": program, "debian": debian}[step]()
