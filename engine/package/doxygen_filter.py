#!/usr/bin/env python3
# SPDX-License-Identifier: Apache-2.0
"""Doxygen's input filter: turns the plain // comments of the headers into documentation comments.

A trailing comment, with the lines that continue it, documents the declaration before it. Any other
comment documents the declaration that follows, and the first comment of a file documents the file."""
import re
import sys


def documented(lines):
    behind = None  # column of a trailing comment that the next line may continue
    head = True    # inside the comment that opens the file
    for line in lines:
        alone = re.match(r"( *)//( ?)(.*)", line)
        after = re.match(r"(.*\S.*?)//( .*)", line)
        if head and alone:
            text = alone.group(3)
            yield "/// @file" if text.startswith("SPDX") else "/// " + text
            continue
        head = False
        if alone and behind is not None and len(alone.group(1)) >= behind:
            yield alone.group(1) + "///<" + alone.group(2) + alone.group(3)
        elif alone:
            behind = None
            yield alone.group(1) + "///" + alone.group(2) + alone.group(3)
        elif after and not after.group(1).startswith("#"):
            behind = len(after.group(1))
            yield after.group(1) + "///<" + after.group(2)
        else:
            behind = None
            yield line


with open(sys.argv[1], encoding="utf-8") as header:
    if sys.argv[1].endswith(".md"):
        sys.stdout.write(header.read())
    else:
        print("\n".join(documented(header.read().splitlines())))
