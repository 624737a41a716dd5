#!/usr/bin/env python3
# SPDX-License-Identifier: Apache-2.0
"""Tests tools/gpu_check: a bundle made from a build runs both of its parts, quickly, in a folder with a space
in its name and with next to nothing in the environment. Its archives do not tell whose machine it was, its page
shows all of their files, and they become records and tables in a copy of the documents.
Usage: test_gpu_check.py SOURCE BUILD; everything is written to BUILD/gpu_check."""
import html
import io
import os
import pathlib
import platform
import re
import shutil
import subprocess
import sys
import tarfile

source, build = map(pathlib.Path, sys.argv[1:3])
work = build / "gpu_check"
bundle = work / "a bundle"
device = os.environ.get("CANDELABRA_TEST_DEVICE")
# The paths tell whose machine it is, and the bundle writes them to a file.
BARE = {"PATH": "/usr/bin:/bin", "HOME": str(work), "USER": "alice",
        "LD_LIBRARY_PATH": f"{work}/other:/srv/alice/lib"}
# Shaders that Mesa compiled for other tests need not be compiled again.
BARE["CANDELABRA_CHECK_SHADER_CACHE"] = os.environ.get("MESA_SHADER_CACHE_DIR") or os.path.expanduser("~/.cache")
BARE |= {name: value for name, value in os.environ.items() if name.startswith("VK_")}  # where the driver is


def run(*command, environment=os.environ, status=0):
    """Returns what the command prints; ends the test if its exit status is another one."""
    print("$", *command, flush=True)
    done = subprocess.run([str(c) for c in command], env=environment, cwd=work, text=True,
                          stdout=subprocess.PIPE, stderr=subprocess.STDOUT)
    print(done.stdout, flush=True)
    if done.returncode != status:
        sys.exit(f"ended with {done.returncode} where {status} was expected")
    return done.stdout


def require(condition, why):
    if not condition:
        sys.exit(why)


shutil.rmtree(work, ignore_errors=True)
work.mkdir()
run(source / "tools/gpu_check", "bundle", bundle, "--no-build", environment=os.environ | {"CANDELABRA_BUILD": str(build)})
# The archive is what travels to another machine.
archive = work / "gpu_check.tar.gz"
run(source / "tools/gpu_check", "bundle", archive, "--no-build",
    environment=os.environ | {"CANDELABRA_BUILD": str(build)})
size = archive.stat().st_size
require(size < 32 * 2**20, f"the archive has {size} bytes")
for path in bundle.rglob("*"):
    require(not path.is_symlink(), f"{path} is a link, which may not survive a copy")

chosen = ["--device", device] if device else []
output = {part: run(bundle / "run", part, "--quick", "--out", work / "results", *chosen, environment=BARE)
          for part in ("correctness", "performance")}
for part, text in output.items():
    require(re.search("Everything (else )?ran and passed[.]", text), f"{part} did not pass")
    require(len(text) < 12000, f"{part} printed {len(text)} characters")
require(" 0 failed, 0 skipped, 0 stopped, 0 not run" in output["correctness"], "not all tests passed")
run(bundle / "run", "correctness", "--minutes", "x", environment=BARE, status=2)
# Time that is too short is no success.
short = run(bundle / "run", "performance", "--quick", "--out", work / "short", "--minutes", "1", *chosen,
            environment=BARE | {"CANDELABRA_CHECK_RESERVE": "58", "USER": "Linux"}, status=3)
require("LEFT OUT for lack of time: profile_hall_200_64x36" in short, "what was left out is not said")

# The pages tell what was found, and show all files of the archives.
page = (work / "short/gpu_check.html").read_text()
for wanted in ("the hall, 200 lights, 64x36</td><td><b>left out</b>, because the time ran out</td>",
               "<code>run correctness</code> adds it to this page",
               "<code>Linux</code> is in gpu_check-performance/logs/machine.log."):
    require(wanted in page, f"the page of the short run lacks {wanted!r}")
page = (work / "results/gpu_check.html").read_text()
for wanted in ("<p>Everything ran and passed.</p>", " passed, 0 failed, 0 skipped, 0 stopped, 0 not run",
               "and comparison with quadrature</td><td>passed (", " inputs, 0 of them invalid</p>",
               "<tr><td>shade_tiles</td><td>", "and no file has them.</p>"):
    require(wanted in page, f"the page lacks {wanted!r}")
require(not re.search(r'(src|href)="(?!#|data:,")', page), "the page needs other files")
for part in output:
    with tarfile.open(work / f"results/gpu_check-{part}.tar.gz") as tar:
        for member in tar:
            owner = member.uid, member.gid, member.uname, member.gname
            require(owner == (0, 0, "root", "root"), f"{member.name} names its owner")
            if not member.isfile():
                continue
            text, name = tar.extractfile(member).read().decode(), member.name.split("/", 1)[1]
            require(str(work) not in text and "alice" not in text, f"{part}: {name} tells whose machine it is")
            require(f'">{name}</a></td><td>{member.size}</td><td>' in page, f"the page does not list {name} of {part}")
            shown = html.escape(text.rstrip("\n"), quote=False)
            require(f'">{part}: {name}</h3><pre>{shown}</pre>' in page, f"the page does not show {name}")
            if name == "logs/machine.log":
                require("=BUNDLE/lib:~/other:/srv/USER/lib " in text, "folders are not named")
                require(not re.search(rf"\b{re.escape(platform.node())}\b", text), "the name of the machine is there")

# The archives become records and tables, but not those of quick runs.
copy = work / "copy"
for name in ("README.md", "engine/LIGHTING_MODEL.md", "tools/update_results", "tools/report/figures.py",
             "tools/bench/RESULTS.md"):
    (copy / name).parent.mkdir(parents=True, exist_ok=True)
    shutil.copy(source / name, copy / name)
shutil.copytree(source / "tools/bench/results", copy / "tools/bench/results")
committed = set((copy / "tools/bench/results").glob("profile-*.csv"))
for part in output:
    archive = work / f"results/gpu_check-{part}.tar.gz"
    refused = run(copy / "tools/update_results", archive, status=1)
    require("--quick" in refused, "a quick run was not refused")
    measured = work / archive.name
    with tarfile.open(archive) as quick, tarfile.open(measured, "w:gz") as tar:
        for member in quick:
            if member.isfile() and not member.name.endswith("/QUICK"):
                tar.addfile(member, io.BytesIO(quick.extractfile(member).read()))
    run(copy / "tools/update_results", measured)
profile, = set((copy / "tools/bench/results").glob("profile-*.csv")) - committed
head = dict(line[2:].split(": ", 1) for line in profile.read_text().splitlines() if line.startswith("# "))
require(head["command"].startswith("candelabra profile hall --lights 200 "), f"the record names {head['command']}")
page = (copy / "tools/bench/RESULTS.md").read_text()
for wanted in (f"### {head['device']}, ", " GPU tests passed", "| hall, 200, moving | 64x36 |"):
    require(wanted in page, f"RESULTS.md has no {wanted}")
run(copy / "tools/update_results", "--check")
