#!/usr/bin/env python3
# SPDX-License-Identifier: Apache-2.0
"""Runs the tests of some suites in one process: run_suites.py EXECUTABLE SUITE...

If a test ends the process, its name is printed and the tests after it run in a new process.
CANDELABRA_EXCLUDED_TESTS holds patterns of GoogleTest, separated by ':', of tests that do not run.
CANDELABRA_FULL_TESTS=1 runs the tests in random order.
"""
import os
import subprocess
import sys

executable, *suites = sys.argv[1:]
chosen = ":".join(f"{suite}.*" for suite in suites)
excluded = [pattern for pattern in os.environ.get("CANDELABRA_EXCLUDED_TESTS", "").split(":") if pattern]
arguments = ["--gtest_shuffle"] if os.environ.get("CANDELABRA_FULL_TESTS") == "1" else []
crashed = []
while True:
    # After a crash, the tests that have run already are excluded too.
    command = [executable, f"--gtest_filter={chosen}-" + ":".join(excluded), *arguments]
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
        break
    print(f"{running} ended the process with status {status}.", flush=True)
    crashed.append(running)
if crashed:
    print("These tests crashed: " + ", ".join(crashed))
sys.exit(1 if crashed or status else 0)
