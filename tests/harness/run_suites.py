#!/usr/bin/env python3
# SPDX-License-Identifier: Apache-2.0
"""Runs the tests of some suites: run_suites.py EXECUTABLE SUITE...

They share a process, and with it their pipelines. If a test ends the process, the tests after it run
in a new one. Only the output of tests that did not pass is printed, and their names again at the end.
CANDELABRA_EXCLUDED_TESTS holds patterns of GoogleTest, separated by ':', of tests that do not run.
CANDELABRA_FULL_TESTS=1 runs each suite in a process of its own, and its tests in random order.
"""
import os
import re
import subprocess
import sys
import threading

full = os.environ.get("CANDELABRA_FULL_TESTS") == "1"
passed, skipped, failed = [], [], []


def run(executable, suites):
    """Runs the suites in one process, or in several if tests crash."""
    chosen = ":".join(f"{suite}.*" for suite in suites)
    excluded = [pattern for pattern in os.environ.get("CANDELABRA_EXCLUDED_TESTS", "").split(":") if pattern]
    while True:
        # After a crash, the tests that have run already are excluded too.
        command = [executable, f"--gtest_filter={chosen}-" + ":".join(excluded), *["--gtest_shuffle"] * full]
        process = subprocess.Popen(command, stdout=subprocess.PIPE, stderr=subprocess.STDOUT,
                                   text=True, errors="replace")
        running, output = None, []
        failures_before = len(failed)
        for line in process.stdout:
            output.append(line)
            if line.startswith("Note: Randomizing"):
                print(line, end="", flush=True)
            if line.startswith("[ RUN      ] "):
                running, output = line[13:].strip(), [line]
                slow = threading.Timer(120, print, [f"{running} has run for two minutes"], {"flush": True})
                slow.daemon = True
                slow.start()
                excluded.append(running)
            elif running and (end := re.match(r"\[ +(OK|FAILED|SKIPPED) +\] ", line)):
                slow.cancel()
                {"OK": passed, "FAILED": failed, "SKIPPED": skipped}[end[1]].append(running)
                if end[1] != "OK":
                    print("".join(output), end="", flush=True)
                running, output = None, []
        status = process.wait()
        if running:
            slow.cancel()
            output.append(f"{running} ended the process with status {status}.\n")
            failed.append(f"{running} (crashed)")
        elif status != 0 and len(failed) == failures_before:
            failed.append(f"the end of {executable} (status {status})")
        if running or status != 0:
            print("".join(output), end="", flush=True)
        if not running:
            return


program, *names = sys.argv[1:]
for suites in [[name] for name in names] if full else [names]:
    run(program, suites)
print(f"{len(passed)} passed, {len(skipped)} skipped, {len(failed)} failed" + "".join(f"\nfailed: {n}" for n in failed))
sys.exit(1 if failed else 0)
