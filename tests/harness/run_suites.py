#!/usr/bin/env python3
# SPDX-License-Identifier: Apache-2.0
"""Runs the tests of some suites in one process: run_suites.py EXECUTABLE SUITE...

If a test ends the process, its name is printed and the tests after it run in a new process.
CANDELABRA_EXCLUDED_TESTS holds patterns of GoogleTest, separated by ':', of tests that do not run.
CANDELABRA_FULL_TESTS=1 runs each suite in a process of its own, and its tests in random order.
"""
import os
import subprocess
import sys

full = os.environ.get("CANDELABRA_FULL_TESTS") == "1"
crashed = []


def run(executable, suites):
    """Returns the exit status of the last process."""
    chosen = ":".join(f"{suite}.*" for suite in suites)
    excluded = [pattern for pattern in os.environ.get("CANDELABRA_EXCLUDED_TESTS", "").split(":") if pattern]
    while True:
        # After a crash, the tests that have run already are excluded too.
        command = [executable, f"--gtest_filter={chosen}-" + ":".join(excluded), *["--gtest_shuffle"] * full]
        process = subprocess.Popen(command, stdout=subprocess.PIPE, stderr=subprocess.STDOUT,
                                   text=True, errors="replace")
        running = None
        for line in process.stdout:
            sys.stdout.write(line)
            sys.stdout.flush()
            if line.startswith("[ RUN      ] "):
                running = line[13:].strip()
                excluded.append(running)
            elif running and line.startswith(("[       OK ] ", "[  FAILED  ] ", "[  SKIPPED ] ")):
                running = None
        status = process.wait()
        if not running:
            return status
        print(f"{running} ended the process with status {status}.", flush=True)
        crashed.append(running)


program, *names = sys.argv[1:]
failed = any([run(program, suites) for suites in ([[name] for name in names] if full else [names])])
if crashed:
    print("These tests crashed: " + ", ".join(crashed))
sys.exit(1 if crashed or failed else 0)
