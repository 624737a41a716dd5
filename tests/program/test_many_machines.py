#!/usr/bin/env python3
# SPDX-License-Identifier: Apache-2.0
"""Runs the commands of MANY_MACHINES.md as they are written there, only smaller, and checks that the shards together
give the bits of one call. The program `candelabra` that they find adds the options that make them small, and `sbatch`
is a script that runs a job on this machine.
Usage: test_many_machines.py PROGRAM REPOSITORY"""
import os
import pathlib
import re
import shlex
import subprocess
import sys
import tempfile

program, root = pathlib.Path(sys.argv[1]).resolve(), pathlib.Path(sys.argv[2]).resolve()
device = os.environ.get("CANDELABRA_TEST_DEVICE")
SMALLER = {"truth": "--size 8x5 --tolerance 1e-2 --lights 200",
           "render": "--size 32x18 --lights 20" + (f" --device {shlex.quote(device)}" if device else "")}
# Frames that another listing has rendered by the same command are copied, because a start takes seconds on llvmpipe.
CANDELABRA = f"""#!/usr/bin/env bash
set -eu
case " $* " in
*" --merge "*) exec {shlex.quote(str(program))} "$@" ;;
*" truth "*) exec {shlex.quote(str(program))} "$@" {SMALLER["truth"]} ;;
esac
frames=$HOME/frames/${{*//[^[:alnum:]]/_}}
if [ ! -d "$frames" ]; then
    mkdir -p "$frames"
    (cd "$frames" && exec {shlex.quote(str(program))} "${{@/240/6}}" {SMALLER["render"]})
fi
cp "$frames"/* .
"""
# Runs every task of a job array or the one of --array, or the command of --wrap, and prints the number of the job.
SBATCH = """#!/usr/bin/env bash
set -eu
echo 17
first=1
case $1 in
--array=*) first=${1#--array=}; last=$first; shift ;;
--dependency=afterok:17) [ "$2" = --wrap ]; exec bash -euc "$3" ;;
--parsable) shift ;;
esac
last=${last-$(sed -n 's/^#SBATCH --array=1-//p' "$1")}
for i in $(seq "$first" "$last"); do
    SLURM_ARRAY_TASK_ID=$i SLURM_ARRAY_TASK_COUNT=$((last - first + 1)) SLURM_CPUS_PER_TASK=2 bash -eu "$1" >&2
done
"""
failures = []


def run(command, folder, environment):
    done = subprocess.run(["bash", "-euc", command], cwd=folder, env=environment, text=True, errors="replace",
                          stdin=subprocess.DEVNULL, stdout=subprocess.PIPE, stderr=subprocess.STDOUT)
    print(command)
    if done.returncode:
        failures.append(f"{command}: ended with {done.returncode}: {done.stdout[-2000:]}")


def main(place):
    tools = place / "bin"
    tools.mkdir()
    for name, text in {"candelabra": CANDELABRA, "sbatch": SBATCH}.items():
        (tools / name).write_text(text, encoding="utf-8")
        (tools / name).chmod(0o755)
    environment = os.environ | {"PATH": f"{tools}:{os.environ['PATH']}", "HOME": str(place)}
    (place / ".parallel").mkdir()
    (place / ".parallel/will-cite").touch()  # otherwise GNU parallel asks to be cited

    page = (root / "tools/MANY_MACHINES.md").read_text(encoding="utf-8")
    listings = re.findall(r"^```sh\n(.*?)^```$", page, re.DOTALL | re.MULTILINE)
    scripts = dict(zip(re.findall(r"`(\w+\.sbatch)`:", page), [x for x in listings if x.startswith("#!")]))
    commands = [x for x in listings if not x.startswith("#!")]
    expected = ["truth.exr", "truth.exr", *[f"f.{i:04d}.png" for i in range(6)], *[f"f.{i:04d}.png" for i in range(6)]]
    whole = place / "whole"
    whole.mkdir()
    run("candelabra truth rooms -o truth.exr", whole, environment)
    run("candelabra render hall --path turn --frames 240 --exposure 2 -o f.%04d.png", whole, environment)
    wanted = {path.name: path.read_bytes() for path in whole.iterdir()}
    if len(wanted) != 7:
        failures.append(f"one call wrote {sorted(wanted)}")
    made = []
    for i, command in enumerate(commands):
        folder = place / f"with a space {i}"
        folder.mkdir()
        (folder / "machines").write_text(":\n", encoding="utf-8")
        for name, text in scripts.items():
            (folder / name).write_text(text, encoding="utf-8")
        run(command, folder, environment)
        for path in sorted(folder.iterdir()):
            if path.name in wanted:
                made.append(path.name)
                if path.read_bytes() != wanted[path.name]:
                    failures.append(f"{command}: {path.name} is not that of one call")
    again = place / "again"
    again.mkdir()
    for name, text in scripts.items():
        (again / name).write_text(text, encoding="utf-8")
    run("sbatch --array=2 frames.sbatch", again, environment)
    written = sorted(path.name for path in again.glob("*.png"))
    if written != ["f.0001.png", "f.0005.png"]:  # of 6 frames in 4 shards
        failures.append(f"the second task alone wrote {written}")
    if made != expected:
        failures.append(f"the commands wrote {made}, and not {expected}")


with tempfile.TemporaryDirectory(prefix="candelabra_many_machines_") as folder:
    main(pathlib.Path(folder))
print("\n".join(failures) or "shards give the bits of one call")
sys.exit(1 if failures else 0)
